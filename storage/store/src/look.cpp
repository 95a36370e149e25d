#include "dicot/store/look.h"

#include "snapshot_folder.h"

#include "dicot/os/shown_path.h"
#include "dicot/store/store.h"

namespace dicot {

Result<std::string> read_record_text(Medium& medium, const SlotRow& row)
{
    const StorePath folder = folder_of(row.sequence, row.began_us).view();
    if (!is_there(medium, folder.c_str()))
        return failure(Fault::kNoInput, "%s: the folder is not there", shown_path(folder.c_str()));
    const ReadingDesk desk = TRY(ReadingDesk::make());
    const StorePath path = join(folder.view(), kRecord);
    const std::span<const std::byte> text = TRY(read_whole(medium, path, desk.record()));
    const RecordFacts facts = TRY(read_record(text, path.c_str(), desk.heap()));
    if (facts.sequence != row.sequence || facts.began_us != row.began_us)
        return failure(Fault::kBadData, "%s: it is the record of number %lld", shown_path(path.c_str()),
                       static_cast<long long>(facts.sequence));
    return std::string{reinterpret_cast<const char*>(text.data()), text.size()};
}

Result<int> check_snapshot(Medium& medium, const SlotRow& row,
                           FunctionRef<void(const char* name, const Status& outcome)> told)
{
    const StorePath folder = folder_of(row.sequence, row.began_us).view();
    const ReadingDesk desk = TRY(ReadingDesk::make());
    const Result<ReadSums> read = read_sums(medium, folder);
    Status outcome = read.status();
    if (outcome.ok() && !row.sums.empty() && read.value().sha256 != row.sums)
        outcome = failure(Fault::kBadData, "%s: its bytes are not those that were stored",
                          shown_path(join(folder.view(), kSums).c_str()));
    int flaws = outcome.ok() ? 0 : 1;
    told(kSums, outcome);
    if (!read.ok())
        return flaws;
    std::uint64_t bytes = 0;
    for (const Sum& sum : read.value().sums.all()) {
        outcome = check_file(medium, folder, sum, desk, bytes);
        flaws += outcome.ok() ? 0 : 1;
        told(sum.name.c_str(), outcome);
    }
    return flaws;
}

} // namespace dicot
