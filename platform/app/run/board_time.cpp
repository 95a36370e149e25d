#include "board_time.h"

#include "journal.h"

#include "dicot/power/power_rules.h"

namespace dicot::app {

BoardTime::BoardTime(const Config& config) : board_(config.power.rtc.c_str()), rest_(board_, lead_, rest_rules(config))
{
    lead_.open(config.run.state.c_str());
}

void BoardTime::pair_was_ready_after(std::int64_t us)
{
    if (const Status noted = lead_.note(LeadPart::kCameras, us); !noted.ok())
        journal(Priority::kNotice, "%s", noted.message());
}

} // namespace dicot::app
