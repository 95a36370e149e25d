#include "yaml_events.h"

#include "dicot/os/shown_path.h"

#include <algorithm>

namespace dicot {
namespace {

std::string_view text_of(const yaml_char_t* text)
{
    return text != nullptr ? std::string_view{reinterpret_cast<const char*>(text)} : std::string_view{};
}

} // namespace

YamlEvents::YamlEvents(std::span<const std::byte> text, const char* name) : name_(name)
{
    std::string_view rest{reinterpret_cast<const char*>(text.data()), text.size()};
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (rest.starts_with(kByteOrderMark))
        rest.remove_prefix(kByteOrderMark.size());
    if (rest.starts_with("%YAML")) {
        const std::size_t end = rest.find('\n');
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
        lines_before_ = 1;
    }
    if (yaml_parser_initialize(&parser_) == 0) {
        parser_ = {};
        status_ = failure(Fault::kOsError, "%s: no memory to read it", shown_path(name_));
        return;
    }
    if (rest.empty())
        status_ = failure(Fault::kBadData, "%s: nothing stands in it: take a copy of it, or calibrate again",
                          shown_path(name_));
    else if (rest.front() == '<')
        status_ = failure(Fault::kBadData, "%s: XML is not read: have OpenCV write it as .yml", shown_path(name_));
    rest = status_.ok() ? rest : std::string_view{" "}; // the parser wants something
    yaml_parser_set_input_string(&parser_, reinterpret_cast<const unsigned char*>(rest.data()), rest.size());
    next();
}

YamlEvents::~YamlEvents()
{
    if (has_event_)
        yaml_event_delete(&event_);
    yaml_parser_delete(&parser_);
}

std::string_view YamlEvents::scalar() const
{
    if (kind_ != Kind::kScalar)
        return {};
    return {reinterpret_cast<const char*>(event_.data.scalar.value), event_.data.scalar.length};
}

std::string_view YamlEvents::tag() const
{
    switch (kind_) {
    case Kind::kScalar:
        return text_of(event_.data.scalar.tag);
    case Kind::kListStart:
        return text_of(event_.data.sequence_start.tag);
    case Kind::kMapStart:
        return text_of(event_.data.mapping_start.tag);
    default:
        return {};
    }
}

int YamlEvents::line() const
{
    return (has_event_ ? static_cast<int>(event_.start_mark.line) : 0) + 1 + lines_before_;
}

Status YamlEvents::fault(const char* what) const
{
    return failure(Fault::kBadData, "%s: line %d: %s: mend the file or calibrate again", shown_path(name_), line(),
                   what);
}

void YamlEvents::refuse(const char* what)
{
    status_ = fault(what);
    kind_ = Kind::kEnd;
}

void YamlEvents::next()
{
    while (status_.ok()) {
        if (has_event_)
            yaml_event_delete(&event_);
        has_event_ = yaml_parser_parse(&parser_, &event_) != 0;
        if (!has_event_) {
            const int line = static_cast<int>(parser_.problem_mark.line) + 1 + lines_before_;
            status_ = failure(Fault::kBadData,
                              "%s: line %d: not YAML (%s): give a rig file as OpenCV's FileStorage writes it",
                              shown_path(name_), line, parser_.problem != nullptr ? parser_.problem : "unreadable");
            kind_ = Kind::kEnd;
            return;
        }
        switch (event_.type) {
        case YAML_STREAM_START_EVENT:
        case YAML_NO_EVENT:
        case YAML_DOCUMENT_END_EVENT:
            continue;
        case YAML_STREAM_END_EVENT:
            kind_ = Kind::kEnd;
            return;
        case YAML_DOCUMENT_START_EVENT:
            if (document_seen_)
                return refuse("something follows after the end of the rig's description");
            document_seen_ = true;
            continue;
        case YAML_ALIAS_EVENT:
            return refuse("references (*) have no place in a rig file");
        case YAML_SCALAR_EVENT:
            kind_ = Kind::kScalar;
            if (event_.data.scalar.anchor != nullptr)
                return refuse("anchors (&) have no place in a rig file");
            return;
        case YAML_SEQUENCE_START_EVENT:
        case YAML_MAPPING_START_EVENT: {
            const bool list = event_.type == YAML_SEQUENCE_START_EVENT;
            kind_ = list ? Kind::kListStart : Kind::kMapStart;
            if ((list ? event_.data.sequence_start.anchor : event_.data.mapping_start.anchor) != nullptr)
                return refuse("anchors (&) have no place in a rig file");
            if (++depth_ > kMaxDepth)
                return refuse("too many levels");
            return;
        }
        case YAML_SEQUENCE_END_EVENT:
        case YAML_MAPPING_END_EVENT:
            kind_ = event_.type == YAML_SEQUENCE_END_EVENT ? Kind::kListEnd : Kind::kMapEnd;
            --depth_;
            return;
        }
    }
    kind_ = Kind::kEnd;
}

void YamlEvents::skip_value()
{
    int open = 0;
    do {
        if (kind_ == Kind::kListStart || kind_ == Kind::kMapStart)
            ++open;
        else if (kind_ == Kind::kListEnd || kind_ == Kind::kMapEnd)
            --open;
        else if (kind_ == Kind::kEnd)
            return;
        next();
    } while (open > 0);
}

} // namespace dicot
