#include "aim_screen.h"

#include "aim_text.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sys/ioctl.h>
#include <unistd.h>

namespace dicot::app {
namespace {

struct Size
{
    int columns = 80, rows = 24;
};

Size terminal_size()
{
    winsize size{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0)
        return {};
    return {size.ws_col, size.ws_row};
}

bool takes_escapes()
{
    const char* kind = std::getenv("TERM");
    return ::isatty(STDOUT_FILENO) == 1 && kind != nullptr && std::strcmp(kind, "dumb") != 0;
}

bool colours_wanted()
{
    const char* no = std::getenv("NO_COLOR");
    return no == nullptr || *no == '\0';
}

Status write_out(const std::string& text)
{
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
        return failure(Fault::kIoError,
                       "the figures cannot be written to stdout: is the disk full, or the pipe closed?");
    return {};
}

/// The first lines of a block, as many as the terminal can take back.
std::string first_lines(const std::string& block, int most)
{
    std::size_t end = 0;
    for (int line = 0; line < most && end < block.size(); ++line)
        end = block.find('\n', end) + 1;
    return block.substr(0, end);
}

} // namespace

AimScreen::AimScreen(bool json) noexcept
    : json_(json), in_place_(!json && takes_escapes()), colours_(in_place_ && colours_wanted())
{
}

Status AimScreen::draw(const AimMoment& now)
{
    const Size size = terminal_size();
    const std::string block = first_lines(aim_block(now, size.columns, colours_), std::max(size.rows - 1, 1));
    std::string text = "\r"; // the terminal itself may have written ^C
    if (drawn_ > 0)
        text += text_of("\033[%dA", drawn_);
    for (const char letter : block) {
        if (letter == '\n')
            text += "\033[K"; // wipes what was longer before, without the flicker of an empty screen
        text += letter;
    }
    drawn_ = static_cast<int>(std::ranges::count(block, '\n'));
    return write_out(text + "\033[J");
}

Status AimScreen::show(const AimMoment& now)
{
    if (in_place_)
        return draw(now);
    return write_out((json_ ? aim_json(now) : aim_line(now)) + "\n");
}

Status AimScreen::end(const AimMoment& last)
{
    if (json_)
        return write_out(aim_summary_json(last) + "\n");
    return write_out((in_place_ ? "\r\033[J" : "") + aim_summary(last, !in_place_));
}

} // namespace dicot::app
