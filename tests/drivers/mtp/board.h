// A responder with a small tree behind it and a scripted host before it.
#pragma once

#include "mtp_memory_shelf.h"
#include "mtp_script_link.h"
#include "mtp_wire.h"

#include "dicot/mtp/responder.h"

#include <gtest/gtest.h>

namespace dicot::test {

using Bytes = std::vector<std::byte>;

class MtpBoard : public testing::Test
{
protected:
    static constexpr std::int64_t kNoonUs = 1'772'366'400'000'000; ///< 2026-03-01T12:00:00Z
    static constexpr mtp::Handle kBoard = 1, kDay = 0x80005021, kSnapshot = 0x70, kLeft = 0x71, kCloud = 0x72,
                                 kSums = 0x7F;

    MtpBoard()
    {
        shelf.folder(kBoard, 0, "bench-3", kNoonUs);
        shelf.folder(kDay, kBoard, "2026-03-01", kNoonUs);
        shelf.folder(kSnapshot, kDay, "000007_120000Z", kNoonUs);
        shelf.file(kLeft, kSnapshot, "left.png", 1000, kNoonUs);
        shelf.file(kCloud, kSnapshot, "cloud.drc", 300'000, kNoonUs);
        shelf.file(kSums, kSnapshot, "SHA256SUMS", 160, kNoonUs);
    }

    struct Heard
    {
        Bytes data; ///< the payload of the data container, empty if there was none
        std::uint32_t announced = 0;
        bool had_data = false;
        std::uint16_t code = 0; ///< 0: no response
        std::vector<std::uint32_t> parameters;
    };

    static std::uint32_t number(const Bytes& bytes, std::size_t at, int size)
    {
        std::uint32_t value = 0;
        for (int i = 0; i < size; ++i)
            value |= static_cast<std::uint32_t>(bytes.at(at + static_cast<std::size_t>(i))) << (8 * i);
        return value;
    }

    /// What the host got of one transaction; each transfer's header must be what the standard asks for.
    Heard hear(std::uint16_t operation, std::uint32_t transaction)
    {
        Heard heard;
        for (const Bytes& transfer : link.take_sent()) {
            const std::uint32_t type = number(transfer, 4, 2);
            EXPECT_EQ(number(transfer, 8, 4), transaction);
            EXPECT_EQ(heard.code, 0) << "something follows the response";
            if (type == 2) {
                EXPECT_FALSE(heard.had_data) << "two data phases";
                EXPECT_EQ(number(transfer, 6, 2), operation);
                heard.had_data = true;
                heard.announced = number(transfer, 0, 4);
                heard.data.assign(transfer.begin() + 12, transfer.end());
            } else {
                EXPECT_EQ(type, 3u);
                EXPECT_EQ(number(transfer, 0, 4), transfer.size());
                heard.code = static_cast<std::uint16_t>(number(transfer, 6, 2));
                for (std::size_t at = 12; at < transfer.size(); at += 4)
                    heard.parameters.push_back(number(transfer, at, 4));
            }
        }
        EXPECT_EQ(link.wrong_parts, 0);
        EXPECT_EQ(link.begun, link.ended);
        return heard;
    }

    Heard ask(std::uint16_t operation, const std::vector<std::uint32_t>& parameters = {})
    {
        const std::uint32_t id = next_transaction++;
        link.say(Wire::block(1, operation, id, parameters));
        EXPECT_TRUE(responder.serve_one().ok());
        return hear(operation, id);
    }
    Heard ask_with_data(std::uint16_t operation, const Bytes& payload,
                        const std::vector<std::uint32_t>& parameters = {})
    {
        const std::uint32_t id = next_transaction++;
        link.say(Wire::block(1, operation, id, parameters));
        link.say(Wire::container(2, operation, id, payload));
        EXPECT_TRUE(responder.serve_one().ok());
        return hear(operation, id);
    }
    void open() { EXPECT_EQ(ask(0x1002, {1}).code, 0x2001); }

    MemoryShelf shelf;
    ScriptLink link;
    std::vector<std::byte> room = std::vector<std::byte>(mtp::Responder::kRoomBytes);
    mtp::Responder responder{shelf, link, {"dicot", "stereo", "1.2", "B3", "bench-3"}, room};
    std::uint32_t next_transaction = 1;
};

} // namespace dicot::test
