#include "day_name.h"

#include "dicot/store/snapshot_name.h"

#include <algorithm>
#include <array>

namespace dicot {

std::optional<std::int64_t> day_number(std::string_view name)
{
    if (!is_day_name(name))
        return std::nullopt;
    std::array<char, 20> midnight{'0', '0', '0', '0', '-', '0', '0', '-', '0', '0',
                                  'T', '0', '0', ':', '0', '0', ':', '0', '0', 'Z'};
    std::ranges::copy(name, midnight.begin());
    const std::int64_t us = parse_utc_text({midnight.data(), midnight.size()}).value_or(-1);
    return us < 0 ? -1 : us / kDayUs;
}

} // namespace dicot
