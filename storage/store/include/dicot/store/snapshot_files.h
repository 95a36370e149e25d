// The files of one snapshot in its place, for who shows them to others.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"
#include "dicot/medium/medium.h"
#include "dicot/os/sha256.h"
#include "dicot/store/store.h"

#include <array>
#include <cstdint>
#include <span>

namespace dicot {

struct StoredFile
{
    ShortText<31> name;
    std::uint64_t bytes = 0;
};

struct SnapshotFiles
{
    std::array<StoredFile, Store::kMaxFiles> files; ///< in the order of SHA256SUMS
    int count = 0;                                  ///< 1 at least: record.json
    std::uint64_t sums_bytes = 0;                   ///< SHA256SUMS
    Sha256 sums{};                                  ///< of SHA256SUMS
    bool pulled = false;                            ///< PULLED is there, readable, and of these sums

    std::span<const StoredFile> all() const { return {files.data(), static_cast<std::size_t>(count)}; }
    std::uint64_t bytes() const; ///< of all of them, SHA256SUMS too
};

/// Reads SHA256SUMS and asks for the sizes; hashes nothing. `folder`: "2026-06-01/000017_20260601T120000Z". No heap.
/// Fault::kNoInput: the folder is not there; kBadData: SHA256SUMS is missing or none, or a file that it names is
/// missing, no file, or too large; kIoError: nobody can say.
Result<SnapshotFiles> files_of_snapshot(Medium& medium, const char* folder);

} // namespace dicot
