#include "decode.h"

#include <cstdint>

namespace dicot {
namespace {

constexpr std::uint32_t kMaxSample = 65535;

bool is_space(int c) noexcept
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}
bool is_digit(int c) noexcept
{
    return c >= '0' && c <= '9';
}

/// One decimal number and the one character behind it; blanks and comments before it are passed over. Numbers stop
/// growing at ten digits: whatever that large is refused by its user.
Status next_number(ByteSource& source, std::uint64_t& number, bool end_may_follow) noexcept
{
    int c = source.next();
    while (is_space(c) || c == '#') {
        if (c == '#')
            while (c != '\n' && c != '\r' && c != -1)
                c = source.next();
        else
            c = source.next();
    }
    if (c == -1)
        return ended_early(source);
    if (!is_digit(c))
        return damaged(source.name(), "a number is expected");
    number = 0;
    for (; is_digit(c); c = source.next())
        if (number < 1'000'000'000)
            number = number * 10 + static_cast<std::uint64_t>(c - '0');
    if (c == -1 && !(end_may_follow && source.trouble().ok()))
        return ended_early(source);
    if (c != -1 && c != '#' && !is_space(c))
        return damaged(source.name(), "a number is expected");
    if (c == '#')
        while (c != '\n' && c != '\r' && c != -1)
            c = source.next();
    return {};
}

/// The samples of a picture, rounded to 8 bits. A Status is made only for a failure: it is too large to pass by value
/// for every sample.
class Samples
{
public:
    Samples(ByteSource& source, bool plain, std::uint32_t largest) noexcept
        : source_(source), plain_(plain), largest_(largest)
    {
    }

    /// False when there is no next sample; why() tells.
    bool next(std::uint8_t& value) noexcept
    {
        std::uint64_t raw = 0;
        if (plain_) {
            why_ = next_number(source_, raw, true);
            if (!why_.ok())
                return false;
        } else {
            for (int bytes = largest_ > 255 ? 2 : 1; bytes > 0; --bytes) {
                const int byte = source_.next();
                if (byte < 0) {
                    why_ = ended_early(source_);
                    return false;
                }
                raw = raw * 256 + static_cast<std::uint64_t>(byte);
            }
        }
        if (raw > largest_) {
            why_ = damaged(source_.name(), "a value is above the largest that its header tells");
            return false;
        }
        value = static_cast<std::uint8_t>((static_cast<std::uint32_t>(raw) * 255U + largest_ / 2) / largest_);
        return true;
    }

    const Status& why() const noexcept { return why_; }

private:
    ByteSource& source_;
    bool plain_;
    std::uint32_t largest_;
    Status why_;
};
static_assert(std::uint64_t{kMaxSample} * 255 + kMaxSample / 2 <= UINT32_MAX);

} // namespace

Status decode_pnm(ByteSource& source, PictureRequest& request) noexcept
{
    source.pass(1);
    const int kind = source.next();
    if (const auto ahead = source.ahead(); !ahead.empty()) {
        const int c = std::to_integer<int>(ahead.front());
        if (!is_space(c) && c != '#')
            return damaged(source.name(), "a blank is expected behind its first two letters");
    }
    const bool plain = kind == '2' || kind == '3';
    const bool colour = kind == '3' || kind == '6';
    std::uint64_t width = 0;
    std::uint64_t height = 0;
    std::uint64_t largest = 0;
    TRY(next_number(source, width, false));
    TRY(next_number(source, height, false));
    TRY(next_number(source, largest, false));
    if (largest == 0 || largest > kMaxSample)
        return damaged(source.name(), "its largest value is not in 1 .. 65535");
    TRY(accept_size(source.name(), width, height, request));
    if (request.into == nullptr)
        return {};

    Samples samples{source, plain, static_cast<std::uint32_t>(largest)};
    for (int y = 0; y < request.size.height; ++y) {
        Rgb8* const row = request.into->row(y);
        for (int x = 0; x < request.size.width; ++x) {
            Rgb8 pixel{};
            if (!samples.next(pixel.r) || (colour && !(samples.next(pixel.g) && samples.next(pixel.b))))
                return samples.why();
            row[x] = colour ? pixel : Rgb8{pixel.r, pixel.r, pixel.r};
        }
    }
    return {};
}

} // namespace dicot
