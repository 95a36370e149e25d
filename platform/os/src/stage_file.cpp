#include "dicot/os/stage_file.h"

#include "dicot/base/crc32.h"
#include "dicot/os/shown_path.h"
#include "dicot/os/wait.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <span>
#include <type_traits>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dicot {

/// What an entry says, then what changes while it holds, which the checksum leaves out.
struct StageFile::Record
{
    std::uint32_t counter;
    std::uint32_t checksum; ///< of what follows, up to `lasted_us`
    char boot[40];
    char stage[32];
    std::uint64_t slot;
    std::int64_t due_us;
    std::int64_t bound_us;
    std::int64_t lasted_us;
    std::int64_t cut_off;
};

/// Two, written in turn: one of them is whole at any time.
struct StageFile::Page
{
    char mark[16];
    Record records[2];
};

namespace {

constexpr char kMark[16] = "dicot stage 1";

Status cannot_open(const char* path, int error) noexcept
{
    return failure(error == ENOSPC || error == EDQUOT || error == EIO ? Fault::kIoError : Fault::kCannotCreate,
                   "%s: cannot be opened (%s); run.state must name a folder that dicot may write to", shown_path(path),
                   strerrordesc_np(error));
}

std::span<const std::byte> guarded(const auto& record) noexcept
{
    using Record = std::remove_cvref_t<decltype(record)>;
    constexpr std::size_t begin = offsetof(Record, boot);
    return {reinterpret_cast<const std::byte*>(&record) + begin, offsetof(Record, lasted_us) - begin};
}

void store(std::int64_t& where, std::int64_t value) noexcept
{
    std::atomic_ref{where}.store(value, std::memory_order_relaxed);
}

} // namespace

static_assert(std::atomic_ref<std::int64_t>::is_always_lock_free);

StageFile::~StageFile()
{
    if (page_ != nullptr)
        ::munmap(page_, kBytes);
    if (descriptor_ >= 0)
        ::close(descriptor_);
}

std::optional<StageEntry> StageFile::newest(const Page& page) noexcept
{
    const Record* best = nullptr;
    for (const Record& record : page.records)
        if (record.checksum == crc32(guarded(record)) &&
            (best == nullptr || static_cast<std::int32_t>(record.counter - best->counter) > 0))
            best = &record;
    const BootId boot = boot_id();
    if (std::memcmp(page.mark, kMark, sizeof kMark) != 0 || best == nullptr || best->stage[0] == '\0' ||
        std::memcmp(best->boot, boot.text, sizeof boot.text) != 0)
        return std::nullopt;
    StageEntry entry;
    entry.stage = std::string_view{best->stage, ::strnlen(best->stage, sizeof best->stage)};
    entry.slot = best->slot;
    entry.due_us = best->due_us;
    entry.bound_us = best->bound_us;
    entry.lasted_us = best->lasted_us;
    entry.cut_off = best->cut_off != 0;
    return entry;
}

Status StageFile::open(const char* path) noexcept
{
    static_assert(sizeof(Page) <= kBytes);
    descriptor_ = ::open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY, 0644);
    if (descriptor_ < 0)
        return cannot_open(path, errno);
    struct stat what
    {
    };
    if (::fstat(descriptor_, &what) != 0 || !S_ISREG(what.st_mode))
        return cannot_open(path, EINVAL);
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
        return failure(Fault::kTryAgain, "%s: another dicot run is at work with it; stop that one first",
                       shown_path(path));
    // Blocks first: a mapped page without one is a SIGBUS on a full disk.
    if (const int error = ::posix_fallocate(descriptor_, 0, static_cast<off_t>(kBytes)); error != 0)
        return cannot_open(path, error);
    void* mapped = ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
    if (mapped == MAP_FAILED)
        return cannot_open(path, errno);
    page_ = static_cast<Page*>(mapped);
    previous_ = newest(*page_);
    std::memcpy(page_->mark, kMark, sizeof kMark);
    return {};
}

void StageFile::write(const StageEntry& entry) noexcept
{
    if (page_ == nullptr)
        return;
    Record* const before = current_.load(std::memory_order_relaxed);
    const bool second = before != nullptr
                            ? before == &page_->records[0]
                            : static_cast<std::int32_t>(page_->records[0].counter - page_->records[1].counter) > 0;
    Record& record = page_->records[second ? 1 : 0];
    Record next{};
    next.counter = page_->records[second ? 0 : 1].counter + 1;
    const BootId boot = boot_id();
    std::memcpy(next.boot, boot.text, sizeof boot.text);
    std::memcpy(next.stage, entry.stage.c_str(), entry.stage.view().size());
    next.slot = entry.slot;
    next.due_us = entry.due_us;
    next.bound_us = entry.bound_us;
    next.checksum = crc32(guarded(next));
    record.checksum = ~next.checksum; // while it is copied, it does not count
    std::atomic_signal_fence(std::memory_order_seq_cst);
    record = next;
    current_.store(&record, std::memory_order_release);
}

void StageFile::sign_of_life(std::int64_t lasted_us) noexcept
{
    if (Record* const record = current_.load(std::memory_order_acquire); record != nullptr)
        store(record->lasted_us, lasted_us);
}

void StageFile::cut_off(std::int64_t lasted_us) noexcept
{
    Record* const record = current_.load(std::memory_order_acquire);
    if (record == nullptr)
        return;
    store(record->lasted_us, lasted_us);
    store(record->cut_off, 1);
}

Result<std::optional<StageEntry>> StageFile::read(const char* path) noexcept
{
    const int descriptor = ::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    Page page{};
    const ssize_t count = descriptor < 0 ? -1 : ::read(descriptor, &page, sizeof page);
    const int error = errno;
    if (descriptor >= 0)
        ::close(descriptor);
    if (count < 0)
        return failure(Fault::kNoInput, "%s: cannot be read (%s)", shown_path(path), strerrordesc_np(error));
    if (static_cast<std::size_t>(count) < sizeof page)
        return std::optional<StageEntry>{};
    return newest(page);
}

ShortText<120> words_of(const StageEntry& entry) noexcept
{
    char words[121];
    const auto seconds = [](std::int64_t us) { return static_cast<long long>(us / 1'000'000); };
    int length =
        std::snprintf(words, sizeof words, "stage %s, after %lld s", entry.stage.c_str(), seconds(entry.lasted_us));
    if (entry.over_bound() && length > 0 && static_cast<std::size_t>(length) < sizeof words)
        std::snprintf(words + length, sizeof words - static_cast<std::size_t>(length), ", over its bound of %lld s",
                      seconds(entry.bound_us));
    return words;
}

} // namespace dicot
