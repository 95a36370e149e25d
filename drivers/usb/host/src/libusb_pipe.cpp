#include "dicot/mtp_host/usb_pipe.h"

#include "usb_claim.h"

#include "dicot/os/clock.h"

#include <algorithm>
#include <array>
#include <climits>

namespace dicot::mtp {
namespace {

constexpr int kLookAroundMs = 200; ///< how long a wait lasts at most before somebody is asked whether to end it
constexpr int kCancelMs = 500;     ///< a transfer that was called back comes back in a millisecond or so
constexpr unsigned kRequestMs = 1000;

enum ClassRequest : std::uint8_t
{
    kCancelRequest = 0x64,
    kDeviceReset = 0x66,
    kGetDeviceStatus = 0x67,
};
constexpr std::uint16_t kCancellation = 0x4001;
constexpr std::uint8_t kOut = 0x21, kIn = 0xA1; ///< bmRequestType: of the class, to the interface

/// One transfer under way, at most.
class LibusbPipe final : public UsbPipe
{
public:
    LibusbPipe(UsbClaim claim, StopAsked stop) noexcept : claim_(std::move(claim)), stop_(stop) {}
    ~LibusbPipe() override
    {
        if (transfer_ != nullptr && !lost_)
            libusb_free_transfer(transfer_);
    }

    Status begin()
    {
        transfer_ = libusb_alloc_transfer(0);
        return transfer_ != nullptr ? Status{} : failure(Fault::kOsError, "no memory for USB transfers");
    }

    std::size_t packet_bytes() const override { return claim_.listed().packet_bytes; }
    Status send(std::span<const std::byte> bytes, int patience_ms) override;
    Result<Piece> receive(std::span<std::byte> into, int patience_ms) override;
    Status cancel(std::uint32_t transaction) override;
    Status reset() override { return request(kOut, kDeviceReset, {}).status(); }
    Result<std::uint16_t> status() override;
    void clear_halts() override;

private:
    struct Outcome
    {
        std::size_t bytes = 0;
        bool patience_ran_out = false;
    };
    Result<Outcome> transfer(std::uint8_t endpoint, std::byte* bytes, std::size_t count, std::uint8_t flags,
                             int patience_ms);
    Status await(int patience_ms, bool& called_back);
    Result<std::size_t> request(std::uint8_t type, ClassRequest what, std::span<std::byte> data);
    static void LIBUSB_CALL done(libusb_transfer* transfer) { *static_cast<int*>(transfer->user_data) = 1; }

    UsbClaim claim_;
    StopAsked stop_;
    libusb_transfer* transfer_ = nullptr;
    int completed_ = 0;
    bool lost_ = false; ///< the kernel never gave the transfer back
};

/// Until the transfer is back: by itself, or called back.
Status LibusbPipe::await(int patience_ms, bool& called_back)
{
    const std::int64_t until_us = monotonic_us() + std::int64_t{patience_ms} * 1000;
    std::int64_t lost_us = INT64_MAX;
    bool stopped = false;
    called_back = false;
    while (completed_ == 0) {
        const std::int64_t now_us = monotonic_us();
        if (now_us >= lost_us) {
            lost_ = true;
            return claim_.failure_of(LIBUSB_ERROR_NO_DEVICE, "a transfer does not come back");
        }
        stopped = stopped || (stop_ != nullptr && stop_());
        if (!called_back && (stopped || now_us >= until_us)) {
            called_back = true;
            lost_us = now_us + std::int64_t{kCancelMs} * 1000;
            libusb_cancel_transfer(transfer_);
        }
        const std::int64_t rest_us = std::clamp<std::int64_t>((called_back ? lost_us : until_us) - now_us, 0,
                                                              std::int64_t{kLookAroundMs} * 1000);
        timeval nap{0, static_cast<suseconds_t>(rest_us)};
        libusb_handle_events_timeout_completed(claim_.context(), &nap, &completed_);
    }
    if (stopped)
        return failure(Fault::kUsage, "the device at USB port %s: somebody asked for the end",
                       claim_.listed().port.c_str());
    return {};
}

Result<LibusbPipe::Outcome> LibusbPipe::transfer(std::uint8_t endpoint, std::byte* bytes, std::size_t count,
                                                 std::uint8_t flags, int patience_ms)
{
    if (lost_)
        return claim_.failure_of(LIBUSB_ERROR_NO_DEVICE, "a transfer did not come back");
    libusb_fill_bulk_transfer(transfer_, claim_.handle(), endpoint, reinterpret_cast<unsigned char*>(bytes),
                              static_cast<int>(std::min<std::size_t>(count, INT_MAX)), &done, &completed_, 0);
    transfer_->flags = flags;
    completed_ = 0;
    if (const int error = libusb_submit_transfer(transfer_); error != 0)
        return claim_.failure_of(error, "a transfer");
    bool called_back = false;
    TRY(await(patience_ms, called_back));
    const auto moved = static_cast<std::size_t>(std::max(transfer_->actual_length, 0));
    switch (transfer_->status) {
    case LIBUSB_TRANSFER_COMPLETED:
        return Outcome{moved, false};
    case LIBUSB_TRANSFER_CANCELLED:
    case LIBUSB_TRANSFER_TIMED_OUT:
        if (moved == 0)
            return claim_.failure_of(LIBUSB_ERROR_TIMEOUT, "a transfer");
        return Outcome{moved, true};
    case LIBUSB_TRANSFER_NO_DEVICE:
        return claim_.failure_of(LIBUSB_ERROR_NO_DEVICE, "a transfer");
    case LIBUSB_TRANSFER_STALL:
        return claim_.failure_of(LIBUSB_ERROR_PIPE, "a transfer");
    case LIBUSB_TRANSFER_OVERFLOW:
        return claim_.failure_of(LIBUSB_ERROR_OVERFLOW, "a transfer");
    case LIBUSB_TRANSFER_ERROR:
        break;
    }
    return claim_.failure_of(LIBUSB_ERROR_IO, "a transfer");
}

Status LibusbPipe::send(std::span<const std::byte> bytes, int patience_ms)
{
    // libusb does not write to what goes out.
    auto* const first = const_cast<std::byte*>(bytes.data());
    const Outcome sent =
        TRY(transfer(claim_.listed().bulk_out, first, bytes.size(), LIBUSB_TRANSFER_ADD_ZERO_PACKET, patience_ms));
    if (sent.bytes != bytes.size())
        return failure(Fault::kIoError, "the device at USB port %s took %zu bytes of %zu", claim_.listed().port.c_str(),
                       sent.bytes, bytes.size());
    return {};
}

Result<UsbPipe::Piece> LibusbPipe::receive(std::span<std::byte> into, int patience_ms)
{
    const Outcome got = TRY(transfer(claim_.listed().bulk_in, into.data(), into.size(), 0, patience_ms));
    return Piece{got.bytes, !got.patience_ran_out && got.bytes < into.size()};
}

Result<std::size_t> LibusbPipe::request(std::uint8_t type, ClassRequest what, std::span<std::byte> data)
{
    if (lost_)
        return claim_.failure_of(LIBUSB_ERROR_NO_DEVICE, "a request");
    const int got = libusb_control_transfer(claim_.handle(), type, what, 0, claim_.listed().interface,
                                            reinterpret_cast<unsigned char*>(data.data()),
                                            static_cast<std::uint16_t>(data.size()), kRequestMs);
    if (got < 0)
        return claim_.failure_of(got, "a request");
    return static_cast<std::size_t>(got);
}

Status LibusbPipe::cancel(std::uint32_t transaction)
{
    std::array<std::byte, 6> words;
    const auto put = [&](std::size_t at, std::uint32_t value) {
        words[at] = static_cast<std::byte>(value & 0xFF);
        words[at + 1] = static_cast<std::byte>(value >> 8 & 0xFF);
    };
    put(0, kCancellation);
    put(2, transaction);
    put(4, transaction >> 16);
    return request(kOut, kCancelRequest, words).status();
}

Result<std::uint16_t> LibusbPipe::status()
{
    std::array<std::byte, 32> words{}; // length, code, endpoints that are halted
    const std::size_t got = TRY(request(kIn, kGetDeviceStatus, words));
    if (got < 4)
        return failure(Fault::kIoError, "the device at USB port %s tells no status", claim_.listed().port.c_str());
    return static_cast<std::uint16_t>(std::to_integer<unsigned>(words[2]) | std::to_integer<unsigned>(words[3]) << 8);
}

void LibusbPipe::clear_halts()
{
    if (lost_)
        return;
    libusb_clear_halt(claim_.handle(), claim_.listed().bulk_in);
    libusb_clear_halt(claim_.handle(), claim_.listed().bulk_out);
}

} // namespace

Result<std::unique_ptr<UsbPipe>> open_usb_pipe(const MtpListed& listed, StopAsked stop)
{
    UsbClaim claim = TRY(UsbClaim::take(listed));
    auto pipe = std::make_unique<LibusbPipe>(std::move(claim), stop);
    TRY(pipe->begin());
    return std::unique_ptr<UsbPipe>{std::move(pipe)};
}

} // namespace dicot::mtp
