#include "stream.h"

#include "dicot/os/clock.h"

#include <algorithm>
#include <cerrno>
#include <chrono>

namespace dicot {
namespace {

/// So many transfers in a row without one success end the stream: a quarter of a second at high speed.
constexpr int kMostFailures = 64;

std::size_t packets_of(const UvcAlternate& setting) noexcept
{
    const std::size_t fit = UvcStream::kMostIsoBytes / std::max<std::size_t>(setting.setting.bytes_per_interval, 1);
    return std::clamp<std::size_t>(fit, 1, UvcStream::kMostPackets);
}

/// Of one transfer. A bulk transfer holds a whole payload where it can, so that its end is the payload's end.
std::size_t transfer_bytes(const UvcAlternate& setting, std::size_t payload_bytes) noexcept
{
    if (!setting.bulk)
        return packets_of(setting) * setting.setting.bytes_per_interval;
    const std::size_t packet = std::max<std::size_t>(setting.setting.bytes_per_interval, 1);
    const std::size_t most = std::max(UvcStream::kMostBulkBytes / packet, std::size_t{1}) * packet;
    return payload_bytes == 0 ? most : std::min((payload_bytes + packet - 1) / packet * packet, most);
}

} // namespace

UvcStream::~UvcStream()
{
    for (libusb_transfer* transfer : transfers_)
        if (transfer != nullptr)
            libusb_free_transfer(transfer);
}

std::size_t UvcStream::buffer_bytes(const UvcDevice& device) noexcept
{
    std::size_t most = 0;
    for (const UvcAlternate& setting : device.settings())
        most = std::max(most, transfer_bytes(setting, 0));
    return kTransfers * most;
}

Status UvcStream::make(std::span<std::byte> memory) noexcept
{
    memory_ = memory;
    transfer_room_ = memory.size() / kTransfers;
    for (libusb_transfer*& transfer : transfers_) {
        transfer = libusb_alloc_transfer(kMostPackets);
        if (transfer == nullptr)
            return failure(Fault::kOsError, "the system has no memory for USB transfers");
    }
    return {};
}

void UvcStream::fill(libusb_transfer& transfer, UsbPort& port, const Plan& plan, std::size_t index) noexcept
{
    const std::size_t bytes = transfer_bytes(plan.setting, plan.payload_bytes);
    auto* const buffer = reinterpret_cast<unsigned char*>(memory_.data() + index * transfer_room_);
    if (plan.setting.bulk) {
        libusb_fill_bulk_transfer(&transfer, port.handle(), plan.setting.endpoint, buffer, static_cast<int>(bytes),
                                  &on_done, this, 0);
        transfer.num_iso_packets = 0;
        return;
    }
    libusb_fill_iso_transfer(&transfer, port.handle(), plan.setting.endpoint, buffer, static_cast<int>(bytes),
                             static_cast<int>(packets_of(plan.setting)), &on_done, this, 0);
    libusb_set_iso_packet_lengths(&transfer, plan.setting.setting.bytes_per_interval);
}

Status UvcStream::begin(UsbPort& port, const Plan& plan) noexcept
{
    if (transfer_bytes(plan.setting, plan.payload_bytes) > transfer_room_)
        return failure(Fault::kUnavailable,
                       "the camera at USB port %s wants larger transfers than it did when it was opened", port.name());
    assembler_.restart(plan.rules);
    packet_us_ = plan.packet_us;
    ring_.begin(plan.mode);
    slot_ = -1;
    {
        const std::lock_guard lock(mutex_);
        stopping_ = false;
        trouble_ = Trouble::kNone;
        failures_ = 0;
    }
    running_ = true;
    for (std::size_t i = 0; i < transfers_.size(); ++i) {
        fill(*transfers_[i], port, plan, i);
        int error = 0;
        bool full = false;
        {
            const std::lock_guard lock(mutex_);
            errno = 0;
            error = libusb_submit_transfer(transfers_[i]);
            full = error != 0 && errno == ENOSPC;
            in_flight_ += error == 0 ? 1 : 0;
        }
        if (error == 0)
            continue;
        TRY(end());
        if (full)
            return failure(
                Fault::kTryAgain,
                "the bus of USB port %s has no bandwidth left for %u bytes an interval; ask for a lower rate, a "
                "smaller picture or MJPEG, or plug the cameras into different buses",
                port.name(), plan.setting.setting.bytes_per_interval);
        return usb_failure(port.name(), "begin to stream", error);
    }
    return {};
}

Status UvcStream::end() noexcept
{
    if (!running_)
        return {};
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    // From here on nothing is sent off again; what is not in flight answers that it is not found.
    for (libusb_transfer* transfer : transfers_)
        libusb_cancel_transfer(transfer);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds{kEndMs};
    std::unique_lock lock(mutex_);
    if (!landed_.wait_until(lock, deadline, [this] { return in_flight_ == 0; }))
        return failure(Fault::kOsError, "%d USB transfers did not come back within %d ms of being cancelled",
                       in_flight_, kEndMs);
    lock.unlock();
    running_ = false;
    ring_.end();
    return {};
}

UvcStream::Trouble UvcStream::trouble() noexcept
{
    const std::lock_guard lock(mutex_);
    return trouble_;
}

int UvcStream::in_flight() noexcept
{
    const std::lock_guard lock(mutex_);
    return in_flight_;
}

void LIBUSB_CALL UvcStream::on_done(libusb_transfer* transfer) noexcept
{
    static_cast<UvcStream*>(transfer->user_data)->done(*transfer);
}

void UvcStream::done(libusb_transfer& transfer) noexcept
{
    const std::int64_t now_us = monotonic_us();
    Trouble trouble = Trouble::kNone;
    bool failed = false;
    switch (transfer.status) {
    case LIBUSB_TRANSFER_COMPLETED:
        if (transfer.num_iso_packets > 0)
            take_packets(transfer, now_us);
        else
            take_bulk(transfer, now_us);
        break;
    case LIBUSB_TRANSFER_CANCELLED:
        break;
    case LIBUSB_TRANSFER_NO_DEVICE:
        trouble = Trouble::kGone;
        break;
    case LIBUSB_TRANSFER_STALL:
        trouble = Trouble::kStalled;
        break;
    case LIBUSB_TRANSFER_OVERFLOW:
        assembler_.lose("more bytes than a payload may have");
        failed = true;
        break;
    case LIBUSB_TRANSFER_ERROR:
    case LIBUSB_TRANSFER_TIMED_OUT:
        assembler_.lose("lost transfer");
        failed = true;
        break;
    }

    bool last_one = false;
    {
        const std::lock_guard lock(mutex_);
        failures_ = failed ? failures_ + 1 : 0;
        if (failures_ >= kMostFailures)
            trouble = Trouble::kFailing;
        if (trouble != Trouble::kNone && trouble_ != Trouble::kGone)
            trouble_ = trouble;
        if (!stopping_ && trouble_ == Trouble::kNone) {
            const int error = libusb_submit_transfer(&transfer);
            if (error == 0)
                return;
            trouble_ = error == LIBUSB_ERROR_NO_DEVICE ? Trouble::kGone : Trouble::kFailing;
        }
        last_one = in_flight_ == 1;
    }
    if (last_one)
        give_up_frame();
    // Behind this lock end() may return and everything may go away.
    const std::lock_guard lock(mutex_);
    --in_flight_;
    landed_.notify_all();
}

void UvcStream::take_packets(libusb_transfer& transfer, std::int64_t now_us) noexcept
{
    const auto count = static_cast<std::size_t>(transfer.num_iso_packets);
    const std::size_t stride = transfer.iso_packet_desc[0].length;
    const auto* const bytes = reinterpret_cast<const std::byte*>(transfer.buffer);
    for (std::size_t i = 0; i < count; ++i) {
        const libusb_iso_packet_descriptor& packet = transfer.iso_packet_desc[i];
        if (packet.status != LIBUSB_TRANSFER_COMPLETED) {
            assembler_.lose("lost packet");
            continue;
        }
        // The transfer is reported when its last packet has come; the others came one interval earlier each.
        const std::int64_t arrival_us = now_us - static_cast<std::int64_t>(count - 1 - i) * packet_us_;
        feed({bytes + i * stride, std::min<std::size_t>(packet.actual_length, stride)}, true, arrival_us);
    }
}

void UvcStream::take_bulk(libusb_transfer& transfer, std::int64_t now_us) noexcept
{
    const auto got = static_cast<std::size_t>(std::clamp(transfer.actual_length, 0, transfer.length));
    feed({reinterpret_cast<const std::byte*>(transfer.buffer), got}, transfer.actual_length < transfer.length, now_us);
}

void UvcStream::feed(std::span<const std::byte> bytes, bool last, std::int64_t arrival_us) noexcept
{
    for (int round = 0; round < 2; ++round) {
        if (slot_ < 0 && !assembler_.under_way() && !bytes.empty()) {
            slot_ = ring_.take_free();
            assembler_.use(ring_.room(slot_));
        }
        const FrameAssembler::Fed fed = assembler_.feed(bytes, last, arrival_us);
        if (fed != FrameAssembler::Fed::kMore)
            hand_over();
        if (fed != FrameAssembler::Fed::kClosedBefore)
            return;
    }
}

void UvcStream::hand_over() noexcept
{
    if (slot_ >= 0)
        ring_.publish(slot_, assembler_.closed());
    else
        ring_.miss();
    slot_ = -1;
}

void UvcStream::give_up_frame() noexcept
{
    if (assembler_.cancel(trouble() == Trouble::kGone ? "the camera went away" : "the stream was stopped") ==
        FrameAssembler::Fed::kClosed)
        hand_over();
    ring_.end();
}

} // namespace dicot
