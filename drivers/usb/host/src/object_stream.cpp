// Objects of devices that know no partial reads: one transaction that stays open while its bytes are wanted in order.
#include "conversation.h"
#include "request.h"

#include "dicot/mtp/codes.h"

#include <algorithm>

namespace dicot::mtp {
namespace {

constexpr std::uint64_t kWorthTaking = std::uint64_t{1} << 20; ///< rather than cancel

} // namespace

Status Initiator::begin_stream(std::uint32_t handle, std::uint64_t bytes)
{
    const std::uint32_t words[] = {handle};
    TRY(talk_->command(operation::kGetObject, words));
    const std::uint64_t announced = TRY(talk_->await_data(kPieceBytes, bytes));
    if (announced == 0) {
        const std::uint16_t answered = TRY(talk_->finish());
        TRY(refusal(answered, operation::kGetObject));
    }
    if (announced != bytes)
        return failure(Fault::kBadData, "the device announced %llu bytes of a file of %llu",
                       static_cast<unsigned long long>(announced), static_cast<unsigned long long>(bytes));
    stream_ = {handle, bytes, 0};
    return {};
}

Status Initiator::take_stream(std::span<std::byte> into)
{
    stream_.at += TRY(talk_->take(into));
    if (stream_.at < stream_.bytes)
        return {};
    stream_ = {};
    const std::uint16_t answered = TRY(talk_->finish());
    if (answered != response::kOk)
        return failure(Fault::kIoError, "the device says that reading failed (%04X)", answered);
    return {};
}

bool Initiator::goes_on(std::uint32_t handle, std::uint64_t bytes, std::uint64_t offset) const
{
    return stream_.handle == handle && stream_.bytes == bytes && stream_.at <= offset;
}

Status Initiator::try_stream(std::uint32_t handle, std::uint64_t bytes, std::uint64_t offset, std::span<std::byte> into)
{
    if (!goes_on(handle, bytes, offset))
        TRY(begin_stream(handle, bytes));
    while (stream_.at < offset)
        TRY(take_stream(
            table().first(static_cast<std::size_t>(std::min<std::uint64_t>(table().size(), offset - stream_.at)))));
    return take_stream(into);
}

Status Initiator::read_stream(std::uint32_t handle, std::uint64_t bytes, std::uint64_t offset,
                              std::span<std::byte> into)
{
    const unsigned session = sessions_;
    if (!goes_on(handle, bytes, offset))
        TRY(end_stream());
    for (;;) {
        if (session != sessions_)
            TRY(go_on_in_new_session());
        const Status got = try_stream(handle, bytes, offset, into);
        if (got.ok()) {
            failures_ = 0;
            return {};
        }
        if (got.fault() == Fault::kNoInput)
            return got;
        TRY(recover(got));
    }
}

/// Takes the rest, or cancels it. Whatever goes wrong shows in the next transaction.
Status Initiator::end_stream()
{
    if (stream_.handle == 0)
        return {};
    if (stream_.bytes - stream_.at <= kWorthTaking) {
        while (stream_.handle != 0)
            if (const Status taken = take_stream(table()); !taken.ok())
                return recover(taken);
        return {};
    }
    stream_ = {};
    static_cast<void>(pipe_.cancel(talk_->transaction()).ok());
    TRY(talk_->drain(patience_.drain_ms));
    return await_ready();
}

} // namespace dicot::mtp
