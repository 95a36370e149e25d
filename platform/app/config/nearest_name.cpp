#include "nearest_name.h"

#include <algorithm>
#include <array>

namespace dicot::app {
namespace {

/// Letters put in, left out or replaced (Levenshtein 1966). Of long texts the beginning counts.
std::size_t letters_apart(std::string_view a, std::string_view b)
{
    constexpr std::size_t kMost = 40;
    a = a.substr(0, kMost);
    b = b.substr(0, kMost);
    std::array<std::size_t, kMost + 1> row{};
    for (std::size_t j = 0; j <= b.size(); ++j)
        row[j] = j;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row[b.size()];
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
