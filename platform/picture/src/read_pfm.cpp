#include "decode.h"
#include "decode_map.h"
#include "dicot/os/shown_path.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

namespace dicot {
namespace {

constexpr std::size_t kMaxWord = 32;

bool is_space(int c) noexcept
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/// One word of the header and the one blank behind it; blanks in front are passed over.
class Word
{
public:
    Status read(ByteSource& source) noexcept
    {
        int c = source.next();
        while (is_space(c))
            c = source.next();
        for (size_ = 0; c != -1 && !is_space(c); c = source.next()) {
            if (size_ == kMaxWord)
                return damaged(source.name(), "a number of its header is too long");
            text_[size_++] = static_cast<char>(c);
        }
        return c == -1 ? ended_early(source) : Status{};
    }
    template <typename Number>
    bool is(Number& number) const noexcept
    {
        const auto [end, error] = std::from_chars(text_, text_ + size_, number);
        return error == std::errc{} && end == text_ + size_;
    }

private:
    char text_[kMaxWord] = {};
    std::size_t size_ = 0;
};

std::uint32_t swapped(std::uint32_t v) noexcept
{
    return v >> 24 | (v >> 8 & 0xFF00U) | (v << 8 & 0xFF0000U) | v << 24;
}

Status read_row(ByteSource& source, std::span<float> row, bool swap) noexcept
{
    if (!source.read(std::as_writable_bytes(row)))
        return ended_early(source);
    for (float& value : row) {
        if (swap)
            value = std::bit_cast<float>(swapped(std::bit_cast<std::uint32_t>(value)));
        if (std::isnan(value) || value == -std::numeric_limits<float>::infinity())
            return failure(Fault::kBadData,
                           "%s: the map holds a value that is no number; a missing disparity is +infinity",
                           shown_path(source.name()));
    }
    return {};
}

} // namespace

Status decode_pfm(ByteSource& source, MapRequest& request) noexcept
{
    static_assert(std::endian::native == std::endian::little && sizeof(float) == 4);
    source.pass(2);
    if (const auto ahead = source.ahead(); !ahead.empty() && !is_space(std::to_integer<int>(ahead.front())))
        return damaged(source.name(), "a blank is expected behind its first two letters");
    Word word;
    std::uint64_t width = 0;
    std::uint64_t height = 0;
    double scale = 0;
    TRY(word.read(source));
    const bool width_is_number = word.is(width);
    TRY(word.read(source));
    if (!width_is_number || !word.is(height))
        return damaged(source.name(), "its header does not tell width and height");
    TRY(word.read(source));
    if (!word.is(scale) || !std::isfinite(scale) || scale == 0)
        return damaged(source.name(), "its scale is no number other than 0");
    TRY(accept_head(source.name(), width, height, MapKind::kPfm, request));
    if (request.into == nullptr)
        return {};
    const ImageView<float>& into = *request.into;
    for (int y = into.height - 1; y >= 0; --y)
        TRY(read_row(source, {into.row(y), static_cast<std::size_t>(into.width)}, scale > 0));
    return {};
}

} // namespace dicot
