#include "record_sax.h"

#include "dicot/base/printable.h"
#include "dicot/base/utc_time.h"

namespace dicot {
namespace {

constexpr int kMaxDepth = 32;

} // namespace

RecordSax::Key RecordSax::key_of(std::string_view name, Key around)
{
    struct Named
    {
        std::string_view name;
        Key around, key;
    };
    static constexpr Named kNamed[] = {
        {"format", Key::kOther, Key::kFormat},   {"sequence", Key::kOther, Key::kSequence},
        {"time", Key::kOther, Key::kTime},       {"due", Key::kOther, Key::kDue},
        {"outcome", Key::kOther, Key::kOutcome}, {"reason", Key::kOther, Key::kReason},
        {"clock", Key::kOther, Key::kClock},     {"trust", Key::kClock, Key::kTrust},
        {"cloud", Key::kOther, Key::kCloud},     {"points", Key::kCloud, Key::kPoints},
    };
    for (const Named& named : kNamed)
        if (named.around == around && named.name == name)
            return named.key;
    return Key::kOther;
}

bool RecordSax::refuse(const char* why)
{
    if (fault_ == nullptr)
        fault_ = why;
    return false;
}

const char* RecordSax::complaint() const
{
    if (fault_ != nullptr)
        return fault_;
    if (!has(Key::kFormat))
        return "it does not name its format";
    if (!has(Key::kSequence))
        return "there is no \"sequence\"";
    if (!has(Key::kTime))
        return "there is no \"time\"";
    if (!has(Key::kOutcome))
        return "there is no \"outcome\"";
    if (!has(Key::kTrust))
        return "there is no \"clock\" with its \"trust\"";
    if (facts_.done && !has(Key::kPoints))
        return "there is no \"cloud\" with its \"points\"";
    if (!facts_.done && !has_reason_)
        return "there is no \"reason\" of the miss";
    return nullptr;
}

bool RecordSax::key(std::string& name)
{
    const bool inside = depth_ == 2 && (around_ == Key::kClock || around_ == Key::kCloud);
    key_ = depth_ == 1 ? key_of(name, Key::kOther) : inside ? key_of(name, around_) : Key::kOther;
    if (key_ == Key::kOther)
        return true;
    bool& seen = seen_[static_cast<std::size_t>(key_)];
    if (seen)
        return refuse("a key stands there twice");
    seen = true;
    return true;
}

bool RecordSax::enter(bool object)
{
    if (depth_ == 0 && !object)
        return refuse("it is no object");
    if (key_ != Key::kOther && !(object && (key_ == Key::kClock || key_ == Key::kCloud)))
        return other_type();
    if (depth_ == kMaxDepth)
        return refuse("more than 32 levels stand in each other");
    if (depth_ == 1)
        around_ = key_;
    key_ = Key::kOther;
    ++depth_;
    return true;
}

bool RecordSax::leave()
{
    --depth_;
    key_ = Key::kOther;
    if (depth_ == 1)
        around_ = Key::kOther;
    return true;
}

bool RecordSax::other_type()
{
    if (depth_ == 0)
        return refuse("it is no object");
    return key_ == Key::kOther || refuse("a value is of another type, or out of its range");
}

bool RecordSax::take_text(std::string_view text)
{
    switch (key_) {
    case Key::kFormat:
        return text == kRecordFormat || refuse("it is of another format");
    case Key::kTime:
    case Key::kDue: {
        const std::optional<std::int64_t> us = parse_utc_text(text);
        if (!us)
            return refuse("a time is none: 2026-03-01T12:00:00Z would be");
        (key_ == Key::kTime ? facts_.began_us : facts_.due_us.emplace()) = *us;
        return true;
    }
    case Key::kOutcome:
        facts_.done = text == "done";
        return facts_.done || text == "missed" || refuse("\"outcome\" is neither \"done\" nor \"missed\"");
    case Key::kReason:
        facts_.reason = printable<255>(text);
        has_reason_ = true;
        return true;
    case Key::kTrust:
        if (text.size() > facts_.clock_trust.kCapacity || !is_printable(text))
            return refuse("\"trust\" of the clock is no short text");
        facts_.clock_trust = text;
        return true;
    default:
        return other_type();
    }
}

bool RecordSax::null()
{
    // Of the keys that matter, these may say that there is none.
    return (depth_ == 1 && (key_ == Key::kDue || key_ == Key::kReason)) || other_type();
}

bool RecordSax::number_unsigned(std::uint64_t value)
{
    if (key_ == Key::kSequence && value >= 1 && value <= static_cast<std::uint64_t>(kMaxSequence)) {
        facts_.sequence = static_cast<std::int64_t>(value);
        return true;
    }
    if (key_ == Key::kPoints && value <= static_cast<std::uint64_t>(kMaxRecordPoints)) {
        facts_.points = static_cast<std::int64_t>(value);
        return true;
    }
    return other_type();
}

bool RecordSax::string(std::string& value)
{
    return take_text(value);
}
bool RecordSax::boolean(bool)
{
    return other_type();
}
bool RecordSax::number_integer(std::int64_t)
{
    return other_type();
}
bool RecordSax::number_float(double, const std::string&)
{
    return other_type();
}
bool RecordSax::binary(nlohmann::json::binary_t&)
{
    return other_type();
}
bool RecordSax::start_object(std::size_t)
{
    return enter(true);
}
bool RecordSax::end_object()
{
    return leave();
}
bool RecordSax::start_array(std::size_t)
{
    return enter(false);
}
bool RecordSax::end_array()
{
    return leave();
}
bool RecordSax::parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&)
{
    return refuse("it is no JSON");
}

} // namespace dicot
