#include "dicot/camera_rig/settling.h"

#include <algorithm>

namespace dicot {
namespace {

constexpr std::uint32_t kMostLumaQ8 = 255 * 256;

// The sums below hold for the widest window and the steepest picture.
static_assert(std::int64_t{2} * 256 * SettlingRules::kMostWindow * SettlingRules::kMostWindow * kMostLumaQ8 <
              (std::int64_t{1} << 40));

} // namespace

const char* name_of(SettlingState state) noexcept
{
    switch (state) {
    case SettlingState::kWarming:
        return "warming up";
    case SettlingState::kSettled:
        return "settled";
    case SettlingState::kGaveUp:
        break;
    }
    return "gave up";
}

Settling::Settling(const SettlingRules& rules, std::int64_t begin_us) noexcept : rules_(rules), begin_us_(begin_us)
{
    rules_.window = std::clamp(rules.window, SettlingRules::kLeastWindow, SettlingRules::kMostWindow);
}

SettlingState Settling::feed(std::uint32_t mean_luma_q8, std::int64_t now_us) noexcept
{
    if (figures_.state != SettlingState::kWarming)
        return figures_.state;
    luma_q8_[figures_.frames % static_cast<std::uint32_t>(rules_.window)] = std::min(mean_luma_q8, kMostLumaQ8);
    ++figures_.frames;
    flat_so_far_ = flat() ? flat_so_far_ + 1 : 0;
    figures_.elapsed_us = now_us - begin_us_;
    if (flat_so_far_ > 0 && flat_so_far_ >= rules_.flat_in_a_row)
        figures_.state = SettlingState::kSettled;
    else if (figures_.frames >= rules_.most_frames)
        figures_.state = SettlingState::kGaveUp;
    return note_time(now_us);
}

SettlingState Settling::note_time(std::int64_t now_us) noexcept
{
    if (figures_.state != SettlingState::kWarming)
        return figures_.state;
    figures_.elapsed_us = now_us - begin_us_;
    if (figures_.elapsed_us >= rules_.most_us)
        figures_.state = SettlingState::kGaveUp;
    return figures_.state;
}

/// Least squares over x = 1 - n, 3 - n, .. n - 1, two a frame: slope a frame = 2 sum(x y) / sum(x x), and
/// sum(x x) = n (n n - 1) / 3.
bool Settling::flat() noexcept
{
    const std::int64_t n = rules_.window;
    if (figures_.frames < static_cast<std::uint32_t>(n))
        return false;
    std::int64_t products = 0;
    std::uint32_t sum_q8 = 0;
    for (std::int64_t k = 0; k < n; ++k) {
        const std::uint32_t luma_q8 =
            luma_q8_[(figures_.frames + static_cast<std::uint32_t>(k)) % static_cast<std::uint32_t>(n)];
        products += (2 * k + 1 - n) * static_cast<std::int64_t>(luma_q8);
        sum_q8 += luma_q8;
    }
    const std::int64_t squares = std::max<std::int64_t>(n * (n * n - 1) / 3, 1); // 2 at least for two frames
    figures_.window_full = true;
    figures_.slope_q16 = static_cast<std::int32_t>(2 * 256 * products / squares);
    figures_.mean_luma_q8 = sum_q8 / static_cast<std::uint32_t>(n);
    const std::int64_t steepness = products < 0 ? -products : products;
    return figures_.mean_luma_q8 >= rules_.least_luma_q8 &&
           2 * steepness <= squares * std::int64_t{rules_.most_slope_q8};
}

} // namespace dicot
