// A device whose tree has no end.
#pragma once

#include "dicot/mtp_host/usb_pipe.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <vector>

namespace dicot::test {

/// Every folder holds the same folders, among them itself and its own parent.
class Labyrinth final : public mtp::UsbPipe
{
public:
    explicit Labyrinth(int& asked) : asked_(asked) {}

    std::size_t packet_bytes() const override { return 512; }
    Status send(std::span<const std::byte> bytes, int) override
    {
        ++asked_;
        const auto code = static_cast<std::uint16_t>(bytes[6]) | static_cast<std::uint16_t>(bytes[7]) << 8;
        const auto folder = bytes.size() > 12 ? std::to_integer<unsigned>(bytes[12]) : 0;
        std::vector<std::byte> data;
        if (code == 0x1001)
            data.resize(8 + 1 + 2 + 20 + 4); // knows nothing, says nothing
        if (code == 0x1004)
            data = words({1, 0x00010001});
        if (code == 0x1007)
            data = words({6, 1, 2, 3, 4, 4, 5});
        if (code == 0x1008) {
            data = words({0x00010001, 0x00003001}); // a folder
            data.resize(52);
            data.insert(data.end(), {std::byte{2}, static_cast<std::byte>('a' + folder), std::byte{0}, std::byte{0},
                                     std::byte{0}, std::byte{0}, std::byte{0}, std::byte{0}});
        }
        if (!data.empty())
            answer(2, bytes, data);
        answer(3, bytes, {});
        return {};
    }
    Result<Piece> receive(std::span<std::byte> into, int) override
    {
        if (answers_.empty())
            return failure(Fault::kTryAgain, "silence");
        const std::vector<std::byte> one = answers_.front();
        answers_.pop_front();
        std::copy(one.begin(), one.end(), into.begin());
        return Piece{one.size(), true};
    }
    Status cancel(std::uint32_t) override { return {}; }
    Status reset() override { return {}; }
    Result<std::uint16_t> status() override { return std::uint16_t{0x2001}; }
    void clear_halts() override {}

private:
    static std::vector<std::byte> words(std::initializer_list<std::uint32_t> all)
    {
        std::vector<std::byte> bytes;
        for (std::uint32_t word : all)
            for (int i = 0; i < 4; ++i, word >>= 8)
                bytes.push_back(static_cast<std::byte>(word & 0xFF));
        return bytes;
    }
    void answer(unsigned kind, std::span<const std::byte> command, const std::vector<std::byte>& data)
    {
        std::vector<std::byte> all = words({static_cast<std::uint32_t>(12 + data.size()), kind});
        all[6] = kind == 2 ? command[6] : std::byte{0x01};
        all[7] = kind == 2 ? command[7] : std::byte{0x20};
        all.insert(all.end(), command.begin() + 8, command.begin() + 12);
        all.insert(all.end(), data.begin(), data.end());
        answers_.push_back(all);
    }

    int& asked_;
    std::deque<std::vector<std::byte>> answers_;
};

} // namespace dicot::test
