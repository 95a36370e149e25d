#include "board_source.h"

#include "config/device_name.h"

#include "dicot/base/utc_time.h"

#include <algorithm>

namespace dicot::app {
namespace {

constexpr std::size_t kMostAtTheTop = 64;
constexpr std::int64_t kSecond = 1'000'000;

struct Place
{
    std::uint32_t storage = 0;
    std::string device;
};

class BoardSource final : public PullSource
{
public:
    BoardSource(std::shared_ptr<DeviceTalk> talk, Place place) : talk_(std::move(talk)), place_(std::move(place)) {}

    std::string_view device() const override { return place_.device; }
    std::string_view serial() const override { return talk_->serial(); }
    std::string_view where() const override { return talk_->where(); }

    Status snapshots(std::int64_t first_sequence, FunctionRef<bool(const OfferedSnapshot&)> visit) override;
    Status files(const OfferedSnapshot& snapshot, FunctionRef<bool(const OfferedFile&)> visit) override
    {
        return talk_->files_in(place_.storage, static_cast<std::uint32_t>(snapshot.handle), visit);
    }
    Result<std::size_t> read(const OfferedFile& file, std::uint64_t offset, std::span<std::byte> into) override
    {
        return talk_->initiator().read(static_cast<std::uint32_t>(file.handle), file.bytes, offset, into);
    }
    Status mark(std::span<const Pulled> pulled) override;
    Status offer_time(std::int64_t now_us) override { return talk_->initiator().offer_time({now_us}); }

private:
    std::shared_ptr<DeviceTalk> talk_;
    Place place_;
};

bool makes_a_name(const mtp::SnapshotNote& note)
{
    return note.folder != 0 && note.began_us % kSecond == 0 && note.began_us >= kFirstUtcUs &&
           note.began_us <= kLastUtcUs;
}

Status BoardSource::snapshots(std::int64_t first_sequence, FunctionRef<bool(const OfferedSnapshot&)> visit)
{
    std::vector<mtp::SnapshotNote> notes;
    std::size_t offered = 0;
    for (std::int64_t first = std::max<std::int64_t>(first_sequence, 1);;) {
        TRY(talk_->initiator().list_snapshots(first, notes));
        offered += notes.size();
        if (offered > DeviceTalk::kMostOffered || !std::ranges::all_of(notes, makes_a_name))
            return failure(Fault::kBadData, "%s: the board %s lists snapshots that no board has", talk_->where().data(),
                           place_.device.c_str());
        if (notes.empty())
            return {};
        for (const mtp::SnapshotNote& note : notes) {
            const OfferedSnapshot offer{note.sequence, note.began_us, note.bytes, note.sums, note.pulled, note.folder};
            if (!visit(offer))
                return {};
        }
        first = notes.back().sequence + 1;
    }
}

Status BoardSource::mark(std::span<const Pulled> pulled)
{
    std::vector<mtp::PulledNote> notes;
    while (!pulled.empty()) {
        const auto part = pulled.first(std::min(pulled.size(), mtp::Initiator::kMostMarks));
        notes.clear();
        for (const Pulled& one : part)
            notes.push_back({one.sequence, one.sums});
        TRY(talk_->initiator().mark_pulled(notes));
        pulled = pulled.subspan(part.size());
    }
    return {};
}

} // namespace

Result<std::unique_ptr<PullSource>> open_board(std::shared_ptr<DeviceTalk> talk)
{
    Place place;
    std::vector<std::uint32_t> storages;
    TRY(talk->initiator().storages(storages));
    for (const std::uint32_t storage : storages) {
        TRY(talk->for_each_in(storage, 0, true, kMostAtTheTop, [&](std::uint32_t, const mtp::ObjectFacts& facts) {
            if (!facts.folder || !is_device_name(facts.name.view()))
                return true;
            place = {storage, std::string{facts.name.view()}};
            return false;
        }));
        if (!place.device.empty())
            return std::unique_ptr<PullSource>{std::make_unique<BoardSource>(std::move(talk), std::move(place))};
    }
    return failure(Fault::kBadData, "%s: the board does not say what it is called", talk->where().data());
}

} // namespace dicot::app
