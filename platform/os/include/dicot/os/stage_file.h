// Which stage of a slot is at work, where the next start finds it whatever ended this one.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace dicot {

using StageName = ShortText<31>;

struct StageEntry
{
    StageName stage;            ///< empty: none, the program rests or ended in order; never of one that was read
    std::uint64_t slot = 0;     ///< its number, 0: none
    std::int64_t due_us = 0;    ///< of the slot, since 1970, UTC
    std::int64_t bound_us = 0;  ///< 0: none
    std::int64_t lasted_us = 0; ///< from its beginning to its last sign of life
    bool cut_off = false;       ///< the program ended itself: the stage was past its bound and did not hear

    bool over_bound() const noexcept { return bound_us > 0 && (cut_off || lasted_us > bound_us); }
};

/// A small file that is mapped, so that an entry costs no write and outlives the process (kill -9 too), not a power
/// cut: after that it may be old, of another boot. Damaged or half-written entries are passed over. No heap.
class StageFile
{
public:
    static constexpr std::size_t kBytes = 4096;

    StageFile() noexcept = default;
    StageFile(const StageFile&) = delete;
    StageFile& operator=(const StageFile&) = delete;
    ~StageFile();

    /// Maps the file, made where it is missing; what it said before is previous(). One process at a time has it.
    /// Fault::kCannotCreate, kIoError; kTryAgain: another process has it.
    Status open(const char* path) noexcept;
    /// What the process before this one was at; none: no stage, a new file, another boot, nothing legible.
    const std::optional<StageEntry>& previous() const noexcept { return previous_; }

    void write(const StageEntry& entry) noexcept;       ///< `lasted_us` and `cut_off` begin at none
    void sign_of_life(std::int64_t lasted_us) noexcept; ///< async-signal-safe, as is the next
    void cut_off(std::int64_t lasted_us) noexcept;

    /// Reads one without changing it. Fault::kNoInput; none as for previous().
    static Result<std::optional<StageEntry>> read(const char* path) noexcept;

private:
    struct Record;
    struct Page;
    static std::optional<StageEntry> newest(const Page& page) noexcept;

    int descriptor_ = -1;
    Page* page_ = nullptr;
    std::atomic<Record*> current_{nullptr};
    std::optional<StageEntry> previous_;
};

/// "stage match, after 312 s, over its bound of 300 s".
ShortText<120> words_of(const StageEntry& entry) noexcept;

} // namespace dicot
