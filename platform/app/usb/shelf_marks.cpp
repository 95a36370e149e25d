#include "shelf_marks.h"

#include "dicot/catalogue/catalogue.h"
#include "dicot/medium/disk_medium.h"
#include "dicot/os/clock_trust.h"
#include "dicot/os/lent_heap.h"
#include "dicot/os/memory_reserve.h"
#include "dicot/os/sha256.h"
#include "dicot/record/record.h"

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

namespace dicot::app {
namespace {

Pull pull_of(const mtp::PulledNote& note, std::int64_t now_us)
{
    Sha256 sums{};
    std::ranges::transform(note.sums, sums.begin(), [](std::byte byte) { return static_cast<std::uint8_t>(byte); });
    return {.sequence = note.sequence, .sums = hex_of(sums).data(), .pulled_us = now_us};
}

Status mark(const std::string& path, const StoreRules& rules, std::span<const mtp::PulledNote> pulled)
{
    const auto medium = TRY(open_disk_medium(path));
    const auto store = TRY(Store::open(*medium, rules, path + "/" + Store::kCatalogueName));
    const std::int64_t now_us = read_clock({}).now_us;
    std::vector<Pull> pulls;
    pulls.reserve(pulled.size());
    for (const mtp::PulledNote& note : pulled)
        pulls.push_back(pull_of(note, now_us));
    // A host may say it twice; the store writes one mark at a time for each.
    const auto place = [](const Pull& pull) { return std::pair{pull.sequence, pull.sums.view()}; };
    std::ranges::sort(pulls, {}, place);
    const auto same = [&](const Pull& a, const Pull& b) { return place(a) == place(b); };
    pulls.erase(std::unique(pulls.begin(), pulls.end(), same), pulls.end());
    return store->mark_pulled(pulls);
}

} // namespace

std::size_t marks_pages_bytes() noexcept
{
    constexpr std::size_t kPieceBytes = std::size_t{64} << 10;
    return MemoryReserve::bytes_for(kRecordHeapBytes + kMaxRecordBytes + kPieceBytes);
}

Status write_marks(const std::string& path, const StoreRules& rules, std::span<const mtp::PulledNote> pulled,
                   std::span<std::byte> office) noexcept
{
    const LentHeap lent(office);
    try {
        return mark(path, rules, pulled);
    } catch (const std::bad_alloc&) {
        return failure(Fault::kOsError, "the %zu KiB that are set apart for marks of pulls do not suffice: report it",
                       office.size() / 1024);
    }
}

Status start_catalogue()
{
    const auto catalogue = TRY(Catalogue::open(":memory:", Catalogue::Access::kWrite));
    SlotRow row;
    row.sequence = 1;
    return catalogue->put(row);
}

} // namespace dicot::app
