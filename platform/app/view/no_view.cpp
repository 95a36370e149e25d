// dicot view in a program that has no viewer.
#include "../commands.h"
#include "view_words.h"

namespace dicot::app {

void add_view(CLI::App& program, Command& chosen)
{
    add_view_words(program, chosen, [](const ViewWords&) {
        return failure(Fault::kUnavailable, "this dicot was built without the viewer: use the one of a computer "
                                            "(built with DICOT_VIEWER), on an archive that dicot pull made");
    });
}

} // namespace dicot::app
