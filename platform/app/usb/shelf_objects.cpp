#include "shelf_objects.h"

#include "shelf_handles.h"
#include "shelf_marks.h"

#include "dicot/base/utc_time.h"
#include "dicot/catalogue/catalogue.h"
#include "dicot/medium/disk_medium.h"
#include "dicot/os/clock.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

namespace dicot::app {
namespace {

constexpr std::int64_t kDayUs = 86'400'000'000;
/// Of a catalogue that is written to; half a MiB seen over 10,000 snapshots.
constexpr std::size_t kCatalogueResidentBytes = std::size_t{1} << 20;

Status no_such_object(mtp::Handle handle)
{
    return failure(Fault::kNoInput, "there is no object %08x", static_cast<unsigned>(handle));
}

bool visit_members(std::int64_t sequence, int files, FunctionRef<bool(mtp::Handle)> visit)
{
    for (int member = 1; member <= files; ++member)
        if (!visit(handle_of(sequence, member)))
            return false;
    return visit(handle_of(sequence, kSumsMember));
}

mtp::Object day_object(std::uint32_t day)
{
    const std::int64_t midnight_us = day * kDayUs;
    return {.handle = handle_of_day(day),
            .parent = kBoardFolder,
            .folder = true,
            .bytes = 0,
            .made_us = midnight_us,
            .name = utc_day(midnight_us).view()};
}

mtp::SnapshotNote note_of(const SnapshotName& name, const SnapshotFiles& files)
{
    mtp::SnapshotNote note{.sequence = name.sequence,
                           .began_us = name.began_us,
                           .bytes = files.bytes(),
                           .folder = handle_of(name.sequence, 0),
                           .files = static_cast<std::uint32_t>(files.count + 1),
                           .pulled = files.pulled,
                           .sums = {}};
    std::ranges::transform(files.sums, note.sums.begin(), [](std::uint8_t byte) { return std::byte{byte}; });
    return note;
}

} // namespace

ShelfBudget shelf_budget(const SnapshotShelf::Limits& limits) noexcept
{
    return {.index = SnapshotShelf::bytes_for(limits),
            .office = kMarksOfficeBytes,
            .catalogue = Catalogue::kHeapBytes,
            .catalogue_resident = kCatalogueResidentBytes,
            .pages = marks_pages_bytes()};
}

ShelfObjects::ShelfObjects(const ShelfSettings& settings, std::unique_ptr<Medium> medium, MemoryBlock index,
                           MemoryBlock office)
    : settings_(settings), medium_(std::move(medium)), index_(std::move(index)), office_(std::move(office)),
      shelf_(*medium_, settings.limits, index_.bytes(), monotonic_us)
{
}

Result<std::unique_ptr<ShelfObjects>> ShelfObjects::open(const ShelfSettings& settings)
{
    auto medium = TRY(open_disk_medium(settings.path));
    MemoryBlock index = TRY(MemoryBlock::map(SnapshotShelf::bytes_for(settings.limits)));
    MemoryBlock office = TRY(MemoryBlock::map(kMarksOfficeBytes));
    std::unique_ptr<ShelfObjects> objects(
        new ShelfObjects(settings, std::move(medium), std::move(index), std::move(office)));
    if (settings.marks)
        TRY(start_catalogue());
    TRY(objects->refresh([](const Change&) {}));
    return objects;
}

Result<mtp::Shelf> ShelfObjects::shelf()
{
    MediumSpace space;
    if (const Errno outcome = medium_->space(space); !outcome.ok())
        return failure(Fault::kIoError, "the card does not say how large it is (%s)",
                       strerrordesc_np(outcome.number()));
    return mtp::Shelf{settings_.device.c_str(), space.total_bytes, space.free_bytes};
}

Status ShelfObjects::children(mtp::Handle parent, FunctionRef<bool(mtp::Handle)> visit)
{
    if (parent == mtp::kRoot) {
        (void)visit(kBoardFolder);
    } else if (parent == kBoardFolder) {
        shelf_.days([&](std::uint32_t day) { return visit(handle_of_day(day)); });
    } else if (is_day(parent) && shelf_.has_day(day_of(parent))) {
        shelf_.snapshots_of_day(day_of(parent),
                                [&](const SnapshotName& name, int) { return visit(handle_of(name.sequence, 0)); });
    } else if (sequence_of(parent) != 0 && member_of(parent) == 0) {
        const SnapshotFiles* const files = TRY(shelf_.files(sequence_of(parent)));
        (void)visit_members(sequence_of(parent), files->count, visit);
    } else {
        return no_such_object(parent);
    }
    return {};
}

Status ShelfObjects::all(FunctionRef<bool(mtp::Handle)> visit)
{
    bool goes_on = visit(kBoardFolder);
    if (goes_on)
        shelf_.days([&](std::uint32_t day) { return goes_on = visit(handle_of_day(day)); });
    if (goes_on)
        shelf_.snapshots(1, [&](const SnapshotName& name, int files) {
            return visit(handle_of(name.sequence, 0)) && visit_members(name.sequence, files, visit);
        });
    return {};
}

Result<mtp::Object> ShelfObjects::find(mtp::Handle handle)
{
    if (handle == kBoardFolder)
        return mtp::Object{.handle = handle,
                           .parent = mtp::kRoot,
                           .folder = true,
                           .bytes = 0,
                           .made_us = shelf_.latest_before(std::numeric_limits<std::int64_t>::max()).value_or(0),
                           .name = settings_.device.c_str()};
    if (is_day(handle) && shelf_.has_day(day_of(handle)))
        return day_object(day_of(handle));
    const std::int64_t sequence = sequence_of(handle);
    const std::optional<SnapshotName> name = shelf_.find(sequence);
    if (!name)
        return no_such_object(handle);
    mtp::Object object{.handle = handle,
                       .parent = handle_of(sequence, 0),
                       .folder = false,
                       .bytes = 0,
                       .made_us = name->began_us,
                       .name = {}};
    if (member_of(handle) == 0) {
        object.parent = handle_of_day(static_cast<std::uint32_t>(name->began_us / kDayUs));
        object.folder = true;
        object.name = snapshot_name(*name).view();
        return object;
    }
    const SnapshotFiles* const files = TRY(shelf_.files(sequence));
    const int member = member_of(handle);
    if (member == kSumsMember) {
        object.bytes = files->sums_bytes;
        object.name = kSums;
        return object;
    }
    if (member > files->count)
        return no_such_object(handle);
    const StoredFile& file = files->all()[static_cast<std::size_t>(member - 1)];
    object.bytes = file.bytes;
    object.name = file.name.view();
    return object;
}

Status ShelfObjects::read(mtp::Handle handle, std::uint64_t offset, std::span<std::byte> into, std::size_t& got)
{
    got = 0;
    const std::int64_t sequence = sequence_of(handle);
    const int member = member_of(handle);
    if (sequence == 0 || member == 0)
        return no_such_object(handle);
    return shelf_.read(sequence, member == kSumsMember ? SnapshotShelf::kSumsMember : member - 1, offset, into, got);
}

Status ShelfObjects::refresh(FunctionRef<void(const Change&)> changed)
{
    return shelf_.refresh([&](const SnapshotShelf::Change& change) {
        const auto tell = [&](mtp::Handle handle) { return changed({handle, change.added}), true; };
        if (!change.snapshot) {
            (void)tell(handle_of_day(change.day));
            return;
        }
        const std::int64_t sequence = change.snapshot->sequence;
        if (change.added)
            (void)tell(handle_of(sequence, 0));
        if (change.files > 0)
            (void)visit_members(sequence, change.files, tell);
        if (!change.added)
            (void)tell(handle_of(sequence, 0));
    });
}

Status ShelfObjects::snapshots(std::int64_t first, FunctionRef<bool(const mtp::SnapshotNote&)> visit)
{
    shelf_.forget_files(); // marks may have come
    shelf_.snapshots(first, [&](const SnapshotName& name, int) {
        const auto files = shelf_.files(name.sequence);
        return !files.ok() || visit(note_of(name, *files.value()));
    });
    return {};
}

Status ShelfObjects::mark_pulled(std::span<const mtp::PulledNote> pulled)
{
    if (!settings_.marks)
        return failure(Fault::kUsage, "the board does not let hosts mark what they have (usb.marks)");
    const Status marked = write_marks(settings_.path, settings_.rules, pulled, office_.bytes());
    shelf_.forget_files();
    return marked;
}

Status ShelfObjects::offer_time(const mtp::TimeOffer& offer)
{
    const std::optional<std::int64_t> latest_us = shelf_.latest_before(kEndOfOffersUs);
    TRY(judge_offer(offer, {settings_.clock_rule, read_clock(latest_us), built_us(), latest_us}));
    return set_or_pass_on(offer, settings_.offer_file.c_str(), settings_.clock_patience_us);
}

} // namespace dicot::app
