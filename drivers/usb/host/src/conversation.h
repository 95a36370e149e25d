// Containers on a pipe: one transaction after the other, nothing believed.
#pragma once

#include "dicot/mtp/container.h"
#include "dicot/mtp_host/usb_pipe.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace dicot::mtp {

/// Command, data in or out, response (PTP over USB: still image 1.0, clause 7). A failure leaves the transaction
/// broken: nothing but drain() may follow.
class Conversation
{
public:
    Conversation(UsbPipe& pipe, std::size_t room_bytes, int patience_ms);

    /// The number of the transaction that is under way, or was.
    std::uint32_t transaction() const noexcept { return transaction_; }
    /// Numbers begin anew: the next transaction has number 0, as OpenSession wants it.
    void begin_session() noexcept { next_ = 0; }

    void be_patient(int patience_ms) noexcept { patience_ms_ = patience_ms; }

    Status command(std::uint16_t operation, std::span<const std::uint32_t> parameters);
    /// The data phase to the device; no longer than the room.
    Status give(std::span<const std::byte> payload);
    /// Waits for data or, where the device has none to give, for the response; `expected`: how much data is likely.
    /// How many bytes of data there are. kBadData: more than `most`, or nonsense.
    Result<std::uint64_t> await_data(std::size_t expected, std::uint64_t most);
    /// The next bytes of the data, all of `into`, or those that are left.
    Result<std::size_t> take(std::span<std::byte> into);
    /// await_data() or take() failed because the data ended early, and not the transaction: finish() has what the
    /// device says of it.
    bool ended_early() const noexcept { return ended_early_; }
    std::uint64_t data_left() const noexcept { return data_left_; }
    /// The response code; the data must have been taken.
    Result<std::uint16_t> finish();
    /// Throws away what the device still sends, as much and as long as is bounded here; kUnavailable: it is gone.
    Status drain(int patience_ms);

private:
    Status fill(std::size_t ask);
    Status fill_container(std::size_t ask);
    Status read_response();
    Status cut_short();
    std::span<const std::byte> held() const noexcept { return {room_.get() + at_, filled_ - at_}; }

    UsbPipe& pipe_;
    std::size_t room_bytes_;
    int patience_ms_;
    std::unique_ptr<std::byte[]> room_;
    std::size_t at_ = 0, filled_ = 0; ///< what came and was not looked at yet
    bool ended_ = false;              ///< the transfer that filled the room last

    std::uint32_t next_ = 0, transaction_ = 0;
    std::uint16_t operation_ = 0;
    std::uint64_t data_left_ = 0;
    bool ended_early_ = false;
    std::int64_t deadline_us_ = 0;
    std::uint16_t response_ = 0; ///< 0: not here yet
};

} // namespace dicot::mtp
