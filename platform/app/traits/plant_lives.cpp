#include "plant_lives.h"

#include "dicot/os/memory_block.h"
#include "dicot/plant/tracking.h"

#include <algorithm>

namespace dicot::app {
namespace {

/// What is known of one plant beside its life.
struct Memory
{
    PlantStand stand;
    std::vector<LeafMark> marks; ///< of each leaf of its life, where it was last
    std::vector<int> last_visit; ///< of each leaf: the plant's snapshot that it was last seen in
};

class Following
{
public:
    Following(const BoardTraits& board, std::span<const PlantPlace> places) : board_(board), places_(places) {}

    Result<std::vector<PlantLife>> run()
    {
        for (const PlantPlace& place : places_)
            (void)new_life(place.name);
        for (std::size_t slot = 0; slot < board_.slots.size(); ++slot)
            if (board_.slots[slot].traits)
                TRY(visit(slot, *board_.slots[slot].traits));
        return std::move(lives_);
    }

private:
    std::size_t new_life(const std::string& name)
    {
        const int id = static_cast<int>(lives_.size()) + 1;
        lives_.push_back(
            {.id = id, .name = name.empty() ? "plant " + std::to_string(id) : name, .seen = {}, .leaves = {}});
        memories_.emplace_back();
        return lives_.size() - 1;
    }

    Status visit(std::size_t slot, const SnapshotTraits& traits)
    {
        std::vector<std::int32_t> who(traits.plants.size(), kNobody);
        if (places_.empty()) {
            TRY(recognise(traits, who));
        } else {
            for (std::size_t i = 0; i < who.size(); ++i)
                who[i] = traits.plants[i].traits.plant - 1;
        }
        for (std::size_t i = 0; i < who.size(); ++i) {
            const PlantSeen& seen = traits.plants[i];
            if (seen.traits.points == 0) // a place where nothing grows yet
                continue;
            const std::size_t life = who[i] == kNobody ? new_life("") : static_cast<std::size_t>(who[i]);
            if (life >= lives_.size())
                continue;
            lives_[life].seen.push_back({slot, i});
            memories_[life].stand = seen.stand;
            TRY(visit_leaves(life, slot, traits, seen.traits.plant));
        }
        return {};
    }

    Status recognise(const SnapshotTraits& traits, std::vector<std::int32_t>& who)
    {
        std::vector<PlantStand> known, stands;
        for (const Memory& memory : memories_)
            known.push_back(memory.stand);
        for (const PlantSeen& seen : traits.plants)
            stands.push_back(seen.stand);
        Arena arena = TRY(arena_for(known.size(), stands.size()));
        return match_plants(known, stands, who, arena);
    }

    Status visit_leaves(std::size_t at, std::size_t slot, const SnapshotTraits& traits, int plant)
    {
        PlantLife& life = lives_[at];
        Memory& memory = memories_[at];
        const int now = static_cast<int>(life.seen.size());
        std::vector<std::size_t> candidates, leaves;
        std::vector<LeafMark> known, marks;
        for (std::size_t k = 0; k < life.leaves.size(); ++k)
            if (now - memory.last_visit[k] <= kLeafRemembered) {
                candidates.push_back(k);
                known.push_back(memory.marks[k]);
            }
        for (std::size_t i = 0; i < traits.leaves.size(); ++i)
            if (traits.leaves[i].plant == plant) {
                leaves.push_back(i);
                marks.push_back(mark_of(traits.leaves[i]));
            }
        std::vector<std::int32_t> who(leaves.size(), kNobody);
        Arena arena = TRY(arena_for(known.size(), marks.size()));
        TRY(match_leaves(known, marks, who, arena));
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            if (who[i] == kNobody) {
                life.leaves.push_back({.id = static_cast<int>(life.leaves.size()) + 1, .seen = {}});
                memory.marks.emplace_back();
                memory.last_visit.emplace_back();
            }
            const std::size_t leaf =
                who[i] == kNobody ? life.leaves.size() - 1 : candidates[static_cast<std::size_t>(who[i])];
            life.leaves[leaf].seen.push_back({slot, leaves[i]});
            memory.marks[leaf] = marks[i];
            memory.last_visit[leaf] = now;
        }
        return {};
    }

    Result<Arena> arena_for(std::size_t known, std::size_t seen)
    {
        const std::size_t bytes = match_bytes(known, seen);
        if (block_.bytes().size() < bytes)
            block_ = TRY(MemoryBlock::map(2 * bytes));
        return Arena{block_.bytes()};
    }

    const BoardTraits& board_;
    std::span<const PlantPlace> places_;
    std::vector<PlantLife> lives_;
    std::vector<Memory> memories_;
    MemoryBlock block_;
};

} // namespace

Result<std::vector<PlantLife>> follow_lives(const BoardTraits& board, std::span<const PlantPlace> places)
{
    return Following(board, places).run();
}

} // namespace dicot::app
