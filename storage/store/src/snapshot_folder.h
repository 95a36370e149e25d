// A snapshot's folder, looked at by whoever did not write it.
#pragma once

#include "card.h"
#include "dicot/store/sums.h"
#include "folder_name.h"

#include "dicot/catalogue/catalogue.h"
#include "dicot/record/record.h"

#include "dicot/os/memory_block.h"
#include "dicot/os/sha256.h"

#include <cstddef>
#include <optional>
#include <span>

namespace dicot {

/// What reading needs: a record and what it takes to read it, a piece of a file. Taken once.
class ReadingDesk
{
public:
    static Result<ReadingDesk> make();

    std::span<std::byte> record() const { return block_.bytes().subspan(kRecordHeapBytes, kMaxRecordBytes); }
    std::span<std::byte> heap() const { return block_.bytes().first(kRecordHeapBytes); }
    std::span<std::byte> piece() const { return block_.bytes().subspan(kRecordHeapBytes + kMaxRecordBytes); }

private:
    explicit ReadingDesk(MemoryBlock block) : block_(std::move(block)) {}

    MemoryBlock block_;
};

/// SHA256SUMS, and the digest of its own bytes.
struct ReadSums
{
    Sums sums;
    Sha256 digest{};
    ShortText<64> sha256; ///< the same, hexadecimal
    std::uint64_t bytes = 0;
};

/// Errors of all three: Fault::kIoError, and kBadData with the path.
Result<ReadSums> read_sums(Medium& medium, const StorePath& folder);
Result<RecordFacts> read_record_file(Medium& medium, const StorePath& folder, const ReadingDesk& desk);
/// None: there is no mark, or one that cannot be read.
std::optional<std::int64_t> pulled_time(Medium& medium, const StorePath& folder, const ShortText<64>& sums);

/// What the catalogue has of a folder in its place, without hashing its large files. Also Fault::kBadData: the record
/// is of another snapshot than the folder's name says.
Result<SlotRow> row_of(Medium& medium, const StorePath& folder, const SnapshotName& name, const ReadingDesk& desk);

/// Whether `name` in `folder` has this digest; `bytes` counts what was read. Fault::kIoError; kBadData: it has not.
Status check_file(Medium& medium, const StorePath& folder, const Sum& sum, const ReadingDesk& desk,
                  std::uint64_t& bytes);

/// Whole: SHA256SUMS is there and right, and the record bears the folder's name.
/// Fault::kIoError: nobody can say.
Result<bool> is_whole(Medium& medium, const StorePath& folder, const SnapshotName& name, const ReadingDesk& desk);

/// It is there and not what was stored, or not there: reading it again would say the same.
bool is_damage(const Status& status);

/// Every snapshot in its place, day by day; other entries are passed over. `visit` returns false to end it. False:
/// there was a day that cannot be listed.
Result<bool> for_each_folder(Medium& medium,
                             FunctionRef<bool(const StorePath& folder, const SnapshotName& name)> visit);

} // namespace dicot
