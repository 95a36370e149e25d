#include "board_health.h"

#include "../store/shown.h"
#include "../store/slot_words.h"

#include "dicot/base/utc_time.h"

#include <cstdio>

namespace dicot::app {
namespace {

constexpr std::size_t kColumns = 100;
constexpr std::size_t kMostReasons = 8;
constexpr char kLine[] = "  %-12s  ";

/// A line, and what does not fit below it.
std::string line(const char* what, const std::string& text)
{
    char begin[32];
    const auto indent = static_cast<std::size_t>(std::snprintf(begin, sizeof begin, kLine, what));
    std::string lines = begin;
    std::size_t from = 0;
    while (text.size() - from > kColumns - indent) {
        std::size_t end = text.rfind(' ', from + kColumns - indent);
        if (end == std::string::npos || end <= from)
            end = from + kColumns - indent;
        lines += text.substr(from, end - from) + "\n" + std::string(indent, ' ');
        from = end + (text[end] == ' ' ? 1 : 0);
    }
    return lines + text.substr(from) + "\n";
}

std::string number(const std::optional<double>& figure, int digits, double scale = 1)
{
    if (!figure)
        return "-";
    char text[40];
    std::snprintf(text, sizeof text, "%.*f", digits, *figure * scale);
    return text;
}

std::string state_words(const BoardHealth& board)
{
    int counts[3] = {};
    for (const HealthFlag& flag : board.flags)
        ++counts[static_cast<int>(flag.severity)];
    std::string text;
    for (const Severity severity : {Severity::kAlarm, Severity::kWarning, Severity::kNotice})
        if (const int count = counts[static_cast<int>(severity)]; count > 0)
            text += (text.empty() ? "" : ", ") + counted(count, name_of(severity));
    if (!text.empty())
        return text;
    return board.newest ? "well" : board.newest_slot ? "no snapshot that can be read" : "no snapshot yet";
}

std::string figures_words(const HealthFigures& now)
{
    std::string text = "luma " + number(now.left.luma, 0) + " and " + number(now.right.luma, 0) + ", focus " +
                       number(now.left.focus, 0) + " and " + number(now.right.focus, 0);
    if (now.epipolar)
        text += ", rows " + number(now.epipolar->median_px, 2) + " px apart (spread " +
                number(now.epipolar->spread_px, 2) + ", corner " + number(now.epipolar->corner_px, 2) + ", " +
                counted(now.epipolar->points, "point") + ")";
    text += ", filled " + number(now.fill, 0, 100) + " %, skew " + number(now.skew_ms, 1) + " ms";
    if (now.hottest_c)
        text += ", " + number(now.hottest_c, 0) + " C";
    return text;
}

std::string miss_words(const BoardHealth& board)
{
    char text[80];
    std::snprintf(text, sizeof text, "%d of %s in the last %d days", board.missed, counted(board.slots, "slot").c_str(),
                  BoardHealth::kMissDays);
    std::string lines = line("missed", text);
    for (std::size_t i = 0; i < board.misses.size() && i < kMostReasons; ++i)
        lines += line("", std::to_string(board.misses[i].count) + " x " + shown(board.misses[i].reason) +
                              " (newest: " + std::to_string(board.misses[i].newest) + ")");
    if (board.misses.size() > kMostReasons)
        lines += line("", "and " + counted(static_cast<std::int64_t>(board.misses.size() - kMostReasons), "reason") +
                              " more: dicot list --missed");
    return lines;
}

std::string trend_words(const std::vector<HealthDay>& days)
{
    constexpr char kRow[] = "  %-12s  %6s %7s %6s %6s %8s %8s\n";
    char text[120];
    std::snprintf(text, sizeof text, kRow, "day (UTC)", "done", "missed", "luma", "focus", "rows px", "filled %");
    std::string table = text;
    for (const HealthDay& day : days) {
        std::snprintf(text, sizeof text, kRow, day.day.c_str(), std::to_string(day.done).c_str(),
                      std::to_string(day.missed).c_str(), number(day.luma, 0).c_str(), number(day.focus, 0).c_str(),
                      number(day.epipolar_px, 2).c_str(), number(day.fill, 0, 100).c_str());
        table += text;
    }
    return table;
}

} // namespace

std::string board_words(const BoardHealth& board, const std::string& device, const std::string& path)
{
    std::string text = shown(device) + ": " + state_words(board) + "\n" + line("store", shown(path));
    if (!board.newest_slot)
        return text;
    const SlotRow& slot = *board.newest_slot;
    text += line("newest slot", std::to_string(slot.sequence) + " " + state_of(slot) + ", " +
                                    utc_text(slot.began_us).c_str() + ", clock " + shown(slot.clock_trust.view()));
    if (board.newest)
        text += line("newest done", std::to_string(board.newest->sequence) + ": " + figures_words(*board.newest));
    for (const HealthFlag& flag : board.flags)
        text += line((std::string(name_of(flag.severity))).c_str(),
                     std::string(flag.id) + ": " + shown(flag.cause.view()) + " " + shown(flag.action.view()));
    text += miss_words(board);
    if (board.unread > 0)
        text += line("unread", counted(board.unread, "record") + " cannot be read: dicot verify names them");
    text += line("card", shown_bytes(static_cast<double>(board.summary.space.free_bytes)) +
                             " free: " + room_words(board.summary));
    return text + trend_words(board.trend);
}

} // namespace dicot::app
