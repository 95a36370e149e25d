// libyaml's events, tamed: plain scalars, lists and maps, nothing deeper or cleverer than a rig file needs.
#pragma once

#include "dicot/base/status.h"

#include <yaml.h>

#include <cstddef>
#include <span>
#include <string_view>

namespace dicot {

/// The events of one document. The first fault stays: afterwards every event is kEnd.
class YamlEvents
{
public:
    enum class Kind
    {
        kScalar,
        kListStart,
        kListEnd,
        kMapStart,
        kMapEnd,
        kEnd
    };
    static constexpr int kMaxDepth = 6;

    /// `text` must outlive the reader; a first line that begins with %YAML is passed over, since FileStorage's
    /// "%YAML:1.0" is no directive that YAML knows.
    YamlEvents(std::span<const std::byte> text, const char* name);
    ~YamlEvents();
    YamlEvents(const YamlEvents&) = delete;
    YamlEvents& operator=(const YamlEvents&) = delete;

    Kind kind() const { return kind_; }
    std::string_view scalar() const; ///< of a kScalar event, until the next one
    std::string_view tag() const;    ///< of a scalar, list or map start; empty when it has none
    int line() const;                ///< of the current event, counted from 1

    void next();
    /// Passes over the whole value that begins at the current event.
    void skip_value();

    /// Says what is wrong at the current line.
    Status fault(const char* what) const;
    const Status& status() const { return status_; }

private:
    void refuse(const char* what);

    const char* name_;
    int lines_before_ = 0;
    int depth_ = 0;
    bool has_event_ = false;
    bool document_seen_ = false;
    Kind kind_ = Kind::kEnd;
    Status status_;
    yaml_parser_t parser_;
    yaml_event_t event_;
};

} // namespace dicot
