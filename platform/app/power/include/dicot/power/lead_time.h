// How long before a picture the board has to be awake, learned from how long it took.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace dicot::app {

enum class LeadPart
{
    kCameras, ///< from the beginning of a slot until the cameras are ready for the pair
    kResume,  ///< from the alarm until the program runs again, after suspend
    kBoot,    ///< from the alarm until the program runs, after power off
};
inline constexpr std::size_t kLeadParts = 3;

/// Each part leads by the longest of its last kKept times and a quarter, and a second more; by a default as long as
/// there are none. Kept in `<state>/lead`, which is written only when a lead changes by a second or more, and which is
/// no loss: one that is missing or damaged means the defaults. No heap.
class LeadTime
{
public:
    static constexpr std::size_t kKept = 8;
    static constexpr std::int64_t kMostUs = 600'000'000; ///< of one part; a time that is longer is taken as this
    static constexpr std::array<std::int64_t, kLeadParts> kDefaultUs{30'000'000, 5'000'000, 90'000'000};

    /// `state`: the folder; empty: nothing is kept.
    void open(const char* state) noexcept;
    std::int64_t of(LeadPart part) const noexcept;
    /// One more time. What cannot be written is told, and holds in memory all the same. Times below 0 are passed over.
    Status note(LeadPart part, std::int64_t took_us) noexcept;

    void parse(std::string_view text) noexcept; ///< the file; what is not legible is passed over
    ShortText<400> text() const noexcept;

private:
    struct Times
    {
        std::array<std::int64_t, kKept> us{};
        std::size_t count = 0, next = 0;
    };
    static void add(Times& times, std::int64_t took_us) noexcept;

    std::array<Times, kLeadParts> parts_{};
    std::array<std::int64_t, kLeadParts> kept_us_ = kDefaultUs; ///< leads as the file has them
    ShortText<255> file_;
};

} // namespace dicot::app
