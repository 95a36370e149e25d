#include "config_text.h"
#include "config_keys.h"
#include "config_paths.h"

#include "dicot/camera/camera.h"

#include <charconv>
#include <cstring>

namespace dicot::app {
namespace {

std::string quoted(std::string_view text)
{
    constexpr const char* kHex = "0123456789ABCDEF";
    std::string toml = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            toml += {'\\', c};
        else if (c == '\n')
            toml += "\\n";
        else if (byte < 0x20 || byte == 0x7f)
            toml += {'\\', 'u', '0', '0', kHex[byte >> 4], kHex[byte & 15]};
        else
            toml += c;
    }
    return toml + '"';
}

std::string shortest(double number)
{
    char digits[32];
    return {digits, std::to_chars(digits, digits + sizeof digits, number, std::chars_format::fixed).ptr};
}

template <typename Items, typename Shown>
std::string listed(const Items& items, const char* last_joint, Shown&& shown)
{
    std::string text;
    std::size_t i = 0;
    for (const auto& item : items) {
        text += i == 0 ? "" : i + 1 == items.size() ? last_joint : ", ";
        text += shown(item);
        ++i;
    }
    return text;
}

std::string quoted_name(PixelFormat format)
{
    return quoted(name_of(format));
}

struct TomlOf
{
    const Config& config;

    std::string operator()(const BindingKey& key) const { return quoted(text_of(key.reach(config))); }
    std::string operator()(const ChoiceKey& key) const { return quoted(key.reach(config)); }
    std::string operator()(const PathKey& key) const { return quoted(key.reach(config)); }
    std::string operator()(const NameKey& key) const { return quoted(key.reach(config)); }
    std::string operator()(const ScriptKey& key) const { return quoted(key.reach(config)); }
    std::string operator()(const WordKey& key) const { return quoted(key.reach(config)); }
    std::string operator()(const WordsKey& key) const { return "[" + listed(key.reach(config), ", ", quoted) + "]"; }
    std::string operator()(const FormatsKey& key) const
    {
        return "[" + listed(key.reach(config), ", ", quoted_name) + "]";
    }
    std::string operator()(const WholeKey& key) const { return std::to_string(key.reach(config)); }
    std::string operator()(const NumberKey& key) const { return shortest(key.reach(config)); }
    std::string operator()(const OpenNumberKey& key) const
    {
        const std::optional<double>& number = key.reach(config);
        return number ? shortest(*number) : "";
    }
    std::string operator()(const FlagKey& key) const { return key.reach(config) ? "true" : "false"; }
};

struct AllowedOf
{
    std::string operator()(const BindingKey&) const
    {
        return R"("" (the first one found), "port:1-1.2", "serial:ABC" or "replay:FOLDER")";
    }
    std::string operator()(const ChoiceKey& key) const { return listed(key.choices, " or ", quoted); }
    std::string operator()(const PathKey& key) const { return key.or_none ? R"(a path, or "")" : "a path"; }
    std::string operator()(const NameKey& key) const
    {
        return R"("" ()" + std::string(key.if_empty) +
               "), or letters, digits, '.', '_' and '-', 63 at most and no date";
    }
    std::string operator()(const ScriptKey&) const { return "a text as drivers/README.md has it under replay"; }
    std::string operator()(const WordKey& key) const { return key.allowed; }
    std::string operator()(const WordsKey& key) const
    {
        return "a list of " + std::to_string(key.most) + " at most, each " + key.allowed;
    }
    std::string operator()(const FormatsKey& key) const
    {
        return "a list of " + listed(key.choices, " or ", quoted_name) + ", none of them twice";
    }
    std::string operator()(const WholeKey& key) const
    {
        if (!key.choices.empty())
            return listed(key.choices, " or ", [](int choice) { return std::to_string(choice); });
        return (key.odd ? "an odd number from " : "a whole number from ") + std::to_string(key.least) + " to " +
               std::to_string(key.most);
    }
    std::string operator()(const NumberKey& key) const { return range(key.least, key.most); }
    std::string operator()(const OpenNumberKey& key) const { return range(key.least, key.most); }
    std::string operator()(const FlagKey&) const { return "true or false"; }

    static std::string range(double least, double most)
    {
        return "a number from " + shortest(least) + " to " + shortest(most);
    }
};

/// What is known of a key, as two lines of remarks.
std::string remarks_on(const ConfigKey& key)
{
    const std::string usual = toml_of(key, Config{});
    std::string text = std::string{"# "} + key.meaning + ".\n#   ";
    if (*key.unit != '\0')
        text += std::string{key.unit} + "; ";
    return text + allowed_of(key) + "; default " + (usual.empty() ? "open" : usual);
}

/// Without line ends and the like, which would end a remark.
std::string one_line(const std::string& text)
{
    DeviceText<200> shown;
    shown.assign(text.data(), text.size());
    return shown.text;
}

/// `value_line` is told key and place, and gives the lines that follow the remarks.
template <typename ValueLine>
std::string all_sections(std::string text, ValueLine&& value_line)
{
    const char* section = "";
    std::size_t place = 0;
    for (const ConfigKey& key : config_keys()) {
        if (std::strcmp(section, key.section) != 0)
            text += std::string{"\n["} + key.section + "]\n";
        section = key.section;
        text += remarks_on(key) + value_line(key, place++);
    }
    return text;
}

} // namespace

std::string text_of(const CameraBinding& binding)
{
    switch (binding.by) {
    case BoundBy::kFirstFound:
        return "";
    case BoundBy::kPort:
        return "port:" + binding.what;
    case BoundBy::kSerial:
        return "serial:" + binding.what;
    case BoundBy::kReplay:
        return "replay:" + binding.what;
    }
    return "";
}

std::string toml_of(const ConfigKey& key, const Config& config)
{
    return std::visit(TomlOf{config}, key.kind);
}

std::string allowed_of(const ConfigKey& key)
{
    return std::visit(AllowedOf{}, key.kind);
}

std::string config_toml(const LoadedConfig& loaded, const std::string& here)
{
    const Config config = all_taken_from(here, loaded.config);
    const std::string origin = loaded.file.empty()
                                   ? "# What holds: the defaults, for there is no file.\n"
                                   : "# What holds: " + one_line(loaded.file) + ", and defaults where it is silent.\n";
    return all_sections(origin, [&](const ConfigKey& key, std::size_t place) {
        const int line = loaded.lines[place];
        const std::string value = toml_of(key, config);
        return (line == 0 ? ", not set\n" : ", set in line " + std::to_string(line) + "\n") +
               (value.empty() ? "#" : "") + key.name + " =" + (value.empty() ? "" : " ") + value + "\n";
    });
}

std::string config_sample()
{
    return all_sections(
        "# The configuration of dicot: /etc/dicot/dicot.toml, or what --config names. Each key stands here with its\n"
        "# default; take the '#' before a key away to change it. Relative paths begin at the folder of this file.\n",
        [](const ConfigKey& key, std::size_t) {
            const std::string value = toml_of(key, Config{});
            return std::string{"\n#"} + key.name + " =" + (value.empty() ? "" : " ") + value + "\n";
        });
}

} // namespace dicot::app
