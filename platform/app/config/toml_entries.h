// A TOML file as a list of entries: the only door of toml++.
#pragma once

#include "dicot/base/status.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace dicot::app {

/// A value of a type that no key has.
struct OtherValue
{
    const char* type; ///< "a date", "a table"
};

using TomlValue = std::variant<bool, std::int64_t, double, std::string, std::vector<std::string>, OtherValue>;

struct TomlEntry
{
    std::string section; ///< empty: the key stands outside of all sections
    std::string key;     ///< empty: the section itself
    int line = 0;        ///< from 1
    TomlValue value;
};

/// In the order of their lines. A list whose members are not all texts, and a table in a section, are OtherValue.
/// Fault::kConfig, with `name` and the line: this is no TOML 1.0.
Result<std::vector<TomlEntry>> toml_entries(std::string_view text, const char* name);

} // namespace dicot::app
