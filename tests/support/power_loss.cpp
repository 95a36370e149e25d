// The rules by which changes survive: see surviving() in card_state.h.
#include "card_state.h"

#include <algorithm>
#include <set>
#include <utility>

namespace dicot::test {
namespace {

using Kind = Change::Kind;

constexpr std::size_t kSectorBytes = 512;

bool is_data(const Change& change)
{
    return change.kind == Kind::kWrite || change.kind == Kind::kTruncate;
}

bool is_name(const Change& change)
{
    return change.kind == Kind::kMake || change.kind == Kind::kUnlink || change.kind == Kind::kRename;
}

/// For each of the first `count` changes whether a sync that came back covers it.
std::vector<bool> synced_of(const std::vector<Change>& log, std::size_t count)
{
    std::vector<bool> synced(count, false);
    std::set<int> files, folders;
    bool all_names = false;
    for (std::size_t k = count; k-- > 0;) {
        const Change& change = log[k];
        if (change.kind == Kind::kSyncAll) {
            std::fill_n(synced.begin(), k + 1, true);
            break;
        }
        if (change.kind == Kind::kSyncFile)
            files.insert(change.node);
        else if (change.kind == Kind::kSyncFolder)
            folders.insert(change.folder);
        else if (change.kind == Kind::kSyncNames)
            all_names = true;
        else if (is_data(change))
            synced[k] = files.count(change.node) != 0;
        else
            synced[k] = all_names || folders.count(change.folder) != 0 || folders.count(change.to_folder) != 0;
    }
    return synced;
}

/// What a seed leaves of that which was not synced. The first ones are what cards do most.
class Fate
{
public:
    explicit Fate(unsigned seed) : seed_(seed), dice_(seed) {}
    bool keeps(const Change& change)
    {
        switch (seed_) {
        case 0:
            return false;
        case 1:
            return is_name(change);
        case 2:
            return is_data(change);
        default: // rarely, often, mostly
            return dice_.below(8) < 1 + 3 * (seed_ % 3);
        }
    }
    bool keeps_size() { return seed_ == 1 ? dice_.one_in(2) : dice_.one_in(4); }
    Dice& dice() { return dice_; }

private:
    unsigned seed_;
    Dice dice_;
};

/// A name that lasts needs what happened before to the same name.
void keep_order_of_names(const std::vector<Change>& log, std::vector<bool>& kept)
{
    std::set<std::pair<int, std::string>> later;
    for (std::size_t k = kept.size(); k-- > 0;) {
        const Change& change = log[k];
        if (!is_name(change))
            continue;
        const std::pair from{change.folder, change.name};
        const std::pair to{change.to_folder, change.to_name};
        const bool renames = change.kind == Kind::kRename;
        if (later.count(from) != 0 || (renames && later.count(to) != 0))
            kept[k] = true;
        if (!kept[k])
            continue;
        later.insert(from);
        if (renames)
            later.insert(to);
    }
}

void apply_size_alone(CardState& state, const Change& write)
{
    CardBytes& bytes = state.node(write.node).bytes;
    bytes.resize(std::max(bytes.size(), static_cast<std::size_t>(write.offset) + write.bytes.size()));
}

/// Whole sectors, then one of zeros, of anything, or not written.
void apply_torn(CardState& state, Change write, Dice& dice)
{
    const auto begin = static_cast<std::size_t>(write.offset);
    const std::size_t end = begin + write.bytes.size();
    const std::size_t first = begin / kSectorBytes;
    const std::size_t sectors = (end + kSectorBytes - 1) / kSectorBytes - first;
    const std::size_t torn = (first + dice.below(sectors + 1)) * kSectorBytes;
    const std::size_t from = std::clamp(torn, begin, end);
    const std::size_t until = std::clamp(torn + kSectorBytes, begin, end);
    const std::size_t how = dice.below(3);
    for (std::size_t k = from; k < until; ++k)
        write.bytes[k - begin] = how == 0 ? std::byte{0} : static_cast<std::byte>(dice.next());
    if (dice.one_in(3))
        apply_size_alone(state, write);
    write.bytes.resize((how == 2 ? from : until) - begin);
    state.apply(write);
}

} // namespace

std::string Cut::text() const
{
    const char* names[] = {"order", "subset", "torn"};
    return std::string{names[static_cast<int>(mode)]} + ":" + std::to_string(at) + ":" + std::to_string(seed);
}

CardState surviving(const CardState& before, const std::vector<Change>& log, const Cut& cut)
{
    CardState state = before;
    const std::size_t done = std::min(cut.at, log.size());
    if (cut.mode == Cut::Mode::kInOrder) {
        for (std::size_t k = 0; k < done; ++k)
            state.apply(log[k]);
        return state;
    }
    const bool tears = cut.mode == Cut::Mode::kTorn;
    const bool all_else = tears && cut.seed % 2 == 1; // the write on its way alone is torn
    Fate fate{cut.seed};
    const std::vector<bool> synced = synced_of(log, done);
    std::vector<bool> kept(std::min(done + 1, log.size()), false); // the last one was on its way
    for (std::size_t k = 0; k < kept.size(); ++k)
        kept[k] = k < done ? synced[k] || all_else || fate.keeps(log[k]) : fate.keeps(log[k]);
    keep_order_of_names(log, kept);
    for (std::size_t k = 0; k < kept.size(); ++k) {
        const bool is_write = log[k].kind == Kind::kWrite;
        const bool in_flight = k == done;
        if (tears && is_write && !(k < done && (synced[k] || all_else)) && (in_flight || fate.dice().one_in(2)))
            apply_torn(state, log[k], fate.dice());
        else if (kept[k])
            state.apply(log[k]);
        else if (is_write && fate.keeps_size())
            apply_size_alone(state, log[k]);
    }
    return state;
}

} // namespace dicot::test
