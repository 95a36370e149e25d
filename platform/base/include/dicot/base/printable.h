// Text from elsewhere, made fit for a terminal, a table and a file.
#pragma once

#include "dicot/base/short_text.h"

#include <cstddef>
#include <span>
#include <string_view>

namespace dicot {

/// Whether `text` is UTF-8 (RFC 3629) without control characters, line ends and marks that turn the direction of
/// writing.
bool is_printable(std::string_view text) noexcept;

/// `text` with U+FFFD instead of whatever is not printable: one for each such character, and one for each longest
/// beginning of a character that is cut short, as nlohmann's dump() replaces them. What does not fit is cut between
/// characters. How many bytes.
std::size_t printable_into(std::string_view text, std::span<char> into) noexcept;

/// The same in place. Applied twice, it changes nothing more.
template <std::size_t Capacity>
ShortText<Capacity> printable(std::string_view text) noexcept
{
    char bytes[Capacity];
    return std::string_view{bytes, printable_into(text, bytes)};
}

} // namespace dicot
