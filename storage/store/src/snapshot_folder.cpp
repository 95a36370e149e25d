#include "snapshot_folder.h"

#include "pulled_mark.h"

#include "dicot/base/utc_time.h"
#include "dicot/os/sha256.h"
#include "dicot/os/shown_path.h"

#include <utility>

namespace dicot {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{64} << 10;
constexpr std::uint64_t kMostFileBytes = kMaxSlotBytes / (2 * kMaxSums);

std::string_view text_of(std::span<const std::byte> bytes)
{
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Status with_path(const Status& why, const StorePath& path)
{
    return failure(why.fault(), "%s: %s", shown_path(path.c_str()), why.message());
}

} // namespace

Result<ReadingDesk> ReadingDesk::make()
{
    return ReadingDesk(TRY(MemoryBlock::map(kRecordHeapBytes + kMaxRecordBytes + kPieceBytes)));
}

Result<ReadSums> read_sums(Medium& medium, const StorePath& folder)
{
    const StorePath path = join(folder.view(), kSums);
    std::byte buffer[kMaxSumsBytes];
    const std::span<const std::byte> bytes = TRY(read_whole(medium, path, buffer));
    Result<Sums> sums = parse_sums(text_of(bytes));
    if (!sums.ok())
        return with_path(sums.status(), path);
    const Sha256 digest = sha256_of(bytes);
    return ReadSums{sums.value(), digest, hex_of(digest).data(), bytes.size()};
}

Result<RecordFacts> read_record_file(Medium& medium, const StorePath& folder, const ReadingDesk& desk)
{
    const StorePath path = join(folder.view(), kRecord);
    const std::span<const std::byte> text = TRY(read_whole(medium, path, desk.record()));
    return read_record(text, path.c_str(), desk.heap());
}

std::optional<std::int64_t> pulled_time(Medium& medium, const StorePath& folder, const ShortText<64>& sums)
{
    std::byte buffer[PulledText::kCapacity];
    const auto bytes = read_whole(medium, join(folder.view(), kPulledMark), buffer);
    if (!bytes.ok())
        return {};
    const Result<PulledMark> mark = parse_pulled(text_of(bytes.value()));
    if (!mark.ok() || mark.value().sums != sums)
        return {};
    return mark.value().pulled_us;
}

Result<SlotRow> row_of(Medium& medium, const StorePath& folder, const SnapshotName& name, const ReadingDesk& desk)
{
    const ReadSums sums = TRY(read_sums(medium, folder));
    const RecordFacts facts = TRY(read_record_file(medium, folder, desk));
    if (facts.sequence != name.sequence || facts.began_us != name.began_us)
        return failure(Fault::kBadData, "%s: its record is of number %lld at %s", shown_path(folder.c_str()),
                       static_cast<long long>(facts.sequence), utc_text(facts.began_us).c_str());
    SlotRow row{.sequence = facts.sequence,
                .began_us = facts.began_us,
                .due_us = facts.due_us,
                .done = facts.done,
                .reason = facts.reason,
                .clock_trust = facts.clock_trust,
                .points = facts.points,
                .bytes = static_cast<std::int64_t>(sums.bytes),
                .sums = sums.sha256,
                .pulled_us = {},
                .kept = Kept::kHere};
    for (const Sum& sum : sums.sums.all()) {
        const StorePath path = join(folder.view(), sum.name.view());
        Medium::File file = 0;
        std::uint64_t size = 0;
        TRY(opened(medium.open(path.c_str(), file, size), path.c_str()));
        TRY(on_card(medium.close(file), path.c_str(), "closing it"));
        if (size > kMostFileBytes)
            return failure(Fault::kBadData, "%s: it is larger than such a file can be", shown_path(path.c_str()));
        row.bytes += static_cast<std::int64_t>(size);
    }
    row.pulled_us = pulled_time(medium, folder, row.sums);
    return row;
}

Status check_file(Medium& medium, const StorePath& folder, const Sum& sum, const ReadingDesk& desk,
                  std::uint64_t& bytes)
{
    const StorePath path = join(folder.view(), sum.name.view());
    Sha256Stream stream;
    TRY(read_file(medium, path, kMostFileBytes, desk.piece(), [&](std::span<const std::byte> piece) {
        stream.update(piece);
        bytes += piece.size();
    }));
    if (sum.sha256.view() != hex_of(stream.finish()).data())
        return failure(Fault::kBadData, "%s: its bytes are not those that were stored", shown_path(path.c_str()));
    return {};
}

bool is_damage(const Status& status)
{
    return status.fault() == Fault::kBadData || status.fault() == Fault::kNoInput;
}

Result<bool> is_whole(Medium& medium, const StorePath& folder, const SnapshotName& name, const ReadingDesk& desk)
{
    const auto verdict = [](const Status& status) -> Result<bool> {
        if (status.ok() || is_damage(status))
            return status.ok();
        return status;
    };
    const Result<ReadSums> sums = read_sums(medium, folder);
    if (!sums.ok())
        return verdict(sums.status());
    std::uint64_t bytes = 0;
    for (const Sum& sum : sums.value().sums.all())
        if (const Status status = check_file(medium, folder, sum, desk, bytes); !status.ok())
            return verdict(status);
    // What was taken back may still be there.
    bool is_alone = true;
    const Errno listed = medium.list(folder.c_str(), [&](const MediumEntry& entry) {
        is_alone = entry.name == kSums || sums.value().sums.find(entry.name) != nullptr;
        return is_alone;
    });
    TRY(on_card(listed, folder.c_str(), "listing it"));
    return is_alone ? verdict(row_of(medium, folder, name, desk).status()) : Result<bool>(false);
}

Result<bool> for_each_folder(Medium& medium, FunctionRef<bool(const StorePath& folder, const SnapshotName& name)> visit)
{
    bool all = true;
    const Errno listed = medium.list("", [&](const MediumEntry& day) {
        if (day.kind != EntryKind::kFolder || !is_day_name(day.name))
            return true;
        const StorePath day_path = day.name;
        bool goes_on = true;
        const Errno inside = medium.list(day_path.c_str(), [&](const MediumEntry& entry) {
            const auto name = parse_snapshot_name(entry.name);
            if (entry.kind == EntryKind::kFolder && name && utc_day(name->began_us).view() == day_path.view())
                goes_on = visit(join(day_path.view(), entry.name), *name);
            return goes_on;
        });
        all = all && inside.ok();
        return goes_on;
    });
    TRY(on_card(listed, "", "listing it"));
    return all;
}

} // namespace dicot
