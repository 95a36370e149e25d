// Warm-up: is the picture of a camera as bright as it will stay?
#pragma once

#include <array>
#include <cstdint>

namespace dicot {

struct SettlingRules
{
    static constexpr int kLeastWindow = 4;
    static constexpr int kMostWindow = 64;

    int window = 16;                  ///< frames under one slope; held to kLeastWindow .. kMostWindow
    int flat_in_a_row = 8;            ///< so many windows, each one frame later: a slow swing is flat at its turn alone
    std::uint32_t most_slope_q8 = 48; ///< levels a frame, in 1/256: 3 levels over a window
    std::uint32_t least_luma_q8 = 768; ///< a mean below it is a camera that is still dark
    std::uint32_t most_frames = 300;
    std::int64_t most_us = 20'000'000;
};

enum class SettlingState : std::uint8_t
{
    kWarming,
    kSettled,
    kGaveUp, ///< a bound was reached first; the figures say how far it was
};
const char* name_of(SettlingState state) noexcept;

struct SettlingFigures
{
    SettlingState state = SettlingState::kWarming;
    std::uint32_t frames = 0;       ///< fed until the state was final
    std::int64_t elapsed_us = 0;    ///< likewise
    std::int32_t slope_q16 = 0;     ///< least squares over the last window, levels a frame, in 1/65536, towards 0
    std::uint32_t mean_luma_q8 = 0; ///< of the last window, in 1/256 of a level, rounded down
    bool window_full = false;       ///< slope and mean are of no meaning before
};

/// Is fed the luma means of one camera, frame by frame. Integers only; a final state stays.
class Settling
{
public:
    Settling(const SettlingRules& rules, std::int64_t begin_us) noexcept;

    /// `mean_luma_q8`: LumaFigures::mean_q8 of a whole frame; what is above 255 levels counts as that. `now_us`: any
    /// clock that does not go back, the one of `begin_us`.
    SettlingState feed(std::uint32_t mean_luma_q8, std::int64_t now_us) noexcept;
    /// No frame came: the bound of time holds all the same.
    SettlingState note_time(std::int64_t now_us) noexcept;

    const SettlingFigures& figures() const noexcept { return figures_; }

private:
    bool flat() noexcept;

    SettlingRules rules_;
    std::int64_t begin_us_;
    std::array<std::uint32_t, SettlingRules::kMostWindow> luma_q8_{}; ///< frame k stands at k modulo the window
    int flat_so_far_ = 0;
    SettlingFigures figures_;
};

} // namespace dicot
