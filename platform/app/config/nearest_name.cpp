#include "nearest_name.h"

#include <algorithm>
#include <array>

namespace dicot::app {
namespace {

/// Letters put in, left out or replaced, and neighbours exchanged (Damerau 1964; no letter is touched twice). Of long
/// texts the beginning counts.
int letters_apart(std::string_view a, std::string_view b)
{
    constexpr std::size_t kMost = 40;
    a = a.substr(0, kMost);
    b = b.substr(0, kMost);
    std::array<std::array<int, kMost + 1>, kMost + 1> apart{}; // of the first i letters of a and the first j of b
    for (std::size_t i = 0; i <= kMost; ++i)
        apart[i][0] = apart[0][i] = static_cast<int>(i);
    for (std::size_t i = 1; i <= a.size(); ++i)
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int same = a[i - 1] == b[j - 1] ? 0 : 1;
            int& here = apart[i][j];
            here = std::min({apart[i - 1][j] + 1, apart[i][j - 1] + 1, apart[i - 1][j - 1] + same});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                here = std::min(here, apart[i - 2][j - 2] + 1);
        }
    return apart[a.size()][b.size()];
}

} // namespace

bool is_section_name(std::string_view name)
{
    return std::ranges::any_of(config_keys(), [name](const ConfigKey& key) { return name == key.section; });
}

const char* nearest_section(std::string_view name)
{
    return std::ranges::min_element(config_keys(), {},
                                    [name](const ConfigKey& key) { return letters_apart(name, key.section); })
        ->section;
}

const ConfigKey& nearest_key(std::string_view section, std::string_view name)
{
    return *std::ranges::min_element(config_keys(), {}, [section, name](const ConfigKey& key) {
        return letters_apart(name, key.name) + (section == key.section || section.empty() ? 0 : 2);
    });
}

} // namespace dicot::app
