#include "journal.h"

#include "dicot/base/utc_time.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <unistd.h>

namespace dicot::app {

void journal(Priority priority, const char* format, ...) noexcept
{
    char line[768];
    int length = 0;
    if (std::getenv("JOURNAL_STREAM") != nullptr) {
        length = std::snprintf(line, sizeof line, "<%d>", static_cast<int>(priority));
    } else {
        timespec now{};
        clock_gettime(CLOCK_REALTIME, &now);
        length = std::snprintf(line, sizeof line, "%s ", utc_text(std::int64_t{now.tv_sec} * 1'000'000).c_str());
    }
    va_list words;
    va_start(words, format);
    const int more = std::vsnprintf(line + length, sizeof line - static_cast<std::size_t>(length), format, words);
    va_end(words);
    length = std::min(length + std::max(more, 0), static_cast<int>(sizeof line) - 2);
    std::replace(line, line + length, '\n', ' ');
    line[length++] = '\n';
    (void)!::write(STDERR_FILENO, line, static_cast<std::size_t>(length));
}

} // namespace dicot::app
