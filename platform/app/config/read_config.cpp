// Entries of a file into a configuration, each checked against its key.
#include "config.h"
#include "config_checks.h"
#include "config_keys.h"
#include "config_paths.h"
#include "device_name.h"
#include "nearest_name.h"
#include "toml_entries.h"

#include "dicot/camera/camera.h"
#include "dicot/os/shown_path.h"
#include "dicot/replay/replay_script.h"

#include <algorithm>
#include <climits>
#include <cstdio>

namespace dicot::app {
namespace {

constexpr std::size_t kMostPort = sizeof CameraIdentity::port.text - 1;
constexpr std::size_t kMostSerial = sizeof CameraIdentity::serial.text - 1;

bool is_path(std::string_view text)
{
    const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
    return !text.empty() && text.size() < PATH_MAX && std::ranges::none_of(text, control);
}

/// As devices are shown: printable ASCII.
bool is_device_text(std::string_view text, std::size_t most)
{
    const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
    return !text.empty() && text.size() <= most && std::ranges::all_of(text, printable);
}

/// "1-1.2": bus, root port, ports of hubs.
bool is_usb_port(std::string_view text)
{
    constexpr std::string_view kDigits = "0123456789";
    std::size_t at = text.find_first_not_of(kDigits);
    bool good = at != 0 && at != std::string_view::npos && text[at] == '-';
    while (good && at != std::string_view::npos) {
        text.remove_prefix(at + 1);
        at = text.find_first_not_of(kDigits);
        good = !text.empty() && at != 0 && (at == std::string_view::npos || text[at] == '.');
    }
    return good;
}

std::optional<CameraBinding> binding_of(std::string_view text)
{
    const auto rest = [&text](std::string_view kind) {
        return text.starts_with(kind) ? text.substr(kind.size()) : std::string_view{};
    };
    if (text.empty())
        return CameraBinding{};
    if (const auto port = rest("port:"); is_device_text(port, kMostPort))
        return CameraBinding{BoundBy::kPort, std::string{port}};
    if (const auto serial = rest("serial:"); is_device_text(serial, kMostSerial))
        return CameraBinding{BoundBy::kSerial, std::string{serial}};
    if (const auto folder = rest("replay:"); is_path(folder))
        return CameraBinding{BoundBy::kReplay, std::string{folder}};
    if (is_usb_port(text) && text.size() <= kMostPort)
        return CameraBinding{BoundBy::kPort, std::string{text}};
    return std::nullopt;
}

/// Takes a value for a key, or says no.
struct Taker
{
    const TomlValue& value;
    Config& config;

    bool operator()(const BindingKey& key) const
    {
        const auto* text = std::get_if<std::string>(&value);
        std::optional<CameraBinding> binding = text != nullptr ? binding_of(*text) : std::nullopt;
        if (binding)
            key.reach(config) = *std::move(binding);
        return binding.has_value();
    }
    bool operator()(const ChoiceKey& key) const
    {
        const auto* text = std::get_if<std::string>(&value);
        if (text == nullptr || std::ranges::find(key.choices, *text) == key.choices.end())
            return false;
        key.reach(config) = *text;
        return true;
    }
    bool operator()(const PathKey& key) const
    {
        const auto* text = std::get_if<std::string>(&value);
        if (text == nullptr || !(is_path(*text) || (key.or_none && text->empty())))
            return false;
        key.reach(config) = *text;
        return true;
    }
    bool operator()(const NameKey& key) const
    {
        const auto* text = std::get_if<std::string>(&value);
        if (text == nullptr || (!text->empty() && !is_device_name(*text)))
            return false;
        key.reach(config) = *text;
        return true;
    }
    bool operator()(const ScriptKey& key) const
    {
        const auto* text = std::get_if<std::string>(&value);
        if (text == nullptr)
            return false;
        key.reach(config) = *text;
        return true;
    }
    bool operator()(const WordKey& key) const
    {
        const auto* text = std::get_if<std::string>(&value);
        if (text == nullptr || !key.understood(*text))
            return false;
        key.reach(config) = *text;
        return true;
    }
    bool operator()(const WordsKey& key) const
    {
        const auto* texts = std::get_if<std::vector<std::string>>(&value);
        if (texts == nullptr || texts->size() > key.most || !std::ranges::all_of(*texts, key.understood))
            return false;
        key.reach(config) = *texts;
        return true;
    }
    bool operator()(const FormatsKey& key) const
    {
        const auto* names = std::get_if<std::vector<std::string>>(&value);
        if (names == nullptr || names->empty())
            return false;
        std::vector<PixelFormat> formats;
        for (const std::string& name : *names) {
            const auto known = std::ranges::find(key.choices, name, [](PixelFormat format) { return name_of(format); });
            if (known == key.choices.end() || std::ranges::find(formats, *known) != formats.end())
                return false;
            formats.push_back(*known);
        }
        key.reach(config) = formats;
        return true;
    }
    bool operator()(const WholeKey& key) const
    {
        const auto* whole = std::get_if<std::int64_t>(&value);
        if (whole == nullptr || *whole < key.least || *whole > key.most || (key.odd && *whole % 2 == 0))
            return false;
        if (!key.choices.empty() && std::ranges::find(key.choices, *whole) == key.choices.end())
            return false;
        key.reach(config) = static_cast<int>(*whole);
        return true;
    }
    bool operator()(const NumberKey& key) const
    {
        const std::optional<double> number = number_in(key.least, key.most);
        if (number)
            key.reach(config) = *number;
        return number.has_value();
    }
    bool operator()(const OpenNumberKey& key) const
    {
        const std::optional<double> number = number_in(key.least, key.most);
        if (number)
            key.reach(config) = number;
        return number.has_value();
    }
    bool operator()(const FlagKey& key) const
    {
        const auto* flag = std::get_if<bool>(&value);
        if (flag != nullptr)
            key.reach(config) = *flag;
        return flag != nullptr;
    }

    std::optional<double> number_in(double least, double most) const
    {
        double number = 0;
        if (const auto* real = std::get_if<double>(&value))
            number = *real;
        else if (const auto* whole = std::get_if<std::int64_t>(&value))
            number = static_cast<double>(*whole);
        else
            return std::nullopt;
        return number >= least && number <= most ? std::optional{number} : std::nullopt;
    }
};

/// What was there, for a sentence: printable, and short enough to leave room for the remedy.
std::string shown(std::string_view text, std::string_view mark)
{
    constexpr std::size_t kMost = 60;
    DeviceText<kMost> printable;
    printable.assign(text.data(), text.size());
    std::string quoted{mark.substr(0, 1)};
    return (quoted += printable.text) += text.size() > kMost ? "..." : mark.substr(1);
}

std::string shown(const TomlValue& value)
{
    char digits[40];
    if (const auto* text = std::get_if<std::string>(&value))
        return shown(*text, "\"\"");
    if (const auto* whole = std::get_if<std::int64_t>(&value))
        return std::to_string(*whole);
    if (const auto* number = std::get_if<double>(&value))
        return {digits, static_cast<std::size_t>(std::snprintf(digits, sizeof digits, "%.10g", *number))};
    if (const auto* flag = std::get_if<bool>(&value))
        return *flag ? "true" : "false";
    if (const auto* other = std::get_if<OtherValue>(&value))
        return other->type;
    std::string list;
    for (const std::string& text : std::get<std::vector<std::string>>(value))
        list += (list.empty() ? "\"" : ", \"") + text + "\"";
    return shown(list, "[]");
}

Status unknown(const TomlEntry& entry, const char* file)
{
    DeviceText<40> section;
    DeviceText<40> key;
    section.assign(entry.section.data(), entry.section.size());
    key.assign(entry.key.data(), entry.key.size());
    if (entry.key.empty())
        return failure(Fault::kConfig, "%s:%d: there is no section [%s]: did you mean [%s]?", file, entry.line,
                       section.text, nearest_section(entry.section));
    if (entry.section.empty() && is_section_name(entry.key))
        return failure(Fault::kConfig, "%s:%d: %s is %s: it is a section, write [%s] and its keys below", file,
                       entry.line, key.text, shown(entry.value).c_str(), key.text);
    const ConfigKey& near = nearest_key(entry.section, entry.key);
    if (entry.section.empty())
        return failure(Fault::kConfig, "%s:%d: %s stands outside of a section: did you mean %s below [%s]?", file,
                       entry.line, key.text, near.name, near.section);
    const std::string elsewhere = entry.section == near.section ? "" : std::string{" in ["} + near.section + "]";
    return failure(Fault::kConfig, "%s:%d: there is no key %s in [%s]: did you mean %s%s?", file, entry.line, key.text,
                   section.text, near.name, elsewhere.c_str());
}

Status take(const TomlEntry& entry, const char* file, const std::string& folder, LoadedConfig& loaded)
{
    if (entry.key.empty() && is_section_name(entry.section))
        return {};
    const std::span<const ConfigKey> keys = config_keys();
    const auto key = std::ranges::find_if(
        keys, [&entry](const ConfigKey& known) { return entry.section == known.section && entry.key == known.name; });
    if (key == keys.end())
        return unknown(entry, file);
    if (!std::visit(Taker{entry.value, loaded.config}, key->kind)) {
        const char* gap = *key->unit != '\0' ? " " : "";
        return failure(Fault::kConfig, "%s:%d: [%s] %s is %s: give %s%s%s", file, entry.line, key->section, key->name,
                       shown(entry.value).c_str(), allowed_of(*key).c_str(), gap, key->unit);
    }
    if (const auto* script = std::get_if<ScriptKey>(&key->kind)) {
        char name[300];
        std::snprintf(name, sizeof name, "%s:%d: [%s] %s", file, entry.line, key->section, key->name);
        TRY(parse_replay_script(script->reach(loaded.config), name));
    }
    take_from(folder, *key, loaded.config);
    loaded.lines[static_cast<std::size_t>(key - keys.begin())] = entry.line;
    return {};
}

} // namespace

Result<LoadedConfig> parse_config(std::string_view text, const std::string& name, const std::string& folder)
{
    const char* file = shown_path(name.c_str());
    if (text.size() > kMostConfigBytes)
        return failure(Fault::kConfig, "%s: a configuration has %zu bytes at most", file, kMostConfigBytes);
    const std::vector<TomlEntry> entries = TRY(toml_entries(text, file));
    LoadedConfig loaded;
    loaded.file = name;
    loaded.lines.assign(config_keys().size(), 0);
    for (const TomlEntry& entry : entries)
        TRY(take(entry, file, folder, loaded));
    TRY(check_together(loaded));
    return loaded;
}

} // namespace dicot::app
