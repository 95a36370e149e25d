#include "dicot/camera/bandwidth.h"

#include <algorithm>
#include <cstdio>
#include <limits>

namespace dicot {
namespace {

constexpr std::uint32_t kPayloadHeaderBytes = 12;
constexpr std::uint32_t kMjpegBitsAPixel = 4;

std::uint32_t intervals_per_s(UsbSpeed speed) noexcept
{
    return speed == UsbSpeed::kFull ? 1000 : 8000;
}

bool same_picture(const CameraMode& a, const CameraMode& b) noexcept
{
    return a.format == b.format && a.width == b.width && a.height == b.height;
}

bool same_wire(const BusUser& a, const BusUser& b) noexcept
{
    return a.bus >= 0 && a.bus == b.bus && a.speed == b.speed;
}

struct Sides
{
    const BusUser& left;
    const BusUser& right;
};

/// Bytes that a setting carries of every (micro)frame, evenly over the time.
std::uint32_t evenly(const AlternateSetting& setting) noexcept
{
    return setting.bytes_per_interval / std::max(setting.intervals_apart, 1U);
}

/// The smallest setting that holds what the device asked for, or, if it was not asked, that carries the estimate; null
/// if there is none.
const AlternateSetting* usual_setting(const BusUser& user, const StreamOffer& offer, std::uint32_t estimate) noexcept
{
    const AlternateSetting* best = nullptr;
    for (const AlternateSetting& one : user.settings) {
        const bool holds =
            offer.payload_bytes != 0 ? one.bytes_per_interval >= offer.payload_bytes : evenly(one) >= estimate;
        if (holds && one.bytes_per_interval != 0 &&
            (best == nullptr || one.bytes_per_interval < best->bytes_per_interval))
            best = &one;
    }
    return best;
}

/// The next setting below `one` that still carries `payload` bytes of every (micro)frame, or null.
const AlternateSetting* next_below(const BusUser& user, const AlternateSetting& one, std::uint32_t payload) noexcept
{
    const AlternateSetting* best = nullptr;
    for (const AlternateSetting& other : user.settings)
        if (other.bytes_per_interval < one.bytes_per_interval && evenly(other) >= payload &&
            (best == nullptr || other.bytes_per_interval > best->bytes_per_interval))
            best = &other;
    return best;
}

/// How one camera would stream an offer, `smaller` alternate settings below what its device asked for. False: it
/// cannot.
bool stream_for(const BusUser& user, const StreamOffer& offer, int smaller, PlannedStream& stream) noexcept
{
    stream = {.mode = offer.mode};
    if (offer.mode.interval_100ns == 0)
        return false;
    if (user.bus < 0)
        return smaller == 0;
    const std::uint32_t estimate = estimated_payload(offer.mode, user.speed);
    const std::uint32_t rate = intervals_per_s(user.speed);
    std::uint32_t bytes = user.bulk || offer.payload_bytes == 0 ? estimate : offer.payload_bytes;
    std::uint32_t apart = 1;
    if (!user.bulk && !user.settings.empty()) {
        const AlternateSetting* taken = usual_setting(user, offer, estimate);
        for (int step = 0; step < smaller && taken != nullptr; ++step)
            taken = user.chooses_alternate ? next_below(user, *taken, estimate) : nullptr;
        if (taken == nullptr)
            return false;
        stream.alternate = taken->number;
        bytes = taken->bytes_per_interval;
        apart = std::max(taken->intervals_apart, 1U);
    } else if (smaller > 0) {
        return false;
    }
    stream.reserved_bytes_per_s = user.bulk ? 0 : std::uint64_t{bytes} * rate / apart;
    stream.bus_time = bus_time(bytes, user.speed, user.bulk);
    return true;
}

/// The slowest that counts as the same rate: 1 % is no difference.
bool not_above(const CameraMode& rate, const CameraMode& other) noexcept
{
    return rate.interval_100ns >= other.interval_100ns - other.interval_100ns / 100;
}

/// The next offer of the picture of `mode` that is slower, or null.
const StreamOffer* next_slower(std::span<const StreamOffer> offers, const CameraMode& mode) noexcept
{
    const StreamOffer* next = nullptr;
    for (const StreamOffer& one : offers)
        if (same_picture(one.mode, mode) && one.mode.interval_100ns > mode.interval_100ns &&
            (next == nullptr || one.mode.interval_100ns < next->mode.interval_100ns))
            next = &one;
    return next;
}

/// The fastest right offer of the same picture that is not faster than `left`; null if there is none, or if a slower
/// offer of the left camera suits it better.
const StreamOffer* partner_of(const Sides& sides, const StreamOffer& left) noexcept
{
    const StreamOffer* best = nullptr;
    for (const StreamOffer& one : sides.right.offers)
        if (same_picture(one.mode, left.mode) && not_above(one.mode, left.mode) &&
            (best == nullptr || one.mode.interval_100ns < best->mode.interval_100ns))
            best = &one;
    if (best == nullptr)
        return nullptr;
    const StreamOffer* slower = next_slower(sides.left.offers, left.mode);
    const bool suits_better = slower != nullptr && not_above(best->mode, slower->mode);
    return suits_better && !not_above(left.mode, best->mode) ? nullptr : best;
}

/// What the ladder has come to.
struct Climb
{
    const BusUser& left;
    const BusUser& right;
    int refused = 0;
    std::uint64_t asked = std::numeric_limits<std::uint64_t>::max(); ///< bus time of the last plan that fitted
    bool paired = false;                                             ///< a format and size of both was met
    bool first_unfit = false;                                        ///< the first pair of the ladder did not fit
    bool first_uncarried = false;                                    ///< no alternate setting carries it
    bool first_seen = false;
    PlannedStream first_left, first_right;
    BandwidthPlan plan;

    /// True: this is the plan.
    bool step(const PlannedStream& l, const PlannedStream& r, Together together) noexcept
    {
        const std::uint64_t sum = std::uint64_t{l.bus_time} + r.bus_time;
        const bool at_once = together == Together::kAtOnce;
        const std::uint64_t all = at_once ? sum : std::max(l.bus_time, r.bus_time);
        const std::uint32_t budget = std::min(bus_budget(left.speed), bus_budget(right.speed));
        const bool fits = at_once && same_wire(left, right)
                              ? sum <= budget
                              : l.bus_time <= bus_budget(left.speed) && r.bus_time <= bus_budget(right.speed);
        if (!first_seen) {
            first_seen = true;
            first_unfit = !fits;
            first_left = l;
            first_right = r;
        }
        if (!fits || all >= asked)
            return false;
        asked = all;
        plan.together = together;
        plan.left = l;
        plan.right = r;
        return refused-- <= 0;
    }
};

/// All rates of the picture of `first`, from its own rate down, with settings `smaller` steps below the usual ones.
/// `any` tells whether there was such a step.
bool try_rates(Climb& climb, const StreamOffer& first, int smaller, Together together, bool& any) noexcept
{
    for (const StreamOffer* left = &first; left != nullptr; left = next_slower(climb.left.offers, left->mode))
        if (const StreamOffer* right = partner_of({climb.left, climb.right}, *left)) {
            climb.paired = true;
            PlannedStream l;
            PlannedStream r;
            PlannedStream deeper;
            int down_left = smaller;
            int down_right = smaller;
            // The camera whose settings end earlier stays at its smallest one.
            while (down_left > 0 && !stream_for(climb.left, *left, down_left, deeper))
                --down_left;
            while (down_right > 0 && !stream_for(climb.right, *right, down_right, deeper))
                --down_right;
            if (std::max(down_left, down_right) == smaller && stream_for(climb.left, *left, down_left, l) &&
                stream_for(climb.right, *right, down_right, r)) {
                any = true;
                if (climb.step(l, r, together))
                    return true;
            } else if (!climb.first_seen) {
                climb.first_seen = climb.first_uncarried = true;
                climb.first_left.mode = left->mode;
            }
        }
    return false;
}

bool climb_down(Climb& climb, Together together) noexcept
{
    const std::span<const StreamOffer> offers = climb.left.offers;
    const auto most = static_cast<int>(std::max(climb.left.settings.size(), climb.right.settings.size()));
    for (const StreamOffer& first : offers) {
        const auto same = [&](const StreamOffer& other) { return same_picture(other.mode, first.mode); };
        if (&*std::ranges::find_if(offers, same) != &first)
            continue;
        for (int smaller = 0; smaller <= most; ++smaller) {
            bool any = false;
            if (try_rates(climb, first, smaller, together, any))
                return true;
            if (!any && smaller > 0)
                break;
        }
    }
    return false;
}

struct Words
{
    char text[48];
};

Words words_of(const CameraMode& mode) noexcept
{
    Words words;
    const std::uint64_t interval = mode.interval_100ns;
    const std::uint64_t tenths = interval == 0 ? 0 : (100'000'000 + interval / 2) / interval; // 666,667 is 15.0
    std::snprintf(words.text, sizeof words.text, "%s %dx%d at %u.%u/s", name_of(mode.format), mode.width, mode.height,
                  static_cast<unsigned>(tenths / 10), static_cast<unsigned>(tenths % 10));
    return words;
}

Words place_of(const BusUser& left, const BusUser& right) noexcept
{
    Words words;
    if (same_wire(left, right))
        std::snprintf(words.text, sizeof words.text, "bus %d", left.bus);
    else
        std::snprintf(words.text, sizeof words.text, "buses of their own");
    return words;
}

/// How much of what may be reserved is taken.
int percent_of(const Climb& climb, const PlannedStream& left, const PlannedStream& right, bool at_once) noexcept
{
    const bool added = at_once && same_wire(climb.left, climb.right);
    const auto part = [](const BusUser& user, std::uint64_t time) { return 100 * time / bus_budget(user.speed); };
    const std::uint64_t percent = added ? part(climb.left, std::uint64_t{left.bus_time} + right.bus_time)
                                        : std::max(part(climb.left, left.bus_time), part(climb.right, right.bus_time));
    return static_cast<int>(std::min<std::uint64_t>(percent, 100000));
}

void say(Climb& climb, int refused) noexcept
{
    BandwidthPlan& plan = climb.plan;
    const auto put = [&](const char* format, auto... words) {
        std::snprintf(plan.why, sizeof plan.why, format, words...);
    };
    const Words mode = words_of(plan.left.mode);
    const Words first = words_of(climb.first_left.mode);
    const Words place = place_of(climb.left, climb.right);
    const bool at_once = plan.together == Together::kAtOnce;
    const int taken = percent_of(climb, plan.left, plan.right, at_once);
    const int wanted = percent_of(climb, climb.first_left, climb.first_right, true);
    if (plan.together == Together::kNotAtAll) {
        if (climb.left.offers.empty() || climb.right.offers.empty())
            put("no plan: the %s camera offers no mode that can be used", climb.left.offers.empty() ? "left" : "right");
        else if (!climb.paired)
            put("no plan: the cameras have no %s in common; use two cameras of one model", "format and size");
        else if (refused > 0)
            put("no plan: %s refused whatever fits, one camera at a time too; take other devices off it", place.text);
        else
            put("no plan: no mode of both fits on %s, not even one camera at a time; offer smaller modes", place.text);
        return;
    }
    const char* how = at_once ? "both at once" : "one camera after the other";
    if (refused > 0)
        put("%s, %s: %s answered %d times that it is full although %s fitted", mode.text, how, place.text, refused,
            climb.first_unfit ? "a greater plan" : first.text);
    else if (climb.first_unfit)
        put("%s, %s: takes %d %% of what may be reserved on %s, where %s would take %d %%", mode.text, how, taken,
            place.text, first.text, wanted);
    else if (climb.first_uncarried)
        put("%s, %s: no alternate setting carries %s; takes %d %% of what may be reserved on %s", mode.text, how,
            first.text, taken, place.text);
    else if (!at_once)
        put("%s, %s: no pair of modes fits at once on %s", mode.text, how, place.text);
    else if (climb.left.bus < 0 && climb.right.bus < 0)
        put("%s, %s: no bus is shared", mode.text, how);
    else
        put("%s, %s: takes %d %% of what may be reserved on %s", mode.text, how, taken, place.text);
}

} // namespace

std::uint32_t estimated_payload(const CameraMode& mode, UsbSpeed speed) noexcept
{
    if (mode.interval_100ns == 0 || mode.width <= 0 || mode.height <= 0)
        return 0;
    constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
    const std::uint64_t pixels = static_cast<std::uint64_t>(mode.width) * static_cast<std::uint64_t>(mode.height);
    std::uint64_t bytes = mode.format == PixelFormat::kMjpeg ? pixels * kMjpegBitsAPixel / 8 : frame_bytes(mode);
    bytes = std::min(bytes, kMost);
    const std::uint64_t intervals = std::uint64_t{mode.interval_100ns} * intervals_per_s(speed);
    const std::uint64_t payload = (bytes * 10'000'000 + intervals - 1) / intervals + kPayloadHeaderBytes;
    return static_cast<std::uint32_t>(std::min(payload, kMost));
}

std::uint32_t bus_budget(UsbSpeed speed) noexcept
{
    switch (speed) {
    case UsbSpeed::kFull:
        return 1350;
    case UsbSpeed::kHigh:
        return 6000;
    case UsbSpeed::kSuper:
        return 56250;
    }
    return 0;
}

std::uint32_t bus_time(std::uint32_t bytes, UsbSpeed speed, bool bulk) noexcept
{
    struct Wire
    {
        std::uint32_t packet, overhead, stuffed, of;
    };
    const auto wire = [&]() -> Wire {
        switch (speed) {
        case UsbSpeed::kFull:
            return bulk ? Wire{64, 13, 7, 6} : Wire{1023, 9, 7, 6};
        case UsbSpeed::kHigh:
            return bulk ? Wire{512, 55, 7, 6} : Wire{1024, 38, 7, 6};
        case UsbSpeed::kSuper:
            break;
        }
        return {1024, 32, 1, 1};
    }();
    const std::uint64_t packets = (std::uint64_t{bytes} + wire.packet - 1) / wire.packet;
    const std::uint64_t data = (std::uint64_t{bytes} * wire.stuffed + wire.of - 1) / wire.of;
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(data + packets * wire.overhead, std::numeric_limits<std::uint32_t>::max()));
}

BandwidthPlan plan_bandwidth(const BusUser& left, const BusUser& right, int refused) noexcept
{
    Climb climb{.left = left, .right = right, .refused = refused, .first_left = {}, .first_right = {}, .plan = {}};
    if (!climb_down(climb, Together::kAtOnce) && !climb_down(climb, Together::kOneAfterTheOther))
        climb.plan.together = Together::kNotAtAll;
    if (climb.plan.together == Together::kNotAtAll) {
        climb.plan.left = {};
        climb.plan.right = {};
    }
    say(climb, refused);
    return climb.plan;
}

} // namespace dicot
