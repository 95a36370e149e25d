// The block that a terminal shows.
#include "aim_advice.h"
#include "aim_text.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace dicot::app {
namespace {

constexpr int kLabel = 10; // columns
constexpr int kCell = 25;
constexpr int kBar = 20;

enum class Tone
{
    kPlain,
    kGood,
    kFair,
    kBad,
};

const char* escape(Tone tone)
{
    switch (tone) {
    case Tone::kGood:
        return "\033[32m";
    case Tone::kFair:
        return "\033[33m";
    case Tone::kBad:
        return "\033[31m";
    case Tone::kPlain:
        break;
    }
    return "";
}

/// Adds lines, none wider than the terminal.
class Block
{
public:
    Block(int columns, bool colours) : columns_(static_cast<std::size_t>(std::max(columns, 1))), colours_(colours) {}

    void put(std::string_view words, Tone tone = Tone::kPlain)
    {
        words = words.substr(0, columns_ - std::min(columns_, used_));
        used_ += words.size();
        const bool dyed = colours_ && tone != Tone::kPlain;
        if (dyed)
            text_ += escape(tone);
        text_ += words;
        if (dyed)
            text_ += "\033[0m";
    }
    /// Words, then spaces up to `width`.
    void put_cell(std::string_view words, int width, Tone tone = Tone::kPlain)
    {
        put(words, tone);
        const std::size_t wanted = static_cast<std::size_t>(width);
        put(std::string(words.size() < wanted ? wanted - words.size() : 1, ' '));
    }
    void end_line()
    {
        while (!text_.empty() && text_.back() == ' ')
            text_.pop_back();
        text_ += '\n';
        used_ = 0;
    }
    void put_line(std::string_view label, std::string_view words, Tone tone = Tone::kPlain)
    {
        put_cell(label, kLabel);
        put(words, tone);
        end_line();
    }
    /// A sentence on as many lines as it needs.
    void put_wrapped(std::string_view words)
    {
        std::string_view indent = "> ";
        while (!words.empty()) {
            const std::size_t room = columns_ > indent.size() + 8 ? columns_ - indent.size() : 8;
            std::size_t cut = words.size();
            if (cut > room) {
                cut = words.rfind(' ', room);
                cut = cut == std::string_view::npos || cut == 0 ? room : cut;
            }
            put(indent);
            put(words.substr(0, cut));
            end_line();
            words.remove_prefix(cut);
            while (!words.empty() && words.front() == ' ')
                words.remove_prefix(1);
            indent = "  ";
        }
    }
    std::string take() { return std::move(text_); }

private:
    std::size_t columns_;
    bool colours_;
    std::size_t used_ = 0;
    std::string text_;
};

Tone tone_of(const aiming::Focus& focus)
{
    if (!focus.known())
        return Tone::kPlain;
    return focus.whole >= aiming::kFocusSharp  ? Tone::kGood
           : focus.whole >= aiming::kFocusSoft ? Tone::kFair
                                               : Tone::kBad;
}

std::string focus_words(const AimSide& side)
{
    if (!side.focus.known())
        return "not known";
    return text_of("%d %s, best %d", side.focus.whole, focus_word(side.focus), side.best_focus);
}

/// The figure as a bar, and where it has been at best.
std::string bar(const AimSide& side)
{
    std::string bar(kBar, '.');
    const auto at = [](int figure) { return static_cast<std::size_t>(std::clamp(figure * kBar / 100, 0, kBar)); };
    std::fill_n(bar.begin(), at(side.focus.whole), '#');
    if (side.best_focus >= 0)
        bar[std::min<std::size_t>(at(side.best_focus), kBar - 1)] = '|';
    return "[" + bar + "]";
}

std::string rate_words(const AimSide& side)
{
    return side.frames_per_s > 0 ? text_of("%.1f /s", side.frames_per_s) : "-";
}

std::string flaw_words(const AimSide& side)
{
    return text_of("%llu torn, %llu lost", static_cast<unsigned long long>(side.torn),
                   static_cast<unsigned long long>(side.lost));
}

template <typename Words, typename Toned>
void put_sides(Block& block, std::string_view label, const AimMoment& now, const Words& words, const Toned& tone)
{
    block.put_cell(label, kLabel);
    block.put_cell(words(now.left), kCell, tone(now.left));
    block.put(words(now.right), tone(now.right));
    block.end_line();
}

void put_views(Block& block, const AimMoment& now)
{
    const aiming::Views& views = now.views;
    if (!views.known()) {
        block.put_line("overlap", text_of("not known: %d matches are too few", views.matches), Tone::kFair);
        return;
    }
    const bool little = views.overlap_percent < kLeastOverlapPercent;
    block.put_line("overlap", text_of("%d %%", views.overlap_percent), little ? Tone::kFair : Tone::kGood);
    const double vertical_px = std::fabs(views.vertical_px);
    block.put_line("vertical",
                   text_of("right shows things %.0f px %s", vertical_px, views.vertical_px > 0 ? "lower" : "higher"),
                   vertical_px > kMostVerticalShare * now.height ? Tone::kFair : Tone::kGood);
    const double roll_deg = std::fabs(views.roll_deg);
    if (roll_known(views))
        block.put_line("rotation",
                       text_of("right is turned %.1f degrees %s", roll_deg,
                               views.roll_deg > 0 ? "clockwise" : "counter-clockwise"),
                       roll_deg >= kMostRollDeg ? Tone::kFair : Tone::kGood);
    else
        block.put_line("rotation", text_of("not known: %d matches are too few", views.matches));
    switch (views.order) {
    case aiming::Order::kAsNamed:
        return block.put_line("order", "left is left", Tone::kGood);
    case aiming::Order::kSwapped:
        return block.put_line("order", "SWAPPED: left is right", Tone::kBad);
    case aiming::Order::kNotKnown:
        return block.put_line("order", "not known", Tone::kFair);
    }
}

} // namespace

std::string aim_block(const AimMoment& now, int columns, bool colours)
{
    const auto plain = [](const AimSide&) { return Tone::kPlain; };
    Block block(columns, colours);
    block.put(text_of("%d x %d px, %.0f s; Ctrl-C ends", now.width, now.height, now.elapsed_s));
    block.end_line();
    block.put_cell("", kLabel);
    block.put_cell("left", kCell);
    block.put("right");
    block.end_line();
    put_sides(block, "focus", now, focus_words, [](const AimSide& side) { return tone_of(side.focus); });
    put_sides(block, "", now, bar, [](const AimSide& side) { return tone_of(side.focus); });
    put_sides(
        block, "light", now,
        [](const AimSide& side) { return text_of("%d %s", side.light.mean_luma, light_word(side.light)); },
        [](const AimSide& side) {
            return std::string_view{light_word(side.light)} == "good" ? Tone::kGood : Tone::kBad;
        });
    put_sides(
        block, "saturated", now, [](const AimSide& side) { return text_of("%.1f %%", side.light.saturated_percent); },
        plain);
    put_sides(block, "frames", now, rate_words, plain);
    put_sides(block, "", now, flaw_words,
              [](const AimSide& side) { return side.torn + side.lost > 0 ? Tone::kFair : Tone::kPlain; });
    put_views(block, now);
    if (now.one_at_a_time)
        block.put_line("skew", "one camera after the other", Tone::kFair);
    else
        block.put_line("skew", text_of("%.1f ms", static_cast<double>(now.skew_us) / 1000));
    block.end_line();
    const std::vector<std::string> advice = aim_advice(now);
    for (const std::string& sentence : advice)
        block.put_wrapped(sentence);
    if (advice.empty())
        block.put_wrapped("all is well");
    return block.take();
}

} // namespace dicot::app
