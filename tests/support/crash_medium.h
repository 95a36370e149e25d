// A card in memory that remembers every change, so that power can be cut after each of them; and that can fail.
#pragma once

#include "card_state.h"

#include "dicot/medium/medium.h"

#include <array>
#include <string>
#include <vector>

namespace dicot::test {

/// The Nth operation fails, once or from then on. Which ones count is a matter of the error: EIO strikes all, EROFS
/// what changes names or data, ENOSPC what needs room.
struct CardFault
{
    int error = 0;
    int at = 0; ///< from 0
    bool lasts = false;
};

class CrashMedium final : public Medium
{
public:
    static constexpr std::uint64_t kCapacityBytes = std::uint64_t{64} << 20;

    CrashMedium() = default;
    explicit CrashMedium(CardState state) : start_(state), now_(std::move(state)) {}

    const CardState& start() const { return start_; }
    const std::vector<Change>& log() const { return log_; }
    const CardState& now() const { return now_; }

    void set_fault(const CardFault& fault) { fault_ = fault, counted_ = 0, struck_ = 0; }
    int struck() const { return struck_; }   ///< how many operations failed by the fault
    int counted() const { return counted_; } ///< how many it could have struck
    bool is_read_only() const { return fault_.error == EROFS && fault_.lasts && counted_ > fault_.at; }
    void set_capacity(std::uint64_t bytes) { capacity_ = bytes; }

    Errno make_folder(const char* path) override { return make(path, true).error; }
    Errno rename(const char* from, const char* to) override;
    Errno remove_file(const char* path) override { return remove(path, false); }
    Errno remove_folder(const char* path) override { return remove(path, true); }
    Errno kind_of(const char* path, EntryKind& kind) override;
    Errno list(const char* path, FunctionRef<bool(const MediumEntry&)> visit) override;
    Errno stamp(const char* path, FolderStamp& stamp) override;
    Errno create(const char* path, File& file) override;
    Errno append(const char* path, File& file, std::uint64_t& size_bytes) override
    {
        return open(path, file, size_bytes); // whoever writes, writes behind what is there
    }
    Errno write(File file, std::span<const std::byte> bytes) override;
    Errno open(const char* path, File& file, std::uint64_t& size_bytes) override;
    Errno read(File file, std::span<std::byte> into, std::size_t& got) override;
    Errno read_at(File file, std::uint64_t offset, std::span<std::byte> into, std::size_t& got) override;
    Errno close(File file) override;
    Errno sync_all() override;
    Errno sync_folder(const char* path) override;
    Errno space(MediumSpace& space) override;
    Errno lock() override { return {}; } ///< one process
    void unlock() override {}

    /// The other way in, for a library that writes anywhere in its files. Nodes are those of CardState.
    struct Made
    {
        Errno error;
        int node = -1;
    };
    Made make(const char* path, bool folder);
    int find_file(const char* path) const; ///< -1: none
    Errno write_at(int node, std::uint64_t offset, std::span<const std::byte> bytes);
    Errno read_node(int node, std::uint64_t offset, std::span<std::byte> into, std::size_t& got);
    Errno truncate(int node, std::uint64_t size);
    Errno sync_file(int node);
    std::uint64_t size_of(int node) const { return now_.nodes[static_cast<std::size_t>(node)].bytes.size(); }

private:
    enum class Touch
    {
        kRead,
        kGrow, ///< needs room
        kChange,
        kSync,
    };
    struct Place
    {
        Errno error;
        int folder = -1;
        int node = -1; ///< -1: no such name
        std::string name;
    };
    struct OpenFile
    {
        int node = -1;
        std::uint64_t at = 0;
    };
    static constexpr std::size_t kMostOpen = 8;

    Errno strike(Touch touch);
    void note(Change change);
    Place place_of(std::string_view path) const;
    Errno remove(const char* path, bool folder);
    Errno keep(int node, File& file);
    OpenFile* opened(File file);
    CardNode& node(int number) { return now_.nodes[static_cast<std::size_t>(number)]; }

    CardState start_, now_;
    std::vector<Change> log_;
    std::array<OpenFile, kMostOpen> files_;
    CardFault fault_;
    int counted_ = 0, struck_ = 0;
    std::uint64_t capacity_ = kCapacityBytes;
    bool listing_ = false;
};

} // namespace dicot::test
