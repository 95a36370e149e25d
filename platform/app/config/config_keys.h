// The keys of the configuration: what is known of each stands in one table, which reads, checks, prints and explains.
#pragma once

#include "config.h"

#include <span>
#include <variant>

namespace dicot::app {

/// The way from a configuration to one value in it.
template <typename Value>
struct Reach
{
    Value& (*changeable)(Config&);
    const Value& (*fixed)(const Config&);

    Value& operator()(Config& config) const { return changeable(config); }
    const Value& operator()(const Config& config) const { return fixed(config); }
};

struct BindingKey
{
    Reach<CameraBinding> reach;
};

struct ChoiceKey
{
    Reach<std::string> reach;
    std::span<const char* const> choices;
};

/// A path; relative ones are relative to the file that has them.
struct PathKey
{
    Reach<std::string> reach;
    bool or_none = false; ///< "" is allowed
};

/// A name as is_device_name() has it, or none.
struct NameKey
{
    Reach<std::string> reach;
    const char* if_empty = "the host's name"; ///< what "" stands for
};

/// A text that parse_replay_script() understands.
struct ScriptKey
{
    Reach<std::string> reach;
};

/// A text that the rest of the program understands.
struct WordKey
{
    Reach<std::string> reach;
    bool (*understood)(std::string_view);
    const char* allowed; ///< in words
};

/// A list of such texts.
struct WordsKey
{
    Reach<std::vector<std::string>> reach;
    bool (*understood)(std::string_view);
    const char* allowed;
    std::size_t most;
};

struct FormatsKey
{
    Reach<std::vector<PixelFormat>> reach;
    std::span<const PixelFormat> choices;
};

struct WholeKey
{
    Reach<int> reach;
    int least, most;
    std::span<const int> choices; ///< empty: all of the range
    bool odd = false;             ///< odd numbers alone
};

struct NumberKey
{
    Reach<double> reach;
    double least, most;
};

/// A number that may be left open.
struct OpenNumberKey
{
    Reach<std::optional<double>> reach;
    double least, most;
};

struct FlagKey
{
    Reach<bool> reach;
};

struct ConfigKey
{
    const char* section;
    const char* name;
    const char* unit; ///< empty: none
    const char* meaning;
    std::variant<BindingKey, ChoiceKey, PathKey, NameKey, ScriptKey, WordKey, WordsKey, FormatsKey, WholeKey, NumberKey,
                 OpenNumberKey, FlagKey>
        kind;
};

/// All keys, section by section.
std::span<const ConfigKey> config_keys();

/// What may stand there, in words: "a whole number from 1 to 64", "\"auto\", \"v4l2\" or \"uvc\"".
std::string allowed_of(const ConfigKey& key);

/// A binding as the file has it: "", "port:1-1.2", "serial:ABC", "replay:FOLDER".
std::string text_of(const CameraBinding& binding);

/// The value as TOML has it; empty of a number that is open.
std::string toml_of(const ConfigKey& key, const Config& config);

} // namespace dicot::app
