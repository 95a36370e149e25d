#include "board_traits.h"

#include "../progress.h"
#include "../stop_request.h"
#include "../store/shown.h"

#include "dicot/codec/decode_cloud.h"
#include "dicot/os/input_file.h"
#include "dicot/os/sha256.h"
#include "dicot/store/look.h"
#include "dicot/store/snapshot_name.h"
#include "dicot/store/sums.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string_view>
#include <thread>

namespace dicot::app {
namespace {

constexpr const char* kCloud = "cloud.drc";

/// Why a slot that is done has no cloud to look at; empty: it has.
const char* way_out(const SlotRow& row)
{
    switch (row.kept) {
    case Kept::kHere:
        return "";
    case Kept::kPruned:
        return "deleted to make room";
    case Kept::kQuarantined:
        return "damaged, in quarantine";
    case Kept::kLost:
        return "taken away";
    }
    return "";
}

Result<std::vector<std::byte>> bytes_of(const std::string& path, std::size_t most)
{
    InputFile file;
    TRY(file.open(path.c_str()));
    if (file.size_bytes() > most)
        return failure(Fault::kBadData, "%s: it is larger than any such file", shown(path).c_str());
    std::vector<std::byte> bytes(static_cast<std::size_t>(file.size_bytes()));
    bytes.resize(TRY(file.read(bytes)));
    return bytes;
}

/// Whether the cloud is the one that SHA256SUMS names, and SHA256SUMS the one that the row names.
Status check_cloud(const std::string& folder, const SlotRow& row)
{
    const std::vector<std::byte> listed = TRY(bytes_of(folder + "/" + kSums, kMaxSumsBytes));
    if (std::string_view{hex_of(sha256_of(listed)).data()} != row.sums.view())
        return failure(Fault::kBadData, "%s/%s: it has changed since the catalogue was made", shown(folder).c_str(),
                       kSums);
    const Sums sums =
        TRY(parse_sums({reinterpret_cast<const char*>(listed.data()), listed.size()})); // NOLINT(*-reinterpret-cast)
    const Sum* const cloud = sums.find(kCloud);
    if (cloud == nullptr)
        return failure(Fault::kBadData, "%s: it has no %s", shown(folder).c_str(), kCloud);
    const std::vector<std::byte> bytes = TRY(bytes_of(folder + "/" + kCloud, kMaxCloudFileBytes));
    if (std::string_view{hex_of(sha256_of(bytes)).data()} != cloud->sha256.view())
        return failure(Fault::kBadData, "%s/%s: it is damaged: it is not what SHA256SUMS says", shown(folder).c_str(),
                       kCloud);
    return {};
}

/// A cloud that was read, and shows nothing, is a gap all the same: no curve is to fall to zero in a night.
void settle(SlotTraits& slot, SnapshotTraits traits)
{
    slot.read = true;
    if (traits.too_few_points)
        slot.gap = "too few points";
    else
        slot.traits = std::move(traits);
}

Result<SnapshotTraits> measure(const std::string& folder, const SlotRow& row, std::span<const PlantPlace> places)
{
    TRY(check_cloud(folder, row));
    return SnapshotTraits::read(folder + "/" + kCloud, places);
}

/// The zone that the board was told of, in the newest record that can be read; UTC if it was told none.
TimeZone zone_of(Medium& medium, const std::vector<SlotTraits>& slots)
{
    for (auto slot = slots.rbegin(); slot != slots.rend(); ++slot) {
        if (slot->row.kept != Kept::kHere)
            continue;
        const Result<std::string> text = read_record_text(medium, slot->row);
        if (!text.ok())
            continue;
        const nlohmann::json record = nlohmann::json::parse(text.value(), nullptr, false);
        const nlohmann::json::json_pointer zone("/parameters/schedule/timezone");
        if (!record.is_object() || !record.contains(zone) || !record[zone].is_string())
            continue;
        const std::string name = record[zone].get<std::string>();
        Result<TimeZone> opened = TimeZone::open(name.empty() ? "UTC" : name.c_str());
        return opened.ok() ? opened.value() : TimeZone{};
    }
    return {};
}

/// Several threads, a snapshot each at a time.
class Measuring
{
public:
    Measuring(const std::string& path, const TraitsWishes& wishes, TraitsCache& cache,
              FunctionRef<void(const Status&)> flawed)
        : path_(path), wishes_(wishes), cache_(cache), flawed_(flawed)
    {
    }

    Status run(std::vector<SlotTraits*> left)
    {
        left_ = std::move(left);
        {
            std::vector<std::jthread> others;
            for (int k = 1; k < wishes_.threads; ++k)
                others.emplace_back([this] { work(); });
            work();
        }
        if (!kept_.ok())
            return kept_;
        if (next_ < left_.size())
            return failure(Fault::kTryAgain,
                           "stopped: %zu of %zu snapshots are measured and kept; the same command goes on there", done_,
                           left_.size());
        return {};
    }

private:
    void work()
    {
        while (!StopRequest::asked() && going_) {
            const std::size_t at = next_++;
            if (at >= left_.size())
                return;
            SlotTraits& slot = *left_[at];
            const std::string folder = path_ + "/" + folder_of(slot.row.sequence, slot.row.began_us).c_str();
            take(slot, measure(folder, slot.row, wishes_.places));
        }
    }

    void take(SlotTraits& slot, Result<SnapshotTraits> measured)
    {
        const std::scoped_lock lock(mutex_);
        if (measured.ok()) {
            if (kept_.ok()) // the first fault stays
                kept_ = cache_.add(slot.row.sums.view(), measured.value());
            going_ = kept_.ok();
            settle(slot, std::move(measured.value()));
        } else {
            slot.gap = measured.status().message();
            progress_.wipe();
            flawed_(measured.status());
        }
        progress_.done(static_cast<int>(++done_), static_cast<int>(left_.size()));
    }

    const std::string& path_;
    const TraitsWishes& wishes_;
    TraitsCache& cache_;
    FunctionRef<void(const Status&)> flawed_;
    std::vector<SlotTraits*> left_;
    std::atomic<std::size_t> next_{0};
    std::atomic<bool> going_{true};
    std::mutex mutex_;
    std::size_t done_ = 0;
    Status kept_;
    Progress progress_{"measuring plants"};
};

} // namespace

Result<BoardTraits> measure_board(const DeviceFolder& board, const TraitsWishes& wishes,
                                  FunctionRef<void(const Status&)> flawed)
{
    BoardTraits told;
    told.device = board.device;
    const ReadStore store = TRY(ReadStore::open(board.path));
    TRY(store.catalogue->for_each(wishes.query, [&](const SlotRow& row) {
        SlotTraits& slot = told.slots.emplace_back();
        slot.row = row;
        slot.gap = row.done ? way_out(row) : row.reason.c_str();
        if (!row.done && slot.gap.empty())
            slot.gap = "missed";
        return true;
    }));
    told.zone = wishes.timezone.empty() ? zone_of(*store.medium, told.slots) : TRY(TimeZone::open(wishes.timezone));

    TraitsCache cache;
    if (!wishes.cache_folder.empty())
        cache = TRY(TraitsCache::open(wishes.cache_folder, board.device + wishes.cache_name, wishes.maker));
    std::vector<SlotTraits*> left;
    for (SlotTraits& slot : told.slots) {
        if (!slot.gap.empty())
            continue;
        if (const SnapshotTraits* known = cache.find(slot.row.sums.view())) {
            settle(slot, *known);
            ++told.from_cache;
        } else {
            left.push_back(&slot);
        }
    }
    TRY(Measuring(board.path, wishes, cache, flawed).run(std::move(left)));
    return told;
}

} // namespace dicot::app
