#include "start_words.h"

#include "shown.h"

#include <cstdio>

namespace dicot::app {

void tell_start(Store& store, const std::string& path)
{
    const auto line = [&path](int count, const char* what) {
        if (count > 0)
            std::fprintf(stderr, "dicot: %s: %s %s\n", shown(path).c_str(), counted(count, "snapshot").c_str(), what);
    };
    const StartReport& report = store.start_report();
    line(report.finished, "whole when it was interrupted: now in place");
    line(report.interrupted, "interrupted: recorded as missed");
    line(report.left_over, "interrupted, and not to be ended: dicot verify");
    line(report.rows_added, "that the catalogue did not know: added");
    if (!report.catalogue_new)
        return;
    const Result<std::int64_t> last = store.catalogue().last_sequence();
    if (!last.ok() || last.value() > 0) // a store that was never used has none to lose
        std::fprintf(stderr, "dicot: %s: the catalogue was damaged or missing, and was made again of the folders\n",
                     shown(path).c_str());
}

} // namespace dicot::app
