#include "dicot/mtp/exchange.h"

#include "dicot/mtp/codes.h"

#include <algorithm>

namespace dicot::mtp {
namespace {

constexpr std::size_t kPacketBytes = 512;
constexpr int kForever = -1;

std::size_t whole_packets(std::size_t bytes) noexcept
{
    return (bytes + kPacketBytes - 1) / kPacketBytes * kPacketBytes;
}

} // namespace

Exchange::Exchange(DeviceLink& link, std::span<std::byte> room) noexcept : link_(link), room_(room) {}

std::span<std::byte> Exchange::piece() const noexcept
{
    return room_.subspan(piece_ * kPieceBytes, kPieceBytes);
}

std::span<std::byte> Exchange::inbox() const noexcept
{
    return room_.subspan(kPieces * kPieceBytes, kPieceBytes);
}

void Exchange::forget() noexcept
{
    next_command_.reset();
    fault_ = {};
}

const Status& Exchange::fault() noexcept
{
    if (fault_.ok() && link_.interrupted())
        fault_ = failure(Fault::kIoError, "the host cancelled the transaction");
    return fault_;
}

Result<Exchange::Came> Exchange::next(int patience_ms)
{
    fault_ = {};
    if (next_command_) {
        command_ = *next_command_;
        next_command_.reset();
        return Came::kCommand;
    }
    const std::span<std::byte> into = inbox().first(kPacketBytes);
    const auto bytes = into.first(std::min(TRY(link_.receive(into, patience_ms)), into.size()));
    if (const std::optional<Block> block = read_block(ContainerType::kCommand, bytes)) {
        command_ = *block;
        return Came::kCommand;
    }
    const std::optional<Header> header = read_header(bytes);
    if (!header)
        return Came::kNothing;
    if (header->is(ContainerType::kCommand)) {
        command_ = {0, header->transaction, {}, 0};
        return Came::kBroken;
    }
    if (header->is(ContainerType::kData)) {
        pass_over(*header, bytes.size());
        if (!fault().ok())
            return fault_;
    }
    return Came::kNothing;
}

Result<std::size_t> Exchange::receive(std::size_t at, std::size_t bytes)
{
    const std::span<std::byte> into = inbox().subspan(at, bytes);
    Result<std::size_t> got = link_.receive(into, kForever);
    if (!got.ok())
        fault_ = got.status();
    else
        got.value() = std::min(got.value(), bytes);
    return got;
}

void Exchange::pass_over(const Header& header, std::size_t came)
{
    const std::uint64_t end = header.length == kUnknownLength ? UINT64_MAX : header.length;
    std::uint64_t total = came;
    bool more = came == kPacketBytes;
    while (more && total < end) {
        const std::size_t asked =
            whole_packets(static_cast<std::size_t>(std::min<std::uint64_t>(end - total, kPieceBytes)));
        const Result<std::size_t> got = receive(0, asked);
        if (!got.ok())
            return;
        total += got.value();
        more = got.value() == asked;
    }
}

std::uint16_t Exchange::take_data(std::size_t most_bytes, std::span<const std::byte>& data)
{
    std::size_t total = 0;
    while (total == 0) { // packets of none may still end an earlier transfer
        const Result<std::size_t> got = receive(0, kPacketBytes);
        if (!got.ok())
            return 0;
        total = got.value();
    }
    const std::span<const std::byte> bytes = inbox().first(total);
    next_command_ = read_block(ContainerType::kCommand, bytes);
    if (next_command_)
        return 0;
    const std::optional<Header> header = read_header(bytes);
    if (!header || !header->is(ContainerType::kData))
        return response::kInvalidDataset;
    const bool ours = header->code == command_.code && header->transaction == command_.transaction;
    const std::size_t most = std::min(most_bytes, kPieceBytes - kHeaderBytes) + kHeaderBytes;
    if (!ours || header->length < kHeaderBytes || header->length > most) {
        pass_over(*header, total);
        return !fault_.ok() ? 0 : ours ? response::kInvalidDataset : response::kInvalidTransactionId;
    }
    for (bool more = total == kPacketBytes; more && total < header->length;) {
        const std::size_t asked = whole_packets(header->length - total);
        const Result<std::size_t> got = receive(total, asked);
        if (!got.ok())
            return 0;
        total += got.value();
        more = got.value() == asked;
    }
    if (total != header->length)
        return total < header->length ? response::kIncompleteTransfer : response::kInvalidDataset;
    data = inbox().subspan(kHeaderBytes, total - kHeaderBytes);
    return response::kOk;
}

void Exchange::begin_data(std::uint64_t bytes) noexcept
{
    write_header(data_header(command_.code, command_.transaction, bytes), piece().first<kHeaderBytes>());
    used_ = kHeaderBytes;
    left_ = bytes;
    left_already_ = false;
}

std::span<std::byte> Exchange::place() noexcept
{
    const std::size_t room = kPieceBytes - used_;
    return piece().subspan(used_, static_cast<std::size_t>(std::min<std::uint64_t>(room, left_)));
}

Status Exchange::filled(std::size_t bytes)
{
    used_ += bytes;
    left_ -= bytes;
    // The last piece waits for end_data(), even if it is full.
    return used_ == kPieceBytes && left_ > 0 ? flush(false) : Status{};
}

Status Exchange::write(std::span<const std::byte> bytes) noexcept
{
    while (!bytes.empty()) {
        if (left_ == 0)
            return failure(Fault::kSoftware, "more data for the cable than was announced");
        const std::span<std::byte> into = place();
        const std::size_t count = std::min(into.size(), bytes.size());
        std::copy_n(bytes.begin(), count, into.begin());
        bytes = bytes.subspan(count);
        TRY(filled(count));
    }
    return {};
}

bool Exchange::take_back() noexcept
{
    if (left_already_)
        return false;
    used_ = 0;
    left_ = 0;
    return true;
}

bool Exchange::end_data()
{
    const bool whole = left_ == 0;
    left_ = 0;
    return flush(true).ok() && whole;
}

void Exchange::respond(const Block& response)
{
    used_ = write_block(ContainerType::kResponse, response, piece().first<kMostBlockBytes>());
    static_cast<void>(flush(true));
}

Status Exchange::flush(bool last)
{
    const std::size_t bytes = used_;
    used_ = 0;
    left_already_ = true;
    if (!fault().ok())
        return fault_;
    fault_ = link_.send(piece().first(bytes), last);
    if (!fault_.ok())
        return fault_;
    bytes_sent_ += bytes;
    piece_ = (piece_ + 1) % kPieces;
    return {};
}

} // namespace dicot::mtp
