// Putting words and figures into markup.
#pragma once

#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>

namespace dicot::app {

/// Any bytes as the text of an element or of a quoted attribute, in HTML and in XML alike: & < > " ' are written out,
/// line ends and tabs become blanks, what is no UTF-8 or no character of XML becomes U+FFFD.
std::string escaped(std::string_view text);

/// `value` with so many decimals, never "-0.0"; "unknown" when it is not finite.
std::string fixed(double value, int decimals);

/// What stands for one {} of fill(). Text goes in as it is: what came from outside is escaped() by the caller.
class Piece
{
public:
    Piece(std::string text) : text_(std::move(text)) {} // NOLINT(google-explicit-constructor)
    Piece(const char* text) : text_(text) {}            // NOLINT(google-explicit-constructor)
    template <std::integral Number>
    Piece(Number number) : text_(std::to_string(number)) // NOLINT(google-explicit-constructor)
    {
    }

    const std::string& text() const { return text_; }

private:
    std::string text_;
};

/// The pattern with its {} replaced, one after the other.
std::string fill(std::string_view pattern, std::initializer_list<Piece> pieces);

} // namespace dicot::app
