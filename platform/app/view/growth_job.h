// The growth of a board, measured beside what a person looks at.
#pragma once

#include "../store/store_words.h"

#include <nlohmann/json.hpp>

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>

namespace dicot::app {

/// Its thread measures the newest slots first, then four times as many, and so on; what is measured stays in the cache
/// of `dicot traits`.
class GrowthJob
{
public:
    /// `last`: only so many slots, the newest.
    GrowthJob(DeviceFolder board, std::optional<std::int64_t> last);
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
    std::optional<std::int64_t> last_;
    std::mutex guard_; ///< what stands below
    std::condition_variable told_;
    nlohmann::json curves_;
    bool working_ = false;
    bool complete_ = false;
    bool ending_ = false;
    std::thread thread_;
};

} // namespace dicot::app
