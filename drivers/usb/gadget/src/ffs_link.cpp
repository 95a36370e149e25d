#include "dicot/gadget/ffs_link.h"

#include "bulk_in.h"
#include "bulk_out.h"
#include "control_thread.h"
#include "descriptors.h"
#include "endpoints.h"

#include "dicot/os/clock.h"
#include "dicot/os/memory_block.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace dicot {
namespace {

using namespace gadget_parts;

constexpr std::size_t kFromHostBytes = 16384;
constexpr std::size_t kEventBytes = 64; ///< of which a container takes 24
constexpr std::int64_t kSliceUs = 1'000'000, kMostCancelUs = 2'000'000, kAfterErrorUs = 20'000;

Status no_host()
{
    return failure(Fault::kUnavailable, "the computer has gone");
}

Status broken()
{
    return failure(Fault::kIoError, "the computer has ended the transfer");
}

} // namespace

static_assert(FfsLink::kMostPartBytes == BulkIn::kChunks * BulkIn::kChunkBytes);
static_assert(BulkIn::kParts == mtp::DeviceLink::kMostUnderWay);

/// Members are let go from the last to the first: the thread, then what is under way, then the files.
struct FfsLink::Parts
{
    Rules rules;
    SharedCable cable;
    Descriptor wake;
    Endpoints endpoints;
    MemoryBlock memory;
    AioQueue queue;
    std::optional<BulkIn> to_host;
    std::optional<BulkOut> from_host;
    std::array<Transfer, kEvents> events;
    std::span<std::byte> event_memory;
    std::uint32_t generation = 0; ///< the host's that we talk to
    unsigned packet_bytes = 512;
    std::int64_t moved_us = 0; ///< when something last went or came
    ControlThread thread;

    explicit Parts(const Rules& given) noexcept : rules(given) {}

    Status open()
    {
        wake = Descriptor(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC));
        if (wake.get() < 0)
            return failure(Fault::kOsError, "no eventfd (%s)", strerrordesc_np(errno));
        cable.wake = wake.get();
        memory = TRY(MemoryBlock::map(kFromHostBytes + kEvents * kEventBytes, Pages::kResident));
        endpoints = TRY(Endpoints::open(rules.mount));
        TRY(queue.open(BulkIn::kMostUnderWay + 1 + kEvents));
        const std::span<std::byte> all = memory.bytes();
        to_host.emplace(queue, endpoints.to_host.get());
        from_host.emplace(queue, endpoints.from_host.get(), all.first(kFromHostBytes));
        event_memory = all.last(kEvents * kEventBytes);
        return thread.start(endpoints.control.get(), cable);
    }

    /// Until something has happened, `most_us` at most. Whether to go on is another question.
    void wait(std::int64_t most_us) noexcept
    {
        pollfd both[] = {{queue.ready(), POLLIN, 0}, {wake.get(), POLLIN, 0}};
        const std::int64_t ms = (std::clamp<std::int64_t>(most_us, 0, kSliceUs) + 999) / 1000;
        (void)::poll(both, 2, static_cast<int>(ms));
        std::uint64_t many = 0;
        (void)!::read(wake.get(), &many, sizeof many);
        settle();
    }

    void settle() noexcept
    {
        (void)queue.reap();
        const bool went = to_host->settle();
        const bool came = from_host->settle();
        if (went || came)
            moved_us = monotonic_us();
    }

    bool events_idle() const noexcept
    {
        return std::none_of(events.begin(), events.end(), [](const Transfer& each) { return each.under_way; });
    }

    /// Ends what goes to the host; false: the controller does not let go of it, and this host is lost.
    bool clear_to_host() noexcept
    {
        to_host->cancel();
        const std::int64_t until_us = monotonic_us() + kMostCancelUs;
        while (!to_host->idle() && monotonic_us() < until_us)
            wait(until_us - monotonic_us());
        endpoints.discard_unread();
        if (!to_host->idle())
            return false;
        to_host->forget();
        return true;
    }

    bool clear_all() noexcept
    {
        from_host->cancel();
        for (Transfer& event : events)
            queue.cancel(event);
        const std::int64_t until_us = monotonic_us() + kMostCancelUs;
        const bool cleared = clear_to_host();
        while ((!from_host->idle() || !events_idle()) && monotonic_us() < until_us)
            wait(until_us - monotonic_us());
        if (!from_host->idle() || !events_idle())
            return false;
        from_host->forget();
        return cleared;
    }

    /// Between two steps of a transfer: whether it goes on.
    Status look() noexcept
    {
        if (!rules.goes_on())
            return failure(Fault::kUnavailable, "an end is wanted");
        bool flush = false, interrupted = false;
        {
            const std::lock_guard guard(cable.lock);
            if (!cable.image.enabled() || cable.image.generation() != generation)
                return no_host();
            flush = cable.image.must_flush();
            interrupted = cable.image.interrupted();
        }
        if (flush) {
            (void)clear_all();
            {
                const std::lock_guard guard(cable.lock);
                cable.image.flushed();
            }
            cable.flushed.notify_all();
            from_host->arm();
            return broken();
        }
        return interrupted ? broken() : Status{};
    }

    /// A host that asks for something else while it takes nothing of what it asked for has given that up: killed, and
    /// started again.
    bool forgotten() const noexcept
    {
        return from_host->waiting() && !to_host->idle() &&
               monotonic_us() - moved_us > std::int64_t{rules.forgotten_ms} * 1000;
    }

    Status lost(int error) noexcept
    {
        if (error == ESHUTDOWN || error == EAGAIN || error == ENODEV)
            return no_host();
        const std::lock_guard guard(cable.lock);
        cable.image.give_up();
        return failure(Fault::kIoError, "a transfer failed (%s)", strerrordesc_np(error));
    }

    /// Room for more, or why there will be none.
    Status await_room() noexcept
    {
        TRY(look());
        if (to_host->error() != 0) {
            const int error = to_host->error();
            (void)clear_to_host();
            return lost(error);
        }
        if (forgotten()) {
            ++cable.counts.given_up;
            (void)clear_to_host();
            const std::lock_guard guard(cable.lock);
            cable.image.give_up();
            return broken();
        }
        wait(from_host->waiting() ? std::int64_t{rules.forgotten_ms} * 250 : kSliceUs);
        return {};
    }
};

const char* name_of(CableState state) noexcept
{
    switch (state) {
    case CableState::kNoHost:
        return "no host";
    case CableState::kConfigured:
        return "configured";
    case CableState::kSuspended:
        return "suspended";
    }
    return "";
}

FfsLink::FfsLink(std::unique_ptr<Parts> parts) noexcept : parts_(std::move(parts)) {}
FfsLink::~FfsLink() = default;

Result<std::unique_ptr<FfsLink>> FfsLink::open(const Rules& rules)
{
    auto parts = std::make_unique<Parts>(rules);
    TRY(parts->open());
    return std::unique_ptr<FfsLink>(new FfsLink(std::move(parts)));
}

Status FfsLink::await_host(int patience_ms)
{
    const std::int64_t until_us = monotonic_us() + std::int64_t{patience_ms} * 1000;
    for (bool first = true;; first = false) {
        if (!parts_->rules.goes_on())
            return failure(Fault::kUnavailable, "an end is wanted");
        bool there = false, other = false;
        {
            const std::lock_guard guard(parts_->cable.lock);
            StillImage& image = parts_->cable.image;
            there = image.enabled();
            other = image.generation() != parts_->generation;
            if (there && other) {
                parts_->generation = image.generation();
                image.end();
            }
        }
        if (there && !other && !first)
            break; // the same one: a transfer failed, and this was a pause
        if (there && other) {
            (void)parts_->clear_all();
            parts_->packet_bytes = parts_->endpoints.packet_bytes();
            ++parts_->cable.counts.hosts;
            break;
        }
        const std::int64_t left_us = until_us - monotonic_us();
        if (left_us <= 0)
            return failure(Fault::kTryAgain, "no computer has come");
        parts_->wait(there ? kAfterErrorUs : std::min(left_us, kSliceUs));
    }
    parts_->from_host->arm();
    return {};
}

Result<std::size_t> FfsLink::receive(std::span<std::byte> into, int patience_ms)
{
    Parts& parts = *parts_;
    const std::int64_t until_us = monotonic_us() + std::int64_t{patience_ms} * 1000;
    std::size_t got = 0;
    for (;;) {
        TRY(parts.look());
        if (const int error = parts.from_host->error(); error != 0 && error != ECONNRESET) {
            parts.from_host->forget();
            return parts.lost(error);
        }
        if (parts.from_host->waiting() && parts.to_host->idle()) {
            parts.to_host->forget();
            const BulkOut::Taken taken = parts.from_host->take(into.subspan(got));
            got += taken.bytes;
            parts.from_host->arm();
            if (taken.ended || got == into.size())
                return got;
            continue;
        }
        if (parts.from_host->waiting()) { // first it takes what it asked for
            if (parts.forgotten()) {
                ++parts.cable.counts.given_up;
                (void)parts.clear_to_host();
            } else
                parts.wait(std::int64_t{parts.rules.forgotten_ms} * 250);
            continue;
        }
        parts.from_host->arm();
        const std::int64_t left_us = patience_ms < 0 || got > 0 ? kSliceUs : until_us - monotonic_us();
        if (left_us <= 0)
            return failure(Fault::kTryAgain, "the computer has nothing to say");
        parts.wait(left_us);
    }
}

Status FfsLink::send(std::span<const std::byte> bytes, bool last)
{
    Parts& parts = *parts_;
    if (bytes.size() > kMostPartBytes || (!last && bytes.size() % parts.packet_bytes != 0))
        return failure(Fault::kSoftware, "a part of %zu bytes for the cable: whole packets, %zu at most", bytes.size(),
                       kMostPartBytes);
    parts.settle();
    TRY(parts.look());
    if (parts.to_host->idle())
        parts.moved_us = monotonic_us();
    while (parts.to_host->error() != 0 || !parts.to_host->has_room())
        TRY(parts.await_room());
    parts.to_host->send(bytes, last, parts.packet_bytes);
    return {};
}

void FfsLink::post_event(std::span<const std::byte> container)
{
    Parts& parts = *parts_;
    parts.settle();
    {
        const std::lock_guard guard(parts.cable.lock);
        if (!parts.cable.image.enabled() || container.size() > kEventPacket)
            return;
        parts.cable.image.posted(container);
    }
    for (std::size_t i = 0; i < kEvents; ++i) {
        if (parts.events[i].under_way)
            continue;
        const std::span<std::byte> memory = parts.event_memory.subspan(i * kEventBytes, container.size());
        std::copy(container.begin(), container.end(), memory.begin());
        parts.queue.write(parts.events[i], parts.endpoints.events.get(), memory);
        return;
    }
    ++parts.cable.counts.events_dropped;
}

bool FfsLink::interrupted() const
{
    const std::lock_guard guard(parts_->cable.lock);
    return parts_->cable.image.interrupted();
}

void FfsLink::begin_transaction(std::uint32_t id)
{
    const std::lock_guard guard(parts_->cable.lock);
    parts_->cable.image.begin(id);
}

void FfsLink::end_transaction()
{
    const std::lock_guard guard(parts_->cable.lock);
    parts_->cable.image.end();
}

bool FfsLink::take_reset()
{
    const std::lock_guard guard(parts_->cable.lock);
    return parts_->cable.image.take_reset();
}

const CableCounts& FfsLink::counts() const noexcept
{
    return parts_->cable.counts;
}

CableState FfsLink::state() const noexcept
{
    const std::lock_guard guard(parts_->cable.lock);
    const StillImage& image = parts_->cable.image;
    return !image.enabled()    ? CableState::kNoHost
           : image.suspended() ? CableState::kSuspended
                               : CableState::kConfigured;
}

} // namespace dicot
