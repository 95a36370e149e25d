#include "toml_entries.h"

#include "dicot/camera/camera.h"

#include <toml++/toml.h>

#include <algorithm>

namespace dicot::app {
namespace {

TomlValue value_of(const toml::node& node)
{
    if (const auto* flag = node.as_boolean())
        return flag->get();
    if (const auto* whole = node.as_integer())
        return whole->get();
    if (const auto* number = node.as_floating_point())
        return number->get();
    if (const auto* text = node.as_string())
        return text->get();
    if (node.is_table())
        return OtherValue{"a table"};
    const toml::array* list = node.as_array();
    if (list == nullptr)
        return OtherValue{"a date or a time"};
    std::vector<std::string> texts;
    for (const toml::node& member : *list) {
        const auto* text = member.as_string();
        if (text == nullptr)
            return OtherValue{"a list of other things"};
        texts.push_back(text->get());
    }
    return texts;
}

int line_of(const toml::key& key)
{
    return static_cast<int>(key.source().begin.line);
}

} // namespace

Result<std::vector<TomlEntry>> toml_entries(std::string_view text, const char* name)
{
    const toml::parse_result parsed = toml::parse(text);
    if (!parsed) {
        DeviceText<150> why;
        why.assign(parsed.error().description().data(), parsed.error().description().size());
        return failure(Fault::kConfig, "%s:%d: this is not TOML: %s", name,
                       static_cast<int>(parsed.error().source().begin.line), why.text);
    }
    std::vector<TomlEntry> entries;
    for (const auto& [name_of_section, node] : parsed.table()) {
        const std::string section{name_of_section.str()};
        const toml::table* table = node.as_table();
        if (table == nullptr) {
            entries.push_back({"", section, line_of(name_of_section), value_of(node)});
            continue;
        }
        entries.push_back({section, "", line_of(name_of_section), OtherValue{"a table"}});
        for (const auto& [key, member] : *table)
            entries.push_back({section, std::string{key.str()}, line_of(key), value_of(member)});
    }
    std::ranges::stable_sort(entries, {}, &TomlEntry::line);
    return entries;
}

} // namespace dicot::app
