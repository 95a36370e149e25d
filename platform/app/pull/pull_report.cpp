#include "pull_report.h"

#include "../store/shown.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace dicot::app {
namespace {

std::string row_of(const std::string& board, const char* fresh, const char* size, const char* there, const char* left,
                   const char* trouble, const std::string& where, std::size_t width)
{
    char text[512];
    std::snprintf(text, sizeof text, "%-*s  %8s  %10s  %8s  %8s  %8s  %s\n", static_cast<int>(width), board.c_str(),
                  fresh, size, there, left, trouble, where.c_str());
    return text;
}

std::string number(std::int64_t count)
{
    return std::to_string(count);
}

std::string notes_of(const PullReport& report)
{
    const std::string board = shown(report.device) + ": ";
    std::string notes;
    if (report.elsewhere > 0)
        notes += board + counted(report.elsewhere, "snapshot") +
                 " left, as another computer has pulled them: --all takes them too\n";
    if (report.earlier > 0)
        notes += board + counted(report.earlier, "snapshot") + " left, as they began before --since\n";
    if (report.gone > 0)
        notes += board + counted(report.gone, "snapshot") + " pruned on the board before they could be pulled\n";
    if (report.put_aside > 0)
        notes += board + counted(report.put_aside, "snapshot") + " damaged here, now in quarantine/\n";
    if (report.takes_marks && !report.marks_why.empty())
        notes += board + "not told what is here, so it keeps all for others: " + shown(report.marks_why) + "\n";
    if (!report.clock.empty())
        notes += board + "clock " + shown(report.clock) + "\n";
    return notes;
}

} // namespace

std::string pull_table(const std::vector<PullReport>& reports)
{
    std::size_t width = 5;
    for (const PullReport& report : reports)
        width = std::max(width, std::min<std::size_t>(report.device.size(), 63));
    std::string text = row_of("board", "new", "size", "there", "left", "failed", "from", width);
    for (const PullReport& report : reports) {
        const std::int64_t trouble = report.damaged + report.conflicts + report.unreadable;
        text += row_of(shown(report.device), number(report.fresh).c_str(),
                       shown_bytes(static_cast<double>(report.bytes)).c_str(), number(report.there).c_str(),
                       number(report.elsewhere + report.earlier).c_str(), number(trouble).c_str(), shown(report.where),
                       width);
    }
    for (const PullReport& report : reports)
        text += notes_of(report);
    return text;
}

nlohmann::json pull_json(const PullReport& report)
{
    nlohmann::json told = {{"device", report.device},
                           {"serial", report.serial},
                           {"from", report.where},
                           {"offered", report.offered},
                           {"new", report.fresh},
                           {"bytes", report.bytes},
                           {"there", report.there},
                           {"left_elsewhere", report.elsewhere},
                           {"left_earlier", report.earlier},
                           {"damaged", report.damaged},
                           {"conflicts", report.conflicts},
                           {"gone", report.gone},
                           {"unreadable", report.unreadable},
                           {"damaged_here", report.damaged_here},
                           {"put_aside", report.put_aside},
                           {"marked", report.marked},
                           {"unmarked", report.unmarked},
                           {"mark_refused", report.mark_refused},
                           {"marks_refused", report.marks_why},
                           {"exit_code", report.outcome.exit_code()}};
    if (!report.clock.empty())
        told["clock"] = report.clock;
    if (!report.outcome.ok())
        told["error"] = report.outcome.message();
    return told;
}

} // namespace dicot::app
