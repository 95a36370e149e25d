// What stands on a simulated card, each change that was made to it, and what power loss may leave of the changes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace dicot::test {

using CardBytes = std::vector<std::byte>;

struct CardNode
{
    bool folder = false;
    std::map<std::string, int, std::less<>> entries; ///< of a folder: name -> node
    CardBytes bytes;                                 ///< of a file
};

/// One change, or one sync. Nodes are numbered as they are made, so a change means the same in every state.
struct Change
{
    enum class Kind
    {
        kMake, ///< `node`, empty, as `name` in `folder`
        kUnlink,
        kRename, ///< `name` in `folder` -> `to_name` in `to_folder`
        kWrite,
        kTruncate,
        kSyncAll,
        kSyncNames,  ///< all names, no data: as a forgetful card syncs
        kSyncFile,   ///< data and size of `node`
        kSyncFolder, ///< the names in `folder`
        kNothing,    ///< a sync that a forgetful card let go
    };
    Kind kind{};
    int node = -1;
    bool makes_folder = false;
    int folder = -1, to_folder = -1;
    std::string name, to_name;
    std::uint64_t offset = 0; ///< of a write; of a truncation the new size
    CardBytes bytes;
};

struct CardState
{
    static constexpr int kRoot = 0;

    std::vector<CardNode> nodes{CardNode{true, {}, {}}};

    CardNode& node(int number); ///< grows with the numbers
    void apply(const Change& change);
    /// -1: there is none. `path` as a Medium has it.
    int find(std::string_view path) const;
    /// As a file system would count it: whole blocks of 4096 bytes, one for a folder.
    std::uint64_t used_bytes() const;
    /// Of all names and bytes that can be reached.
    std::uint64_t fingerprint() const;
};

/// How the power goes. Written as "subset:37:5": mode, changes done before it, seed.
struct Cut
{
    enum class Mode
    {
        kInOrder, ///< all that was done until then, nothing after it
        kSubset,  ///< of what was not synced, and of the change on its way, any part
        kTorn,    ///< the same, and writes end within, with a sector of zeros or of anything
    };
    Mode mode = Mode::kInOrder;
    std::size_t at = 0;
    unsigned seed = 0;

    std::string text() const;
};

/// The card as it is found after `cut`. Changes of the same name keep their order, whole renames are atomic, a name can
/// last without its data, a size too; a torn write damages nothing outside its own bytes.
CardState surviving(const CardState& before, const std::vector<Change>& log, const Cut& cut);

/// The same numbers on every machine.
class Dice
{
public:
    explicit Dice(std::uint64_t seed) noexcept : state_(seed) {}
    std::uint64_t next() noexcept; ///< SplitMix64
    std::size_t below(std::size_t limit) noexcept { return static_cast<std::size_t>(next() % limit); }
    bool one_in(std::size_t n) noexcept { return below(n) == 0; }

private:
    std::uint64_t state_;
};

} // namespace dicot::test
