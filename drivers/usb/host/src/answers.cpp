#include "answers.h"

#include "dicot/base/printable.h"
#include "dicot/mtp/codes.h"
#include "dicot/mtp/datasets.h"
#include "dicot/mtp/snapshot_bytes.h"

#include <algorithm>

namespace dicot::mtp {
namespace {

constexpr std::int64_t kMostSequence = 999'999'999;

} // namespace

bool read_facts(std::span<const std::byte> bytes, DeviceFacts& into)
{
    const std::optional<DeviceInfo> info = read_device_info(bytes);
    if (!info)
        return false;
    // What their numbers mean on devices of others, nobody knows.
    const bool ours = info->extension_words.view().find(kOwnExtension) != std::string_view::npos;
    into.partial = info->operations.has(operation::kGetPartialObject);
    into.partial_64 = info->operations.has(operation::kGetPartialObject64);
    into.lists_snapshots = ours && info->operations.has(operation::kListSnapshots);
    into.takes_marks = ours && info->operations.has(operation::kMarkPulled);
    into.takes_time = ours && info->operations.has(operation::kOfferTime);
    into.manufacturer = printable<63>(info->manufacturer.view());
    into.model = printable<63>(info->model.view());
    into.version = printable<63>(info->version.view());
    into.serial = printable<63>(info->serial.view());
    return true;
}

bool read_facts(std::span<const std::byte> bytes, ObjectFacts& into)
{
    const std::optional<ObjectInfo> info = read_object_info(bytes);
    if (!info)
        return false;
    into.parent = info->parent;
    into.folder = info->format == format::kAssociation;
    into.bytes = info->size;
    into.name = info->name;
    return true;
}

bool read_numbers(std::span<const std::byte> bytes, std::size_t most, std::vector<std::uint32_t>& into)
{
    into.clear();
    return bytes.size() <= 4 + 4 * most && read_handles(bytes, [&](std::uint32_t one) { into.push_back(one); });
}

bool read_notes(std::span<const std::byte> bytes, std::int64_t first, std::vector<SnapshotNote>& into)
{
    into.clear();
    DataReader in{bytes};
    std::int64_t least = std::max<std::int64_t>(first, 1);
    for (std::uint32_t left = in.count(kSnapshotNoteBytes); left > 0; --left) {
        into.push_back(read_snapshot_note(in));
        const std::int64_t sequence = into.back().sequence;
        if (sequence < least || sequence > kMostSequence || into.size() > Initiator::kMostNotes)
            return false;
        least = sequence + 1;
    }
    return in.ended();
}

} // namespace dicot::mtp
