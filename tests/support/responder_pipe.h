// The computer's and the board's side of the cable, joined in one thread: what one sends, the other gets.
#pragma once

#include "mtp_memory_shelf.h"
#include "mtp_script_link.h"

#include "dicot/mtp/responder.h"
#include "dicot/mtp_host/usb_pipe.h"

#include <deque>
#include <functional>
#include <memory>
#include <vector>

namespace dicot::test {

class ResponderPipe final : public mtp::UsbPipe
{
public:
    explicit ResponderPipe(mtp::ObjectSource& objects)
        : room_(mtp::Responder::kRoomBytes), responder_(objects, link_, {"dicot", "board", "1", "S7", "bench-3"}, room_)
    {
    }

    /// It does not say that it is a board of ours.
    bool disguised = false;
    int unplug_at_receive = -1; ///< 0: the next one
    int break_at_receive = -1;  ///< the device halts its endpoint there, once
    std::function<void()> when_reset = [] {};

    std::size_t packet_bytes() const override { return ScriptLink::kPacket; }
    Status send(std::span<const std::byte> bytes, int) override
    {
        link_.say({bytes.begin(), bytes.end()});
        if (bytes.size() % ScriptLink::kPacket == 0)
            link_.say({});
        return {};
    }
    Result<Piece> receive(std::span<std::byte> into, int) override
    {
        if (unplug_at_receive >= 0 && unplug_at_receive-- == 0)
            return failure(Fault::kUnavailable, "unplugged");
        if (break_at_receive >= 0 && break_at_receive-- == 0)
            return failure(Fault::kIoError, "halted");
        while (answers_.empty()) {
            if (link_.all_taken())
                return failure(Fault::kTryAgain, "silence");
            const Status served = responder_.serve_one();
            if (!served.ok())
                return served;
            for (ScriptLink::Bytes& transfer : link_.take_sent())
                answers_.push_back(disguised ? disguise(std::move(transfer)) : std::move(transfer));
        }
        ScriptLink::Bytes& next = answers_.front();
        const std::size_t count = std::min(into.size(), next.size());
        std::copy_n(next.begin(), count, into.begin());
        next.erase(next.begin(), next.begin() + static_cast<std::ptrdiff_t>(count));
        const bool ended = count < into.size();
        if (ended || (next.empty() && count % ScriptLink::kPacket != 0))
            answers_.pop_front();
        return Piece{count, ended};
    }
    Status cancel(std::uint32_t) override { return {}; }
    Status reset() override
    {
        answers_.clear();
        link_.reset();
        when_reset();
        return {};
    }
    Result<std::uint16_t> status() override { return std::uint16_t{0x2001}; }
    void clear_halts() override {}

    const mtp::ResponderCounts& counts() const { return responder_.counts(); }

private:
    static ScriptLink::Bytes disguise(ScriptLink::Bytes bytes)
    {
        constexpr unsigned char kDicot[] = {'d', 0, 'i', 0, 'c', 0, 'o', 0, 't', 0, '.', 0};
        const auto same = [](std::byte a, unsigned char b) { return std::to_integer<unsigned char>(a) == b; };
        const auto found = std::search(bytes.begin(), bytes.end(), std::begin(kDicot), std::end(kDicot), same);
        if (found != bytes.end())
            *found = std::byte{'p'};
        return bytes;
    }

    ScriptLink link_;
    std::vector<std::byte> room_;
    mtp::Responder responder_;
    std::deque<ScriptLink::Bytes> answers_;
};

} // namespace dicot::test
