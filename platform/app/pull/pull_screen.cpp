#include "pull_screen.h"

#include "../store/shown.h"

#include "dicot/os/clock.h"

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace dicot::app {
namespace {

constexpr std::int64_t kRedrawUs = 100'000;
constexpr std::int64_t kSentenceUs = 30'000'000;
constexpr std::int64_t kRateUs = 1'000'000; ///< sooner nobody knows how fast it goes

} // namespace

std::string shown_time_left(double seconds)
{
    const auto whole = static_cast<long long>(std::clamp(seconds, 0.0, 1e9) + 0.5);
    char text[64];
    if (whole < 60)
        std::snprintf(text, sizeof text, "%lld s", whole);
    else if (whole < 3600)
        std::snprintf(text, sizeof text, "%lld min %lld s", whole / 60, whole % 60);
    else
        std::snprintf(text, sizeof text, "%lld h %lld min", whole / 3600, whole % 3600 / 60);
    return text;
}

PullScreen::PullScreen() noexcept : terminal_(isatty(STDERR_FILENO) == 1) {}

PullScreen::~PullScreen()
{
    wipe();
}

std::string PullScreen::words_of(const Line& line, std::int64_t now_us)
{
    std::string text = line.board + ": " + std::to_string(line.done) + " of " + counted(line.all, "snapshot");
    text += ", " + shown_bytes(static_cast<double>(line.bytes_done));
    const double elapsed_s = static_cast<double>(now_us - line.start_us) * 1e-6;
    const auto done = static_cast<double>(line.bytes_all > 0 ? line.bytes_done : static_cast<std::uint64_t>(line.done));
    const auto all = static_cast<double>(line.bytes_all > 0 ? line.bytes_all : static_cast<std::uint64_t>(line.all));
    if (!line.ended && now_us - line.start_us >= kRateUs && done > 0 && all >= done)
        text += ", " + shown_bytes(static_cast<double>(line.bytes_done) / elapsed_s) + "/s, " +
                shown_time_left(elapsed_s * (all - done) / done) + " left";
    return text;
}

void PullScreen::wipe()
{
    if (drawn_ > 0)
        std::fprintf(stderr, "\033[%zuA\r\033[J", drawn_);
    drawn_ = 0;
}

void PullScreen::draw(std::int64_t now_us)
{
    if (!terminal_)
        return;
    wipe();
    for (const Line& line : lines_)
        std::fprintf(stderr, "%s\n", words_of(line, now_us).c_str());
    drawn_ = lines_.size();
    next_us_ = now_us + kRedrawUs;
}

void PullScreen::tell(Line& line)
{
    const std::int64_t now_us = monotonic_us();
    if (terminal_) {
        if (now_us >= next_us_)
            draw(now_us);
    } else if (now_us - line.said_us >= kSentenceUs) {
        line.said_us = now_us;
        std::fprintf(stderr, "%s\n", words_of(line, now_us).c_str());
    }
}

int PullScreen::begin(const std::string& board, std::int64_t snapshots, std::int64_t fresh, std::uint64_t bytes)
{
    const std::scoped_lock lock(mutex_);
    Line line;
    line.board = shown(board);
    line.all = snapshots;
    line.bytes_all = bytes;
    line.start_us = line.said_us = monotonic_us();
    lines_.push_back(line);
    if (terminal_)
        draw(line.start_us);
    else
        std::fprintf(stderr, "%s: %lld of %s new%s%s\n", line.board.c_str(), static_cast<long long>(fresh),
                     counted(snapshots, "snapshot").c_str(), bytes > 0 ? ", " : "",
                     bytes > 0 ? shown_bytes(static_cast<double>(bytes)).c_str() : "");
    return static_cast<int>(lines_.size()) - 1;
}

void PullScreen::arrived(int line, std::uint64_t bytes)
{
    const std::scoped_lock lock(mutex_);
    Line& one = lines_[static_cast<std::size_t>(line)];
    one.bytes_done += bytes;
    tell(one);
}

void PullScreen::one_done(int line)
{
    const std::scoped_lock lock(mutex_);
    Line& one = lines_[static_cast<std::size_t>(line)];
    ++one.done;
    tell(one);
}

void PullScreen::end(int line)
{
    const std::scoped_lock lock(mutex_);
    lines_[static_cast<std::size_t>(line)].ended = true;
    draw(monotonic_us());
}

void PullScreen::say(const std::string& sentence)
{
    const std::scoped_lock lock(mutex_);
    wipe();
    std::fprintf(stderr, "%s\n", sentence.c_str());
    draw(monotonic_us());
}

} // namespace dicot::app
