// What a series says while nobody looks: one line an event, with journald's priorities.
#pragma once

namespace dicot::app {

/// Of syslog(3), as sd-daemon(3) writes them in front of a line.
enum class Priority
{
    kError = 3,
    kWarning = 4,
    kNotice = 5,
    kInfo = 6
};

/// To standard error, in one write, and without the heap. Under systemd (JOURNAL_STREAM is set) each line begins with
/// its priority, as "<6>"; elsewhere with the time. Longer lines are cut.
[[gnu::format(printf, 2, 3)]] void journal(Priority priority, const char* format, ...) noexcept;

} // namespace dicot::app
