// Where snapshots are pulled from: a board on a cable, a card in a reader, a folder that somebody copied.
#pragma once

#include "dicot/base/function_ref.h"
#include "dicot/base/short_text.h"
#include "dicot/base/status.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace dicot {

/// A snapshot that the source says it has. Nothing of it is believed before its digests are right.
struct OfferedSnapshot
{
    std::int64_t sequence = 0;
    std::int64_t began_us = 0;                     ///< since 1970, UTC; with the number it makes the folder's name
    std::optional<std::uint64_t> bytes;            ///< of all files; none: not told
    std::optional<std::array<std::byte, 32>> sums; ///< SHA-256 of SHA256SUMS, if it is told before it is read
    bool pulled = false;                           ///< some host has it already, so the source says
    std::uint64_t handle = 0;                      ///< the source's own word for it
};

struct OfferedFile
{
    ShortText<31> name;
    std::uint64_t bytes = 0;
    std::uint64_t handle = 0;
};

/// Untrusted: whoever reads from it bounds, checks and hashes. Not for several threads at once.
class PullSource
{
public:
    virtual ~PullSource() = default;

    virtual std::string_view device() const = 0; ///< the board's name: its folder in the archive; is_device_name()
    virtual std::string_view serial() const = 0; ///< empty: not known (a folder)
    virtual std::string_view where() const = 0;  ///< for people: "USB 1-1.4", "/media/card"

    /// In ascending order of sequence, until `visit` returns false. Fault::kUnavailable: it has gone; kBadData: it
    /// answers nonsense; kIoError.
    virtual Status snapshots(std::int64_t first_sequence, FunctionRef<bool(const OfferedSnapshot&)> visit) = 0;
    /// The files of one, SHA256SUMS among them; more than a store ever has is Fault::kBadData. kNoInput: pruned since.
    virtual Status files(const OfferedSnapshot& snapshot, FunctionRef<bool(const OfferedFile&)> visit) = 0;
    /// From `offset` on; fewer bytes only at the end. Faults as above.
    virtual Result<std::size_t> read(const OfferedFile& file, std::uint64_t offset, std::span<std::byte> into) = 0;

    struct Pulled
    {
        std::int64_t sequence = 0;
        std::array<std::byte, 32> sums{};
    };
    /// Tells the source what is verified and synced here. Fault::kUsage: it does not take marks (not ours, read-only,
    /// not allowed); kTryAgain: not now.
    virtual Status mark(std::span<const Pulled> pulled) = 0;
    /// False: mark() always refuses, so that nobody need prepare a mark.
    virtual bool takes_marks() const { return true; }
    /// Fault::kUsage with the rule that says no.
    virtual Status offer_time(std::int64_t now_us) = 0;
};

} // namespace dicot
