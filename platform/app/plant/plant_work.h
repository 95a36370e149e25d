// A cloud's plants, leaves and traits, in one block of memory.
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

/// Everything about one cloud; the spans point into the block that it owns. The cloud is borrowed.
class PlantWork
{
public:
    /// With `places`, plant i + 1 is what stands in places[i], and what stands in none is no plant; without, plants
    /// are told apart by the gaps between them. `name` is the cloud's, for sentences. Errors: plant_view()'s;
    /// Fault::kOsError without memory. A cloud without anything green is none: it has no plants.
    static Result<PlantWork> make(const PointCloud& cloud, const char* name, std::span<const PlantPlace> places = {});

    const PlantView& view() const { return view_; }
    const Leaves& leaves() const { return leaves_; }
    const Traits& traits() const { return traits_; }
    const PlantTimes& times() const { return times_; }
    /// "plant 1", or the name of its place; `plant` is 1 .. plant_count.
    std::string plant_name(int plant) const;
    std::size_t memory_bytes() const { return block_.bytes().size(); }

private:
    MemoryBlock block_;
    PlantView view_;
    Leaves leaves_;
    Traits traits_;
    PlantTimes times_;
    std::vector<std::string> names_;
};

} // namespace dicot::app
