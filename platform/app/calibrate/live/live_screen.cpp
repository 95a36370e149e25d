#include "live_screen.h"

#include "dicot/os/clock.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sys/ioctl.h>
#include <unistd.h>

namespace dicot::app {
namespace {

constexpr std::int64_t kRedrawUs = 100'000;
constexpr std::int64_t kLineUs = 1'000'000;
constexpr std::int64_t kRepeatUs = 10'000'000;
constexpr int kUsualColumns = 80;

bool set_and_not_empty(const char* name)
{
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
}

bool draws_in_place()
{
    const char* kind = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) == 1 && kind != nullptr && std::strcmp(kind, "dumb") != 0;
}

int columns()
{
    winsize size{};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualColumns;
}

} // namespace

LiveScreen::LiveScreen(bool json) noexcept
    : json_(json), terminal_(!json && draws_in_place()), colours_(terminal_ && !set_and_not_empty("NO_COLOR"))
{
}

void LiveScreen::say(const std::string& sentence)
{
    std::fprintf(stderr, "%s\n", sentence.c_str());
    drawn_ = 0; // the block before it stays where it is
}

void LiveScreen::draw(const LiveMoment& now)
{
    const std::string block = live_block(now, columns(), colours_);
    if (drawn_ > 0)
        std::fprintf(stderr, "\033[%dA", drawn_);
    std::fprintf(stderr, "\033[J%s", block.c_str());
    std::fflush(stderr);
    drawn_ = static_cast<int>(std::ranges::count(block, '\n'));
}

void LiveScreen::line(const LiveMoment& now, const char* event, const std::string& picture)
{
    if (json_) {
        std::printf("%s\n", live_json(now, event, picture).c_str());
        std::fflush(stdout);
    } else {
        std::fprintf(stderr, "%s%s%s\n", live_line(now).c_str(), picture.empty() ? "" : ": ", picture.c_str());
    }
}

void LiveScreen::look(const LiveMoment& now)
{
    const std::int64_t passed_us = monotonic_us() - last_us_;
    const bool due = terminal_ ? passed_us >= kRedrawUs
                               : (now.sight != last_sight_ && passed_us >= kLineUs) || passed_us >= kRepeatUs;
    if (begun_ && !due)
        return;
    begun_ = true;
    last_us_ = monotonic_us();
    last_sight_ = now.sight;
    if (terminal_)
        draw(now);
    else
        line(now, "look", "");
}

void LiveScreen::taken(const LiveMoment& now, const std::string& picture)
{
    begun_ = true;
    last_us_ = monotonic_us();
    last_sight_ = now.sight;
    if (terminal_)
        draw(now);
    else
        line(now, "pair", picture);
}

} // namespace dicot::app
