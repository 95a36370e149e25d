// dicot's own operations.
#include "dicot/mtp/responder.h"
#include "dicot/mtp/snapshot_bytes.h"

#include <algorithm>
#include <limits>

namespace dicot::mtp {

static_assert(kHeaderBytes + 4 + kMostSnapshotNotes * kSnapshotNoteBytes <= Exchange::kPieceBytes);

Responder::Reply Responder::list_snapshots(const Block& command)
{
    tell_changes();
    const std::uint64_t first = command.parameters[0] | std::uint64_t{command.parameters[1]} << 32;
    if (first > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
        return {response::kInvalidParameter, {}};
    const std::size_t wish = command.parameters[2] == 0 ? kMostSnapshotNotes : command.parameters[2];
    const std::size_t most = std::min(wish, kMostSnapshotNotes);
    // Each note costs the source a look at a file, so there is one pass, and the count is put in front of it
    // afterwards.
    const std::span<std::byte> data = exchange_.aside();
    SpanSink notes{data.subspan(4)};
    DataWriter out{notes};
    std::uint32_t count = 0;
    const Status listed = objects_.snapshots(static_cast<std::int64_t>(first), [&](const SnapshotNote& note) {
        if (!exchange_.fault().ok())
            return false;
        write(out, note);
        return ++count < most;
    });
    if (!listed.ok())
        return {code_of(listed), {}};
    SpanSink front{data.first(4)};
    DataWriter{front}.u32(count);
    exchange_.begin_data(4 + notes.written().size());
    const bool whole = exchange_.filled(4 + notes.written().size()).ok() && exchange_.end_data();
    return {whole ? response::kOk : response::kIncompleteTransfer, {}};
}

Responder::Reply Responder::mark_pulled(const Block&)
{
    std::span<const std::byte> data;
    const std::uint16_t came = exchange_.take_data(4 + kMostPulledNotes * kPulledNoteBytes, data);
    if (came != response::kOk)
        return {came, {}};
    DataReader in{data};
    const std::uint32_t count = in.count(kPulledNoteBytes);
    if (count > pulled_.size())
        return {response::kInvalidDataset, {}};
    for (std::uint32_t i = 0; i < count; ++i)
        pulled_[i] = read_pulled_note(in);
    if (!in.ended())
        return {response::kInvalidDataset, {}};
    const Status marked = objects_.mark_pulled(std::span{pulled_}.first(count));
    if (marked.ok())
        counts_.marked += count;
    return {code_of(marked), {}};
}

Responder::Reply Responder::offer_time(const Block&)
{
    std::span<const std::byte> data;
    const std::uint16_t came = exchange_.take_data(kTimeOfferBytes, data);
    if (came != response::kOk)
        return {came, {}};
    DataReader in{data};
    const TimeOffer offer = read_time_offer(in);
    return {in.ended() ? code_of(objects_.offer_time(offer)) : response::kInvalidDataset, {}};
}

} // namespace dicot::mtp
