#include "shelf_objects.h"

#include <algorithm>
#include <cstdio>

namespace dicot::app {

ShortText<255> hidden_words(const SnapshotShelf::Hidden& hidden)
{
    struct Part
    {
        std::size_t count;
        const char* words;
    };
    const Part parts[] = {
        {hidden.damaged, "damaged (dicot verify names them)"},
        {hidden.beyond_limits, "older than what fits (pull, then prune)"},
        {hidden.doubled, "with a number that another one has too (dicot verify names them)"},
        {hidden.beyond_numbers, "with a number or a day that is out of bounds"},
        {hidden.unread_days, "days that cannot be read"},
    };
    char text[256] = {};
    std::size_t used = 0;
    for (const Part& part : parts) {
        if (part.count == 0)
            continue;
        const int length = std::snprintf(text + used, sizeof text - used, "%s%zu %s",
                                         used == 0 ? "not shown to computers: " : ", ", part.count, part.words);
        used = std::min(sizeof text - 1, used + static_cast<std::size_t>(std::max(length, 0)));
    }
    return text;
}

} // namespace dicot::app
