#include "rig_quality.h"

#include "rig_values.h"

#include <cstdint>

namespace dicot {
namespace {

using Kind = YamlEvents::Kind;
constexpr std::array<std::string_view, 3> kVerdicts{"good", "usable", "redo"};

Status read_verdict(YamlEvents& events, RigQuality& quality)
{
    for (const std::string_view verdict : kVerdicts)
        if (events.kind() == Kind::kScalar && events.scalar() == verdict) {
            verdict.copy(quality.verdict, RigQuality::kVerdictBytes);
            events.next();
            return {};
        }
    return wrong_value(events, "quality: verdict", "good, usable or redo");
}

Status take(YamlEvents& events, std::string_view key, RigQuality& quality, std::uint32_t& seen)
{
    const auto numbers = numbers_of(quality);
    std::uint32_t mark = 1;
    const auto is_new = [&]() -> Status {
        if ((seen & mark) != 0)
            return wrong_value(events, key, "there once only");
        seen |= mark;
        return {};
    };
    for (const QualityNumber& number : numbers) {
        if (key == number.key) {
            TRY(is_new());
            *number.at = TRY(read_number(events, key));
            return *number.at >= 0 ? Status{} : wrong_value(events, key, "0 or more");
        }
        mark <<= 1U;
    }
    if (key == "pairs") {
        TRY(is_new());
        quality.pairs = TRY(read_whole(events, key));
        return quality.pairs >= 0 ? Status{} : wrong_value(events, key, "0 or more");
    }
    mark <<= 1U;
    if (key == "verdict") {
        TRY(is_new());
        return read_verdict(events, quality);
    }
    events.skip_value();
    return events.status();
}

} // namespace

std::array<QualityNumber, 10> numbers_of(RigQuality& quality)
{
    static_assert(RigQuality::kDepthsMm == std::array<int, 3>{500, 800, 1000});
    return {{{"rms_px", &quality.rms_px},
             {"epipolar_rms_px", &quality.epipolar_rms_px},
             {"epipolar_p95_px", &quality.epipolar_p95_px},
             {"held_out_mm", &quality.held_out_mm},
             {"held_out_depth_mm", &quality.held_out_depth_mm},
             {"depth_error_at_500mm_mm", &quality.depth_error_mm[0]},
             {"depth_error_at_800mm_mm", &quality.depth_error_mm[1]},
             {"depth_error_at_1000mm_mm", &quality.depth_error_mm[2]},
             {"nearest_mm", &quality.nearest_mm},
             {"farthest_mm", &quality.farthest_mm}}};
}

Result<RigQuality> read_quality(YamlEvents& events, std::string_view key)
{
    if (events.kind() != Kind::kMapStart)
        return wrong_value(events, key, "a map of keys and values");
    events.next();
    RigQuality quality;
    std::uint32_t seen = 0;
    while (events.kind() == Kind::kScalar) {
        const KeyText field{events.scalar()};
        events.next();
        TRY(take(events, field.text(), quality, seen));
    }
    if (events.kind() != Kind::kMapEnd)
        return wrong_value(events, key, "a map of keys and values");
    constexpr std::uint32_t kAll = (1U << (std::tuple_size_v<decltype(numbers_of(quality))> + 2U)) - 1U;
    if (seen != kAll)
        return wrong_value(events, key, "whole: verdict, pairs and ten numbers (storage/FORMAT.md)");
    events.next();
    return quality;
}

} // namespace dicot
