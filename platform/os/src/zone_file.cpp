#include "zone_file.h"

#include "zone_rule.h"

#include <cstdint>
#include <string_view>

namespace dicot {
namespace {

constexpr std::int32_t kFarthestOffsetS = 26 * 3600; // RFC 8536, 3.2: from -25 to 26 hours
constexpr const char* kDamaged = "is damaged";

/// What is left of the file. Behind its end stand zeros, and good() is false.
class Bytes
{
public:
    explicit Bytes(std::span<const std::byte> bytes) noexcept : left_(bytes) {}

    bool good() const noexcept { return good_; }

    Bytes take(std::size_t count) noexcept
    {
        good_ = good_ && count <= left_.size();
        if (!good_)
            return Bytes{{}};
        const Bytes taken{left_.first(count)};
        left_ = left_.subspan(count);
        return taken;
    }

    std::int64_t big_endian(std::size_t width) noexcept
    {
        const Bytes number = take(width);
        std::uint64_t value = 0;
        for (const std::byte byte : number.left_)
            value = value << 8U | std::to_integer<std::uint64_t>(byte);
        return width == 4 ? static_cast<std::int32_t>(static_cast<std::uint32_t>(value))
                          : static_cast<std::int64_t>(value);
    }

    std::string_view text() const noexcept
    {
        return {static_cast<const char*>(static_cast<const void*>(left_.data())), left_.size()};
    }

private:
    std::span<const std::byte> left_;
    bool good_ = true;
};

struct Header
{
    char version = 0;
    std::size_t utc_flags = 0, standard_flags = 0, leaps = 0, times = 0, types = 0, letters = 0;

    std::size_t body_bytes(std::size_t time_bytes) const noexcept
    {
        return times * (time_bytes + 1) + types * 6 + letters + leaps * (time_bytes + 4) + standard_flags + utc_flags;
    }
};

/// Of no types: no header.
Header take_header(Bytes& bytes) noexcept
{
    constexpr std::size_t kMostOfEach = 10'000; // far more than any zone has; keeps sizes small
    Header header;
    if (bytes.take(4).text() != "TZif")
        return header;
    const Bytes version = bytes.take(1);
    header.version = version.good() ? version.text().empty() ? '\0' : version.text().front() : '\0';
    (void)bytes.take(15);
    std::size_t* const counts[] = {&header.utc_flags, &header.standard_flags, &header.leaps,
                                   &header.times,     &header.types,          &header.letters};
    bool sane = true;
    for (std::size_t* count : counts) {
        const std::int64_t number = bytes.big_endian(4);
        sane = sane && number >= 0 && number <= std::int64_t{kMostOfEach};
        *count = sane ? static_cast<std::size_t>(number) : 0;
    }
    return sane && bytes.good() ? header : Header{};
}

struct TypeTable
{
    Bytes bytes;
    std::size_t count;

    /// None: there is no such type, or its offset is none.
    std::optional<std::int32_t> offset_s(std::size_t type) const noexcept
    {
        if (type >= count)
            return std::nullopt;
        Bytes at = bytes;
        (void)at.take(type * 6);
        const std::int64_t offset = at.big_endian(4);
        if (!at.good() || offset <= -kFarthestOffsetS || offset >= kFarthestOffsetS)
            return std::nullopt;
        return static_cast<std::int32_t>(offset);
    }
};

} // namespace

const char* read_zone_file(std::span<const std::byte> file, ZoneTable& table) noexcept
{
    Bytes bytes{file};
    Header header = take_header(bytes);
    std::size_t time_bytes = 4;
    if (header.types > 0 && header.version >= '2') { // the same again, in 64 bits
        (void)bytes.take(header.body_bytes(time_bytes));
        header = take_header(bytes);
        time_bytes = 8;
    }
    if (header.types == 0)
        return "is no zone file";
    Bytes body = bytes.take(header.body_bytes(time_bytes));
    if (!bytes.good())
        return kDamaged;
    if (header.leaps > 0)
        return "counts leap seconds, which UTC as computers keep it does not: choose the zone without \"right/\"";
    Bytes times = body.take(header.times * time_bytes);
    Bytes kinds = body.take(header.times);
    const TypeTable types{body.take(header.types * 6), header.types};

    table = {};
    const std::optional<std::int32_t> first = types.offset_s(0);
    if (!first)
        return kDamaged;
    table.offset_s[0] = *first;
    std::int64_t newest_s = kNoChangeYet;
    for (std::size_t i = 0; i < header.times; ++i) {
        const std::int64_t at_s = times.big_endian(time_bytes);
        const auto kind = static_cast<std::size_t>(kinds.big_endian(1));
        const std::optional<std::int32_t> offset = types.offset_s(kind);
        if (!offset || at_s <= newest_s)
            return kDamaged;
        if (at_s <= 0)
            table.offset_s[0] = *offset;
        else if (!table.change(at_s, *offset))
            return "has more changes than dicot keeps";
        newest_s = at_s;
    }
    if (time_bytes == 4)
        return nullptr;
    const std::string_view footer = bytes.text();
    const std::size_t end = footer.find('\n', 1);
    if (!footer.starts_with('\n') || end == std::string_view::npos)
        return kDamaged;
    const std::string_view text = footer.substr(1, end - 1);
    if (text.empty()) // no rule is known: the newest offset holds
        return nullptr;
    const std::optional<ZoneRule> rule = parse_zone_rule(text);
    if (!rule)
        return kDamaged;
    return append_rule(*rule, newest_s, table) ? nullptr : "has more changes than dicot keeps";
}

} // namespace dicot
