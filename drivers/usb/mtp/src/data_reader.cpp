#include "dicot/mtp/data_reader.h"

#include "dicot/base/utc_time.h"

namespace dicot::mtp {
namespace {

constexpr std::uint32_t kReplacement = 0xFFFD;

bool is_high_half(std::uint32_t unit) noexcept
{
    return unit >= 0xD800 && unit < 0xDC00;
}

bool is_low_half(std::uint32_t unit) noexcept
{
    return unit >= 0xDC00 && unit < 0xE000;
}

/// How many bytes; 0 if it does not fit.
std::size_t put_utf8(std::uint32_t character, std::span<char> into) noexcept
{
    const std::size_t size = character < 0x80 ? 1 : character < 0x800 ? 2 : character < 0x10000 ? 3 : 4;
    if (into.size() < size)
        return 0;
    static constexpr std::uint32_t kLead[] = {0, 0, 0xC0, 0xE0, 0xF0};
    for (std::size_t i = size; i-- > 1; character >>= 6)
        into[i] = static_cast<char>(0x80 | (character & 0x3F));
    into[0] = static_cast<char>(kLead[size] | character);
    return size;
}

std::optional<int> two_digits(std::string_view text) noexcept
{
    if (text.size() < 2 || text[0] < '0' || text[0] > '9' || text[1] < '0' || text[1] > '9')
        return std::nullopt;
    return (text[0] - '0') * 10 + (text[1] - '0');
}

} // namespace

std::uint64_t DataReader::number(std::size_t size) noexcept
{
    std::uint64_t value = 0;
    const auto taken = bytes(size);
    for (std::size_t i = 0; i < taken.size(); ++i)
        value |= static_cast<std::uint64_t>(taken[i]) << (8 * i);
    return value;
}

std::span<const std::byte> DataReader::bytes(std::size_t count) noexcept
{
    if (!ok_ || rest_.size() < count) {
        ok_ = false;
        rest_ = {};
        return {};
    }
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
}

std::uint32_t DataReader::count(std::size_t element_bytes) noexcept
{
    const std::uint32_t told = u32();
    if (told > rest_.size() / element_bytes) {
        ok_ = false;
        rest_ = {};
        return 0;
    }
    return told;
}

std::size_t DataReader::text_into(std::span<char> into) noexcept
{
    const std::size_t units = u8();
    DataReader in{bytes(2 * units)};
    std::size_t used = 0;
    std::uint32_t high = 0; // waits for its other half
    const auto put = [&](std::uint32_t character) {
        const std::size_t size = put_utf8(character, into.subspan(used));
        used += size;
        return size > 0;
    };
    while (in.left() > 0) {
        const std::uint32_t unit = in.u16();
        if (high != 0 && is_low_half(unit)) {
            if (!put(0x10000 + ((high - 0xD800) << 10) + (unit - 0xDC00)))
                return used;
            high = 0;
            continue;
        }
        if (high != 0 && !put(kReplacement))
            return used;
        high = is_high_half(unit) ? unit : 0;
        if (unit == 0)
            return used;
        if (high == 0 && !put(is_low_half(unit) ? kReplacement : unit))
            return used;
    }
    if (high != 0)
        put(kReplacement);
    return used;
}

std::optional<std::int64_t> parse_date(std::string_view text) noexcept
{
    constexpr std::size_t kSecond = 15; // YYYYMMDDThhmmss
    if (text.size() < kSecond)
        return std::nullopt;
    const ShortText<kSecond> second{text.substr(0, kSecond)};
    char stamp[kSecond + 1];
    second.view().copy(stamp, kSecond);
    stamp[kSecond] = 'Z';
    std::optional<std::int64_t> us = parse_utc_stamp({stamp, sizeof stamp});
    text.remove_prefix(kSecond);
    if (text.size() >= 2 && text[0] == '.' && text[1] >= '0' && text[1] <= '9')
        text.remove_prefix(2);
    if (!us || text.empty() || text == "Z")
        return us;
    const std::optional<int> hours = two_digits(text.substr(1)), minutes = two_digits(text.substr(text.size() - 2));
    if (text.size() != 5 || (text[0] != '+' && text[0] != '-') || !hours || !minutes)
        return std::nullopt;
    const std::int64_t east_us = (*hours * 60 + *minutes) * std::int64_t{60'000'000};
    return *us - (text[0] == '+' ? east_us : -east_us);
}

} // namespace dicot::mtp
