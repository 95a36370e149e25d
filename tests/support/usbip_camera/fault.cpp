#include "fault.h"

#include <linux/usb/video.h>

#include <algorithm>
#include <charconv>
#include <span>

namespace dicot::usbip {

namespace {

struct Word
{
    std::string_view word;
    FaultKind kind;
    Place place;
    std::string_view numbers; ///< what it takes, with the defaults
};

// errno 71 is EPROTO, what a lost isochronous packet comes back with; 28 is ENOSPC.
constexpr Word kWords[] = {
    {"unplug", FaultKind::kUnplug, Place::kFrame, "byte=0 back_ms=0"},
    {"silent", FaultKind::kSilent, Place::kFrame, ""},
    {"hang", FaultKind::kHang, Place::kFrame, ""},
    {"late", FaultKind::kLate, Place::kFrame, "ms=1000"},
    {"zero_frame", FaultKind::kZeroFrame, Place::kFrame, ""},
    {"truncate", FaultKind::kTruncate, Place::kFrame, "byte=1000"},
    {"overlong", FaultKind::kOverlong, Place::kFrame, "bytes=4096"},
    {"no_eof", FaultKind::kNoEof, Place::kFrame, ""},
    {"drop", FaultKind::kDrop, Place::kFrame, "packet=1 count=1 errno=71"},
    {"short", FaultKind::kShort, Place::kFrame, "packet=1 count=1 bytes=100"},
    {"bad_header", FaultKind::kBadHeader, Place::kFrame, "packet=1 count=1 length=0"},
    {"wrong_fid", FaultKind::kWrongFid, Place::kFrame, "packet=1 count=1"},
    {"err", FaultKind::kErr, Place::kFrame, "packet=1 count=1"},
    {"halt", FaultKind::kHalt, Place::kFrame, "packet=1 count=1"},
    {"stall", FaultKind::kStall, Place::kControl, "unit=-1 selector=-1 request=-1 times=1"},
    {"mute", FaultKind::kMute, Place::kControl, "unit=-1 selector=-1 request=-1 times=1"},
    {"short_reply", FaultKind::kShortReply, Place::kControl, "unit=-1 selector=-1 request=-1 times=1 bytes=0"},
    {"refuse_interface", FaultKind::kRefuseInterface, Place::kControl, "times=1 errno=28"},
    {"cut_descriptors", FaultKind::kCutDescriptors, Place::kPlug, "byte=9"},
    {"product", FaultKind::kProduct, Place::kPlug, "text="},
};

struct RequestName
{
    std::string_view name;
    int number;
};
constexpr RequestName kRequests[] = {
    {"set_cur", UVC_SET_CUR}, {"get_cur", UVC_GET_CUR}, {"get_min", UVC_GET_MIN},   {"get_max", UVC_GET_MAX},
    {"get_res", UVC_GET_RES}, {"get_len", UVC_GET_LEN}, {"get_info", UVC_GET_INFO}, {"get_def", UVC_GET_DEF},
};

struct VerbName
{
    std::string_view name;
    Order::Verb verb;
};
constexpr VerbName kVerbs[] = {
    {"unplug", Order::Verb::kUnplug},
    {"plug", Order::Verb::kPlug},
    {"forget", Order::Verb::kForget},
    {"quit", Order::Verb::kQuit},
};

std::vector<std::string_view> words_of(std::string_view line)
{
    std::vector<std::string_view> words;
    for (std::size_t i = 0; i < line.size();) {
        const std::size_t start = line.find_first_not_of(" \t\r", i);
        if (start == std::string_view::npos)
            break;
        i = std::min(line.find_first_of(" \t\r", start), line.size());
        words.push_back(line.substr(start, i - start));
    }
    return words;
}

std::optional<std::int64_t> number_of(std::string_view text)
{
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size())
        return std::nullopt;
    return number;
}

// \xNN is a byte, \s a blank, \\ a backslash.
std::string unescaped(std::string_view text)
{
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        int byte = 0;
        if (text[i] == '\\' && i + 3 < text.size() && text[i + 1] == 'x' &&
            std::from_chars(text.data() + i + 2, text.data() + i + 4, byte, 16).ptr == text.data() + i + 4) {
            plain += static_cast<char>(byte);
            i += 3;
        } else if (text[i] == '\\' && i + 1 < text.size()) {
            ++i;
            plain += text[i] == 's' ? ' ' : text[i];
        } else {
            plain += text[i];
        }
    }
    return plain;
}

bool take_number(PlannedFault& fault, std::string_view key, std::string_view value)
{
    if (key == "text") {
        fault.text = unescaped(value);
        return true;
    }
    if (key == "request")
        for (const RequestName& request : kRequests)
            if (request.name == value) {
                fault.numbers[std::string(key)] = request.number;
                return true;
            }
    const std::optional<std::int64_t> number = number_of(value);
    if (!number)
        return false;
    fault.numbers[std::string(key)] = *number;
    return true;
}

Status wrong(int number, std::string_view word, const char* remedy)
{
    return failure(Fault::kConfig, "line %d: '%.*s' %s", number,
                   static_cast<int>(std::min<std::size_t>(word.size(), 80)), word.data(), remedy);
}

Status take_numbers(PlannedFault& fault, const Word& known, std::span<const std::string_view> given, int number)
{
    for (const std::string_view pair : words_of(known.numbers)) {
        const std::size_t equals = pair.find('=');
        take_number(fault, pair.substr(0, equals), pair.substr(equals + 1));
    }
    for (const std::string_view pair : given) {
        const std::size_t equals = std::min(pair.find('='), pair.size());
        const std::string_view key = pair.substr(0, equals);
        if (key != "text" ? fault.numbers.find(key) == fault.numbers.end() : known.kind != FaultKind::kProduct)
            return wrong(number, pair, "is no number of this fault; see the table in README.md");
        if (equals == pair.size() || !take_number(fault, key, pair.substr(equals + 1)))
            return wrong(number, pair, "should be key=number");
    }
    if (fault.place == Place::kControl)
        fault.left = fault["times"] > 0 ? fault["times"] : -1;
    return {};
}

Status take_place_in_stream(PlannedFault& fault, std::string_view stream, std::string_view frame, int number)
{
    if (stream == "next") {
        fault.next_stream = true;
    } else if (stream != "*") {
        const std::optional<std::int64_t> value = number_of(stream);
        if (!value || *value < 1)
            return wrong(number, stream, "should be a stream: a number from 1, next or *");
        fault.stream = static_cast<std::uint64_t>(*value);
    }
    if (frame != "*") {
        const std::optional<std::int64_t> value = number_of(frame);
        if (!value || *value < 0)
            return wrong(number, frame, "should be a frame: a number from 0 or *");
        fault.frame = *value;
    }
    return {};
}

} // namespace

std::int64_t PlannedFault::operator[](std::string_view key) const
{
    const auto found = numbers.find(key);
    return found == numbers.end() ? 0 : found->second;
}

Result<Line> read_line(std::string_view line, int number)
{
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty() || words[0].starts_with('#'))
        return Line{};
    if (words.size() < 3)
        return wrong(number, line, "is too short; see README.md for what a line says");

    if (words[1] == "now") {
        for (const VerbName& verb : kVerbs)
            if (verb.name == words[2])
                return Line{std::nullopt, Order{std::string(words[0]), verb.verb}};
        return wrong(number, words[2], "should be unplug, plug, forget or quit");
    }

    PlannedFault fault;
    fault.camera = words[0];
    fault.place = words[1] == "control" ? Place::kControl : words[1] == "plug" ? Place::kPlug : Place::kFrame;
    const std::size_t word_at = fault.place == Place::kFrame ? 3 : 2;
    if (words.size() <= word_at)
        return wrong(number, line, "names no fault; see the table in README.md");
    if (fault.place == Place::kFrame)
        TRY(take_place_in_stream(fault, words[1], words[2], number));
    for (const Word& known : kWords)
        if (known.word == words[word_at] && known.place == fault.place) {
            fault.kind = known.kind;
            fault.word = known.word;
            TRY(take_numbers(fault, known, std::span(words).subspan(word_at + 1), number));
            return Line{std::move(fault), std::nullopt};
        }
    return wrong(number, words[word_at], "is no fault of this place; see the table in README.md");
}

bool touches_packet(const PlannedFault& fault, std::int64_t index)
{
    const std::int64_t first = fault["packet"];
    const std::int64_t count = fault["count"];
    return index >= first && (count == 0 || index < first + count);
}

} // namespace dicot::usbip
