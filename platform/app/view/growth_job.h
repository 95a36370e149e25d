// The traits of a whole board, measured beside what a person looks at, and the curves through them.
#pragma once

#include "view_board.h"

#include "dicot/plant/traits.h"

#include <nlohmann/json_fwd.hpp>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace dicot::app {

/// A board's snapshots are measured one after the other, first some of the whole time, then those between them.
class GrowthJob
{
public:
    explicit GrowthJob(std::shared_ptr<const ViewBoard> board);
    GrowthJob(const GrowthJob&) = delete;
    GrowthJob& operator=(const GrowthJob&) = delete;
    ~GrowthJob(); ///< leaves the rest undone

    /// What is known by now (README.md, "What the page reads"); the first question begins the work.
    nlohmann::json curves();
    /// All of it, or as far as it came when somebody wanted an end.
    void finish();

private:
    struct MeasuredSlot
    {
        const SlotRow* row = nullptr;
        std::vector<PlantTraits> plants;
        std::vector<std::string> names;
    };

    void work();
    void begin();

    std::shared_ptr<const ViewBoard> board_;
    std::vector<const SlotRow*> order_;
    std::atomic<bool> ended_{false};
    std::mutex guard_; ///< what stands below
    std::vector<MeasuredSlot> measured_;
    std::size_t tried_ = 0;
    bool begun_ = false;
    std::thread thread_;
};

} // namespace dicot::app
