// A cloud's plants, leaves and traits.
#pragma once

#include "dicot/os/memory_block.h"
#include "dicot/plant/leaves.h"
#include "dicot/plant/plant_box.h"
#include "dicot/plant/plant_view.h"
#include "dicot/plant/traits.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace dicot::app {

/// Where a plant of a name stands.
struct PlantPlace
{
    std::string name;
    PlantBox box;
};

struct PlantTimes
{
    double view_s = 0, leaves_s = 0, traits_s = 0;
};

/// "soil", "bench" or "none".
const char* name_of(GroundFrame::Kind kind);

/// Everything about one cloud. The cloud is borrowed. Memory is two blocks: one for the grid, which then tells how
/// large the other must be; pages that are not written take no room.
class PlantWork
{
public:
    /// With `places`, plant i + 1 is what stands in places[i], and what stands in none is no plant; without, plants
    /// are told apart by the gaps between them. `name` is the cloud's, for sentences. Errors: plant_view()'s;
    /// Fault::kOsError without memory. A cloud without anything green, or of too few points, is no error: it has no
    /// plants, or their places are empty. `far_mm`: how far
    /// the cloud's working range reaches; 0 where that is not known.
    static Result<PlantWork> make(const PointCloud& cloud, const char* name, std::span<const PlantPlace> places = {},
                                  double far_mm = 0);

    const PlantView& view() const { return view_; }
    const Leaves& leaves() const { return leaves_; }
    const Traits& traits() const { return traits_; }
    const PlantTimes& times() const { return times_; }
    /// "plant 1", or the name of its place; `plant` is 1 .. plant_count.
    std::string plant_name(int plant) const;
    /// What was taken at most at one time.
    std::size_t memory_bytes() const { return memory_bytes_; }

private:
    MemoryBlock grid_;
    MemoryBlock block_;
    std::size_t memory_bytes_ = 0;
    PlantView view_;
    Leaves leaves_;
    Traits traits_;
    PlantTimes times_;
    std::vector<std::string> names_;
};

} // namespace dicot::app
