#include "card_state.h"

#include <algorithm>
#include <cstring>

namespace dicot::test {

CardNode& CardState::node(int number)
{
    const auto k = static_cast<std::size_t>(number);
    if (k >= nodes.size())
        nodes.resize(k + 1);
    return nodes[k];
}

void CardState::apply(const Change& change)
{
    using Kind = Change::Kind;
    switch (change.kind) {
    case Kind::kMake:
        node(change.node).folder = change.makes_folder;
        node(change.folder).entries.insert_or_assign(change.name, change.node);
        break;
    case Kind::kUnlink:
        node(change.folder).entries.erase(change.name);
        break;
    case Kind::kRename:
        node(change.folder).entries.erase(change.name);
        node(change.to_folder).entries.insert_or_assign(change.to_name, change.node);
        break;
    case Kind::kWrite: {
        CardBytes& bytes = node(change.node).bytes;
        const auto at = static_cast<std::size_t>(change.offset);
        bytes.resize(std::max(bytes.size(), at + change.bytes.size()));
        std::copy(change.bytes.begin(), change.bytes.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
        break;
    }
    case Kind::kTruncate:
        node(change.node).bytes.resize(static_cast<std::size_t>(change.offset));
        break;
    case Kind::kSyncAll:
    case Kind::kSyncNames:
    case Kind::kSyncFile:
    case Kind::kSyncFolder:
    case Kind::kNothing:
        break;
    }
}

int CardState::find(std::string_view path) const
{
    int at = kRoot;
    while (!path.empty()) {
        const std::string_view name = path.substr(0, path.find('/'));
        const auto& entries = nodes[static_cast<std::size_t>(at)].entries;
        const auto entry = entries.find(name);
        if (entry == entries.end())
            return -1;
        at = entry->second;
        path.remove_prefix(std::min(path.size(), name.size() + 1));
    }
    return at;
}

std::uint64_t CardState::used_bytes() const
{
    constexpr std::uint64_t kBlock = 4096;
    std::uint64_t blocks = 0;
    std::vector<int> to_see{kRoot};
    while (!to_see.empty()) {
        const CardNode& node = nodes[static_cast<std::size_t>(to_see.back())];
        to_see.pop_back();
        blocks += node.folder ? 1 : (node.bytes.size() + kBlock - 1) / kBlock;
        for (const auto& [name, number] : node.entries)
            to_see.push_back(number);
    }
    return blocks * kBlock;
}

std::uint64_t CardState::fingerprint() const
{
    std::uint64_t hash = 0;
    const auto mix = [&](std::uint64_t word) { hash = Dice{hash ^ word}.next(); };
    const auto mix_bytes = [&](const void* bytes, std::size_t count) {
        mix(count);
        for (std::size_t at = 0; at < count; at += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, static_cast<const char*>(bytes) + at, std::min(sizeof word, count - at));
            mix(word);
        }
    };
    std::vector<int> to_see{kRoot};
    while (!to_see.empty()) {
        const CardNode& node = nodes[static_cast<std::size_t>(to_see.back())];
        to_see.pop_back();
        mix(node.folder ? 1 : 2);
        mix_bytes(node.bytes.data(), node.bytes.size());
        for (const auto& [name, number] : node.entries) {
            mix_bytes(name.data(), name.size());
            to_see.push_back(number);
        }
    }
    return hash;
}

std::uint64_t Dice::next() noexcept
{
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

} // namespace dicot::test
