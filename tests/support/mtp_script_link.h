// A cable whose other end is a list: packets of 512 bytes, as a high-speed bulk endpoint has them.
#pragma once

#include "dicot/mtp/device_link.h"

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

namespace dicot::test {

class ScriptLink final : public mtp::DeviceLink
{
public:
    using Bytes = std::vector<std::byte>;
    static constexpr std::size_t kPacket = 512;

    /// One transfer of the host; where it is a multiple of the packet, nothing marks its end (say({}) does).
    void say(const Bytes& transfer)
    {
        std::size_t at = 0;
        do {
            const std::size_t size = std::min(kPacket, transfer.size() - at);
            packets_.emplace_back(transfer.begin() + static_cast<std::ptrdiff_t>(at),
                                  transfer.begin() + static_cast<std::ptrdiff_t>(at + size));
            at += size;
        } while (at < transfer.size());
    }
    bool all_taken() const { return packets_.empty(); }

    /// What the host got since the last call, transfer by transfer.
    std::vector<Bytes> take_sent()
    {
        while (!under_way_.empty())
            land();
        return std::exchange(sent_, {});
    }
    /// What came of the transfer that was last given up.
    const Bytes& unfinished() const { return unfinished_; }
    std::vector<Bytes> events;

    int cancel_at_send = -1; ///< this call from now on, 0 the next: the host cancels
    int unplug_at_send = -1;
    bool reset_with_cancel = false;
    int idle_times = 0;  ///< times that the host is silent, but there, before it is gone
    int wrong_parts = 0; ///< parts before the last that are no multiple of the packet
    int begun = 0, ended = 0;
    int sends = 0;

    Result<std::size_t> receive(std::span<std::byte> into, int patience_ms) override
    {
        if (packets_.empty() && patience_ms >= 0 && idle_times-- > 0)
            return failure(Fault::kTryAgain, "silence");
        std::size_t got = 0;
        while (got < into.size()) {
            if (packets_.empty())
                return failure(Fault::kUnavailable, "unplugged");
            const Bytes packet = std::move(packets_.front());
            packets_.pop_front();
            std::copy(packet.begin(), packet.end(), into.begin() + static_cast<std::ptrdiff_t>(got));
            got += packet.size();
            if (packet.size() < kPacket)
                break;
        }
        return got;
    }

    Status send(std::span<const std::byte> bytes, bool last) override
    {
        ++sends;
        wrong_parts += !last && bytes.size() % kPacket != 0;
        if (unplug_at_send >= 0 && unplug_at_send-- == 0)
            return give_up(Fault::kUnavailable);
        if (cancel_at_send >= 0 && cancel_at_send-- == 0) {
            interrupted_ = true;
            reset_ = reset_with_cancel;
            return give_up(Fault::kIoError);
        }
        // As late as the interface allows: whoever changes bytes too early sends wrong ones.
        while (under_way_.size() >= kMostUnderWay)
            land();
        under_way_.push_back({bytes, last});
        return {};
    }

    void post_event(std::span<const std::byte> container) override
    {
        events.emplace_back(container.begin(), container.end());
    }
    bool interrupted() const override { return interrupted_; }
    void begin_transaction(std::uint32_t) override
    {
        ++begun;
        interrupted_ = false;
    }
    void end_transaction() override
    {
        ++ended;
        interrupted_ = false;
    }
    bool take_reset() override { return std::exchange(reset_, false); }
    void reset() { reset_ = true; }

private:
    struct Part
    {
        std::span<const std::byte> bytes;
        bool last;
    };
    void land()
    {
        const Part part = under_way_.front();
        under_way_.pop_front();
        current_.insert(current_.end(), part.bytes.begin(), part.bytes.end());
        if (part.last)
            sent_.push_back(std::exchange(current_, {}));
    }
    Status give_up(Fault fault)
    {
        while (!under_way_.empty())
            land();
        unfinished_ = std::exchange(current_, {});
        return failure(fault, "%s", fault == Fault::kIoError ? "cancelled" : "unplugged");
    }

    std::deque<Bytes> packets_;
    std::deque<Part> under_way_;
    std::vector<Bytes> sent_;
    Bytes current_, unfinished_;
    bool interrupted_ = false, reset_ = false;
};

} // namespace dicot::test
