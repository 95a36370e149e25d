#include "dicot/mtp_host/initiator.h"

#include "answers.h"
#include "conversation.h"
#include "request.h"

#include "dicot/mtp/codes.h"

#include <algorithm>
#include <array>

namespace dicot::mtp {
namespace {

constexpr std::size_t kTableBytes = 4 + 4 * Initiator::kMostHandles;
constexpr std::size_t kLeastPart = 4096; ///< of what was asked for: less, and not at the end, is nonsense

Status nonsense(std::uint16_t operation)
{
    return failure(Fault::kBadData, "the device's answer to operation %04X is damaged", operation);
}

} // namespace

Initiator::Initiator(UsbPipe& pipe, const Patience& patience)
    : pipe_(pipe), patience_(patience), talk_(std::make_unique<Conversation>(pipe, kRoomBytes, patience.answer_ms)),
      table_(std::make_unique_for_overwrite<std::byte[]>(kTableBytes))
{
}

Initiator::~Initiator() = default;

std::span<std::byte> Initiator::table() const noexcept
{
    return {table_.get(), kTableBytes};
}

Status Initiator::hear(Answer& answer)
{
    const std::uint64_t bytes = TRY(talk_->await_data(answer.expected, answer.into.size()));
    answer.got = TRY(talk_->take(answer.into.first(static_cast<std::size_t>(bytes))));
    return {};
}

Status Initiator::say(const Request& request, Answer& answer)
{
    TRY(talk_->command(request.operation, request.parameters()));
    answer.got = 0;
    Status taken;
    if (!request.data.empty())
        TRY(talk_->give(request.data));
    else if (!answer.into.empty()) {
        taken = hear(answer);
        if (!taken.ok() && !talk_->ended_early())
            return taken;
    }
    answer.response_code = TRY(talk_->finish());
    // A file that went, or cannot be read, while it was sent: the device says so, and nothing is broken.
    return answer.response_code == response::kOk ? taken : Status{};
}

Status Initiator::ask(const Request& request, Answer& answer)
{
    const unsigned session = sessions_;
    TRY(end_stream());
    for (bool again = false;;) {
        if (session != sessions_ && request.names_object)
            TRY(go_on_in_new_session());
        Status said = say(request, answer);
        if (said.ok() && talk_->ended_early() &&
            !again) { // asked once more, it says whether the object is there at all
            again = true;
            continue;
        }
        if (said.ok() && answer.response_code == response::kSessionNotOpen)
            said = failure(Fault::kIoError, "the device forgot the session");
        if (said.ok() && answer.response_code == response::kInvalidTransactionId)
            said = failure(Fault::kBadData, "the device lost count of the transactions");
        if (said.ok()) {
            failures_ = 0;
            return {};
        }
        TRY(recover(said));
    }
}

/// Our own boards' handles mean the same for ever.
Status Initiator::go_on_in_new_session() const
{
    if (facts_.lists_snapshots)
        return {};
    return failure(Fault::kTryAgain, "the device lost the thread; a new session was begun");
}

Status Initiator::ask_well(const Request& request, Answer& answer)
{
    TRY(ask(request, answer));
    return refusal(answer.response_code, request.operation);
}

Status Initiator::learn()
{
    Answer answer{table()};
    TRY(ask_well({operation::kGetDeviceInfo, {}, 0, {}}, answer));
    return read_facts(answer.bytes(), facts_) ? Status{} : nonsense(operation::kGetDeviceInfo);
}

Status Initiator::storages(std::vector<std::uint32_t>& into)
{
    Answer answer{table()};
    TRY(ask_well({operation::kGetStorageIds, {}, 0, {}}, answer));
    return read_numbers(answer.bytes(), kMostStorages, into) ? Status{} : nonsense(operation::kGetStorageIds);
}

Status Initiator::children(std::uint32_t storage, std::uint32_t parent, bool folders_alone,
                           std::vector<std::uint32_t>& into)
{
    const std::uint32_t folder = parent == 0 ? kTop : parent;
    for (bool filter = folders_alone && filters_;; filter = false) {
        const std::uint32_t format = filter ? format::kAssociation : 0;
        Answer answer{table()};
        TRY(ask({operation::kGetObjectHandles, {storage, format, folder}, 3, {}, parent != 0}, answer));
        if (filter && answer.response_code != response::kOk) {
            filters_ = false;
            continue;
        }
        TRY(refusal(answer.response_code, operation::kGetObjectHandles));
        if (!read_numbers(answer.bytes(), kMostHandles, into))
            return nonsense(operation::kGetObjectHandles);
        // No object stands in itself or twice, whatever the device says.
        std::ranges::sort(into);
        into.erase(std::unique(into.begin(), into.end()), into.end());
        std::erase_if(into, [&](std::uint32_t one) { return one == 0 || one == kTop || one == parent; });
        if (filter && into.empty())
            continue; // it may be that it knows no folders by their format
        return {};
    }
}

Status Initiator::object(std::uint32_t handle, ObjectFacts& into)
{
    Answer answer{table()};
    TRY(ask_well({operation::kGetObjectInfo, {handle}, 1, {}, true}, answer));
    return read_facts(answer.bytes(), into) ? Status{} : nonsense(operation::kGetObjectInfo);
}

Result<std::size_t> Initiator::read(std::uint32_t handle, std::uint64_t bytes, std::uint64_t offset,
                                    std::span<std::byte> into)
{
    if (bytes >= kTooLarge)
        return failure(Fault::kBadData, "a file of 4 GiB or more is none of a snapshot");
    if (offset >= bytes)
        return std::size_t{0};
    into = into.first(static_cast<std::size_t>(std::min<std::uint64_t>(into.size(), bytes - offset)));
    if (!facts_.partial && !facts_.partial_64) {
        TRY(read_stream(handle, bytes, offset, into));
        return into.size();
    }
    for (std::size_t held = 0; held < into.size();) {
        const auto piece = into.subspan(held, std::min(into.size() - held, kPieceBytes));
        std::size_t got = 0;
        TRY(read_part(handle, offset + held, piece, got));
        if (got < std::min(piece.size(), kLeastPart))
            return failure(Fault::kBadData, "the device sent %zu bytes of a file where it has %zu", got, piece.size());
        held += got;
    }
    return into.size();
}

Status Initiator::read_part(std::uint32_t handle, std::uint64_t offset, std::span<std::byte> into, std::size_t& got)
{
    const auto low = static_cast<std::uint32_t>(offset);
    const auto high = static_cast<std::uint32_t>(offset >> 32);
    const auto most = static_cast<std::uint32_t>(into.size());
    Answer answer{into, into.size()};
    if (facts_.partial_64)
        TRY(ask_well({operation::kGetPartialObject64, {handle, low, high, most}, 4, {}, true}, answer));
    else
        TRY(ask_well({operation::kGetPartialObject, {handle, low, most}, 3, {}, true}, answer));
    got = answer.got;
    return {};
}

Status Initiator::list_snapshots(std::int64_t first, std::vector<SnapshotNote>& into)
{
    if (!facts_.lists_snapshots)
        return failure(Fault::kUsage, "the device lists no snapshots");
    Answer answer{table()};
    const auto number = static_cast<std::uint64_t>(first);
    const auto low = static_cast<std::uint32_t>(number);
    const auto high = static_cast<std::uint32_t>(number >> 32);
    TRY(ask_well({operation::kListSnapshots, {low, high, kMostNotes}, 3, {}}, answer));
    return read_notes(answer.bytes(), first, into) ? Status{} : nonsense(operation::kListSnapshots);
}

Status Initiator::mark_pulled(std::span<const PulledNote> pulled)
{
    if (!facts_.takes_marks)
        return failure(Fault::kUsage, "the device takes no marks");
    if (pulled.size() > kMostMarks)
        return failure(Fault::kSoftware, "%zu marks are more than go to a device at once", pulled.size());
    std::array<std::byte, 4 + kPulledNoteBytes * kMostMarks> room;
    SpanSink sink(room);
    DataWriter out(sink);
    out.u32(static_cast<std::uint32_t>(pulled.size()));
    for (const PulledNote& note : pulled)
        write(out, note);
    Answer answer;
    return ask_well({operation::kMarkPulled, {}, 0, sink.written()}, answer);
}

Status Initiator::offer_time(const TimeOffer& offer)
{
    if (!facts_.takes_time)
        return failure(Fault::kUsage, "the device takes no time");
    std::array<std::byte, kTimeOfferBytes> room;
    SpanSink sink(room);
    DataWriter out(sink);
    write(out, offer);
    Answer answer;
    return ask_well({operation::kOfferTime, {}, 0, sink.written()}, answer);
}

} // namespace dicot::mtp
