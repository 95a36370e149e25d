// The growth of a board, measured beside what a person looks at.
#pragma once

#include "../traits/board_traits.h"

#include <nlohmann/json.hpp>

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

namespace dicot::app {

/// Its thread measures the newest slots first, then four times as many, and so on; what is measured stays in the cache
/// of `dicot traits`.
class GrowthJob
{
public:
    GrowthJob(DeviceFolder board, const TraitsWishes& wishes);
    GrowthJob(const GrowthJob&) = delete;
    GrowthJob& operator=(const GrowthJob&) = delete;
    ~GrowthJob(); ///< waits until as many slots are measured as were begun with, or a StopRequest is asked

    const DeviceFolder& board() const { return board_; }
    /// What is known by now (README.md, "What the page reads"); the first question begins the work.
    nlohmann::json curves();
    /// The same of all slots, or as far as it came when somebody wanted an end.
    nlohmann::json all_curves();
    /// There may be more slots than there were.
    void look_again();

private:
    void begin();
    void work();
    /// Whether there are more slots.
    bool measure(std::int64_t slots);

    DeviceFolder board_;
    TraitsWishes wishes_;
    std::int64_t slots_ = 16; ///< the newest that are measured first; of the thread
    std::mutex guard_;        ///< what stands below
    std::condition_variable told_;
    nlohmann::json curves_;
    bool working_ = false;
    bool more_wanted_ = true;
    bool ending_ = false;
    std::thread thread_;
};

} // namespace dicot::app
