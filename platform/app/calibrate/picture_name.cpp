#include "picture_name.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace dicot::app {
namespace {

// No locale: names are bytes.
bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}
bool is_upper(char c)
{
    return c >= 'A' && c <= 'Z';
}
bool is_lower(char c)
{
    return c >= 'a' && c <= 'z';
}
bool is_letter(char c)
{
    return is_upper(c) || is_lower(c);
}

std::string lowered(std::string_view text)
{
    std::string low(text);
    for (char& c : low)
        c = is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
    return low;
}

struct Ending
{
    const char* text;
    int rank;
};
constexpr std::array<Ending, 6> kEndings{
    {{".png", 0}, {".ppm", 1}, {".pgm", 1}, {".pnm", 1}, {".jpg", 2}, {".jpeg", 2}}};

std::optional<Ending> ending_of(std::string_view name)
{
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos)
        return std::nullopt;
    const std::string end = lowered(name.substr(dot));
    const auto* found = std::find_if(kEndings.begin(), kEndings.end(), [&](const Ending& e) { return end == e.text; });
    return found == kEndings.end() ? std::nullopt : std::optional(*found);
}

const std::string kMark(1, '\0'); // no file's name holds it

/// Words of letters (a capital after a small letter begins a new one, and so does the last of several capitals before a
/// small one), numbers, single signs; lower case.
std::vector<std::string> words_of(std::string_view name)
{
    std::vector<std::string> words;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i];
        const char last = i > 0 ? name[i - 1] : '\0';
        const char next = i + 1 < name.size() ? name[i + 1] : '\0';
        const bool goes_on = (is_digit(c) && is_digit(last)) || (is_lower(c) && is_letter(last)) ||
                             (is_upper(c) && is_upper(last) && !is_lower(next));
        if (goes_on)
            words.back() += lowered({&c, 1});
        else
            words.push_back(lowered({&c, 1}));
    }
    return words;
}

std::string without_zeros(const std::string& number)
{
    const std::size_t first = number.find_first_not_of('0');
    return first == std::string::npos ? "0" : number.substr(first);
}

std::string_view number_at(std::string_view text, std::size_t at)
{
    std::size_t end = at;
    while (end < text.size() && is_digit(text[end]))
        ++end;
    return text.substr(at, end - at);
}

bool is_camera(const std::string& word)
{
    return word == "cam" || word == "camera";
}

/// A word, or a camera and its number, that tells a side.
struct SideWord
{
    std::size_t at = 0; ///< the word itself; of a camera, its number
    Side side = Side::kNone;
    int strength = 0; ///< the strongest decide
};

std::vector<SideWord> side_words(const std::vector<std::string>& words, CameraNumbers numbers)
{
    const int left_camera = numbers == CameraNumbers::kFromZero ? 0 : 1;
    std::vector<SideWord> found;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (word == "left" || word == "right")
            found.push_back({i, word == "left" ? Side::kLeft : Side::kRight, 3});
        else if (word == "l" || word == "r")
            found.push_back({i, word == "l" ? Side::kLeft : Side::kRight, 1});
        else if (is_camera(word)) {
            const std::size_t sign = i + 1 < words.size() && (words[i + 1] == "_" || words[i + 1] == "-") ? 1 : 0;
            const std::size_t at = i + 1 + sign;
            for (const int camera : {left_camera, left_camera + 1})
                if (at < words.size() && words[at] == std::to_string(camera))
                    found.push_back({at, camera == left_camera ? Side::kLeft : Side::kRight, 2});
        }
    }
    return found;
}

} // namespace

bool is_picture(std::string_view name)
{
    return ending_of(name).has_value();
}

bool names_camera(std::string_view name, int number)
{
    const std::vector<std::string> words = words_of(name);
    const std::vector<SideWord> found =
        side_words(words, number == 0 ? CameraNumbers::kFromZero : CameraNumbers::kFromOne);
    return std::any_of(found.begin(), found.end(), [&](const SideWord& word) {
        return word.strength == 2 && words[word.at] == std::to_string(number);
    });
}

PictureName read_name(std::string_view name, CameraNumbers numbers)
{
    PictureName result;
    result.ending = ending_of(name).value_or(Ending{"", 3}).rank;
    const std::size_t dot = name.rfind('.');
    std::vector<std::string> words = words_of(name.substr(0, dot));
    const std::vector<SideWord> found = side_words(words, numbers);
    int strongest = 0;
    for (const SideWord& word : found)
        strongest = std::max(strongest, word.strength);
    for (const SideWord& word : found)
        if (word.strength == strongest && result.side != word.side)
            result.side = result.side == Side::kNone ? word.side : Side::kBoth;
    // In folders for the sides the names within may say it once more, in weaker words.
    const bool in_folder = name.find('/') != std::string_view::npos;
    for (const SideWord& word : found)
        if (word.strength == strongest || (in_folder && word.side == result.side))
            words[word.at] = kMark;
    for (const std::string& word : words) {
        result.spelling += word;
        result.number += is_digit(word.front()) ? without_zeros(word) : word;
    }
    return result;
}

bool before(std::string_view a, std::string_view b)
{
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < a.size() && j < b.size()) {
        if (!is_digit(a[i]) || !is_digit(b[j])) {
            if (a[i] != b[j])
                return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
            ++i;
            ++j;
            continue;
        }
        const std::string_view whole_a = number_at(a, i);
        const std::string_view whole_b = number_at(b, j);
        const std::string value_a = without_zeros(std::string(whole_a));
        const std::string value_b = without_zeros(std::string(whole_b));
        if (value_a.size() != value_b.size())
            return value_a.size() < value_b.size();
        if (value_a != value_b)
            return value_a < value_b;
        i += whole_a.size();
        j += whole_b.size();
    }
    if (a.size() - i != b.size() - j)
        return a.size() - i < b.size() - j;
    return a < b; // they differ in leading zeros at most
}

} // namespace dicot::app
