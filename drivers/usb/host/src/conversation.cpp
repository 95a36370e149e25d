#include "conversation.h"

#include "dicot/os/clock.h"

#include <algorithm>
#include <cstring>

namespace dicot::mtp {
namespace {

constexpr std::size_t kUsualBytes = 16384; ///< asked for at once where nothing is known
constexpr std::size_t kPacketMost = 1024;
constexpr int kSlowestBytesPerMs = 8; ///< of data, on the whole; full speed gives a hundred times as much
constexpr int kMostDrained = 64;      ///< pieces

std::size_t whole_packets(std::size_t bytes)
{
    return (bytes + kPacketMost - 1) / kPacketMost * kPacketMost;
}

} // namespace

Conversation::Conversation(UsbPipe& pipe, std::size_t room_bytes, int patience_ms)
    : pipe_(pipe), room_bytes_(room_bytes), patience_ms_(patience_ms),
      room_(std::make_unique_for_overwrite<std::byte[]>(room_bytes))
{
}

Status Conversation::command(std::uint16_t operation, std::span<const std::uint32_t> parameters)
{
    at_ = filled_ = 0;
    ended_ = false;
    data_left_ = 0;
    ended_early_ = false;
    response_ = 0;
    operation_ = operation;
    transaction_ = next_;
    next_ = next_ >= 0xFFFFFFFE ? 1 : next_ + 1; // 0 is OpenSession's, 0xFFFFFFFF none
    deadline_us_ = monotonic_us() + std::int64_t{patience_ms_} * 1000;

    Block block{operation, transaction_};
    block.parameter_count = std::min(parameters.size(), kMostParameters);
    std::copy_n(parameters.begin(), block.parameter_count, block.parameters.begin());
    std::array<std::byte, kMostBlockBytes> room;
    const std::size_t bytes = write_block(ContainerType::kCommand, block, room);
    return pipe_.send(std::span{room}.first(bytes), patience_ms_);
}

Status Conversation::give(std::span<const std::byte> payload)
{
    if (payload.size() > room_bytes_ - kHeaderBytes)
        return failure(Fault::kSoftware, "%zu bytes are more than go to a device at once", payload.size());
    const std::span room{room_.get(), kHeaderBytes + payload.size()};
    write_header(data_header(operation_, transaction_, payload.size()), room.first<kHeaderBytes>());
    std::ranges::copy(payload, room.begin() + kHeaderBytes);
    return pipe_.send(room, patience_ms_);
}

Status Conversation::fill(std::size_t ask)
{
    if (monotonic_us() > deadline_us_)
        return failure(Fault::kTryAgain, "the device is too slow");
    const std::size_t room = std::min(whole_packets(ask), room_bytes_);
    const UsbPipe::Piece piece = TRY(pipe_.receive({room_.get(), room}, patience_ms_));
    at_ = 0;
    filled_ = std::min(piece.bytes, room);
    ended_ = piece.ended;
    return {};
}

/// An empty packet behind data of whole packets may come, or not.
Status Conversation::fill_container(std::size_t ask)
{
    if (held().empty())
        TRY(fill(ask));
    if (held().empty())
        TRY(fill(ask));
    if (held().size() < kHeaderBytes)
        return failure(Fault::kBadData, "the device sent %zu bytes where a header has %zu", held().size(),
                       kHeaderBytes);
    return {};
}

Result<std::uint64_t> Conversation::await_data(std::size_t expected, std::uint64_t most)
{
    const std::size_t likely = std::min(expected, room_bytes_ - kHeaderBytes) + kHeaderBytes;
    TRY(fill_container(expected == 0 ? kUsualBytes : likely));
    const Header header = *read_header(held());
    if (header.is(ContainerType::kResponse)) {
        TRY(read_response());
        return std::uint64_t{0};
    }
    if (!header.is(ContainerType::kData) || header.code != operation_ || header.transaction != transaction_)
        return failure(Fault::kBadData, "the device answered operation %04X of transaction %u by kind %u, %04X of %u",
                       operation_, transaction_, header.type, header.code, header.transaction);
    const std::uint32_t length = header.length;
    if (length < kHeaderBytes || length - kHeaderBytes > most)
        return failure(Fault::kBadData, "the device announced %u bytes where it may send %llu", length,
                       static_cast<unsigned long long>(most + kHeaderBytes));
    data_left_ = length - kHeaderBytes;
    at_ += kHeaderBytes;
    deadline_us_ += static_cast<std::int64_t>(data_left_) * 1000 / kSlowestBytesPerMs;
    // Some devices send the header in a packet of its own.
    if (ended_ && held().size() < data_left_ && !held().empty())
        return cut_short();
    return data_left_;
}

Status Conversation::cut_short()
{
    const std::uint64_t missing = data_left_ - held().size();
    at_ = filled_;
    data_left_ = 0;
    ended_early_ = true;
    return failure(Fault::kBadData, "the device sent %llu bytes less than it announced",
                   static_cast<unsigned long long>(missing));
}

Result<std::size_t> Conversation::take(std::span<std::byte> into)
{
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(into.size(), data_left_));
    std::size_t got = 0;
    while (got < wanted) {
        if (held().empty()) {
            const auto rest = static_cast<std::size_t>(std::min<std::uint64_t>(data_left_, room_bytes_));
            TRY(fill(rest));
            if (ended_ && held().size() < data_left_)
                return cut_short();
        }
        const auto part = held().first(std::min(held().size(), wanted - got));
        std::memcpy(into.data() + got, part.data(), part.size());
        at_ += part.size();
        got += part.size();
        data_left_ -= part.size();
    }
    return got;
}

Status Conversation::read_response()
{
    const std::optional<Block> block = read_block(ContainerType::kResponse, held());
    if (!block || block->transaction != transaction_ || block->code == 0)
        return failure(Fault::kBadData, "the device ended transaction %u of operation %04X by nonsense", transaction_,
                       operation_);
    at_ = filled_;
    response_ = block->code;
    return {};
}

Result<std::uint16_t> Conversation::finish()
{
    if (response_ == 0) {
        TRY(fill_container(kPacketMost));
        TRY(read_response());
    }
    return response_;
}

Status Conversation::drain(int patience_ms)
{
    at_ = filled_ = 0;
    data_left_ = 0;
    for (int pieces = 0; pieces < kMostDrained; ++pieces) {
        const Result<UsbPipe::Piece> piece = pipe_.receive({room_.get(), room_bytes_}, patience_ms);
        if (!piece.ok())
            return piece.status().fault() == Fault::kUnavailable || piece.status().fault() == Fault::kUsage
                       ? piece.status()
                       : Status{};
    }
    return {};
}

} // namespace dicot::mtp
