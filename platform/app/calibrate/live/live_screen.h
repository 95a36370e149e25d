// Where a live calibration is told: a block that is drawn anew in place on a terminal, lines elsewhere.
#pragma once

#include "live_words.h"

#include <cstdint>
#include <string>

namespace dicot::app {

/// Text goes to stderr, which leaves stdout to the report; JSON goes to stdout, a line an event.
class LiveScreen
{
public:
    explicit LiveScreen(bool json) noexcept;
    LiveScreen(const LiveScreen&) = delete;
    LiveScreen& operator=(const LiveScreen&) = delete;

    /// A sentence of its own.
    void say(const std::string& sentence);
    /// May show less than it is told: a terminal ten times a second; lines when something else is seen, at most one a
    /// second, and every ten seconds.
    void look(const LiveMoment& now);
    /// A pair was taken, and its left picture is called that.
    void taken(const LiveMoment& now, const std::string& picture);

private:
    void draw(const LiveMoment& now);
    void line(const LiveMoment& now, const char* event, const std::string& picture);

    bool json_;
    bool terminal_;
    bool colours_;
    int drawn_ = 0; ///< lines of the block that stands on the terminal
    std::int64_t last_us_ = 0;
    LiveSight last_sight_ = LiveSight::kTake;
    bool begun_ = false;
};

} // namespace dicot::app
