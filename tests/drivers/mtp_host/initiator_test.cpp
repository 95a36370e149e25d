#include "conversation_bytes.h"

#include <gtest/gtest.h>

namespace dicot::mtp {
namespace {

using test::bytes_of_hex;
using test::data;
using test::device_info;
using test::kOurs;
using test::response;

/// Open: a session (transaction 0), and what the device is (transaction 1).
class Opened : public testing::Test
{
protected:
    void open(const std::string& count = "01000000", const std::string& operations = "1B10",
              const std::string& extension = "00")
    {
        pipe_.say(response(0));
        pipe_.say(data(1, "0110", device_info(count, operations, extension)));
        pipe_.say(response(1));
        const Status opened = initiator_.open();
        ASSERT_TRUE(opened.ok()) << opened.message();
        pipe_.sent.clear();
    }

    test::ScriptedPipe pipe_;
    Initiator initiator_{pipe_, test::kNoPatience};
};

TEST_F(Opened, ASessionIsOpenedAndTheDeviceAskedWhatItIs)
{
    pipe_.say(response(0));
    pipe_.say(data(1, "0110", device_info("02000000", "1B10 C195")));
    pipe_.say(response(1));
    ASSERT_TRUE(initiator_.open().ok());
    ASSERT_EQ(pipe_.sent.size(), 2u);
    EXPECT_EQ(pipe_.sent[0], "10000000"
                             "01000210"
                             "00000000"
                             "01000000"); // OpenSession, number 0, session 1
    EXPECT_EQ(pipe_.sent[1], "0C000000"
                             "01000110"
                             "01000000");
    EXPECT_EQ(initiator_.facts().manufacturer.view(), "M");
    EXPECT_EQ(initiator_.facts().model.view(), "Ä1");
    EXPECT_EQ(initiator_.facts().serial.view(), "S");
    EXPECT_TRUE(initiator_.facts().partial);
    EXPECT_TRUE(initiator_.facts().partial_64);
    EXPECT_FALSE(initiator_.facts().lists_snapshots);
    EXPECT_EQ(initiator_.session(), 1u);
}

TEST_F(Opened, OperationsOfTheVendorAreOursOnlyIfTheDeviceSaysSo)
{
    open("02000000", "019D 029D");
    EXPECT_FALSE(initiator_.facts().lists_snapshots);
    open("02000000", "019D 029D", kOurs);
    EXPECT_TRUE(initiator_.facts().lists_snapshots);
    EXPECT_TRUE(initiator_.facts().takes_marks);
    EXPECT_FALSE(initiator_.facts().takes_time);
}

TEST_F(Opened, ASessionThatSomebodyLeftOpenIsClosedFirst)
{
    pipe_.say(response(0, "1E20"));
    pipe_.say(response(1));
    open();
    EXPECT_EQ(initiator_.session(), 1u);
    EXPECT_EQ(pipe_.resets, 0);
}

TEST_F(Opened, AFolderIsAskedForItsHandles)
{
    open();
    pipe_.say(data(2, "0710", "03000000 09000000 05000000 09000000"));
    pipe_.say(response(2));
    std::vector<std::uint32_t> handles;
    ASSERT_TRUE(initiator_.children(0x00010001, 0, false, handles).ok());
    EXPECT_EQ(handles, (std::vector<std::uint32_t>{5, 9})); // each one once
    EXPECT_EQ(pipe_.sent.at(0), "18000000"
                                "01000710"
                                "02000000"
                                "01000100"
                                "00000000"
                                "FFFFFFFF");
}

TEST_F(Opened, AFolderNeverStandsInItself)
{
    open();
    pipe_.say(data(2, "0710", "03000000 09000000 00000000 0A000000"));
    pipe_.say(response(2));
    std::vector<std::uint32_t> handles;
    ASSERT_TRUE(initiator_.children(1, 9, false, handles).ok());
    EXPECT_EQ(handles, std::vector<std::uint32_t>{10});
}

TEST_F(Opened, ADeviceThatCannotTellFoldersApartIsAskedForAll)
{
    open();
    pipe_.say(response(2, "1420")); // SpecificationByFormatUnsupported
    pipe_.say(data(3, "0710", "01000000 09000000"));
    pipe_.say(response(3));
    std::vector<std::uint32_t> handles;
    ASSERT_TRUE(initiator_.children(1, 0, true, handles).ok());
    EXPECT_EQ(handles, std::vector<std::uint32_t>{9});
    EXPECT_EQ(pipe_.sent.at(0).substr(32, 8), "01300000");
    EXPECT_EQ(pipe_.sent.at(1).substr(32, 8), "00000000");
}

TEST_F(Opened, AnObjectTellsNameSizeAndKind)
{
    open();
    // Storage, format, protection, size; the picture's seven; parent, association, its number, sequence; "a.b", no
    // dates, no words.
    const std::string fields = "01000100 0030 0000 44332211 0000 00000000 00000000 00000000 00000000 00000000 00000000"
                               "07000000 0000 00000000 00000000 04 6100 2E00 6200 0000 00 00 00";
    pipe_.say(data(2, "0810", fields));
    pipe_.say(response(2));
    ObjectFacts facts;
    ASSERT_TRUE(initiator_.object(5, facts).ok());
    EXPECT_EQ(facts.name.view(), "a.b");
    EXPECT_EQ(facts.bytes, 0x11223344u);
    EXPECT_EQ(facts.parent, 7u);
    EXPECT_FALSE(facts.folder);
    pipe_.say(response(3, "0920"));
    EXPECT_EQ(initiator_.object(5, facts).fault(), Fault::kNoInput);
}

TEST_F(Opened, APartOfAFileIsReadWithTheOperationThatTheDeviceHas)
{
    std::array<std::byte, 3> into{};
    open("01000000", "1B10");
    pipe_.say(data(2, "1B10", "AABBCC"));
    pipe_.say(response(2));
    ASSERT_EQ(initiator_.read(5, 1000, 256, into).value(), 3u);
    EXPECT_EQ(test::hex_of_bytes(into), "AABBCC");
    EXPECT_EQ(pipe_.sent.at(0), "18000000"
                                "01001B10"
                                "02000000"
                                "05000000"
                                "00010000"
                                "03000000");
    open("01000000", "C195");
    pipe_.say(data(2, "C195", "DDEE"));
    pipe_.say(response(2));
    ASSERT_EQ(initiator_.read(5, 1000, 998, into).value(), 2u); // no further than the file's end
    EXPECT_EQ(pipe_.sent.at(0), "1C000000"
                                "0100C195"
                                "02000000"
                                "05000000"
                                "E6030000"
                                "00000000"
                                "02000000");
    EXPECT_EQ(initiator_.read(5, 1000, 1000, into).value(), 0u);
    EXPECT_EQ(pipe_.sent.size(), 1u);
}

/// 500 bytes and the header fill one packet exactly.
std::string a_packet_of_data()
{
    std::string payload;
    for (int i = 0; i < 500; ++i)
        payload += "5A";
    return data(2, "1B10", payload);
}

TEST_F(Opened, DataOfWholePacketsEndsWithAnEmptyOneOrWithout)
{
    std::array<std::byte, 500> into{};
    for (const bool empty : {true, false}) {
        open();
        pipe_.say(bytes_of_hex(a_packet_of_data()), empty);
        pipe_.say(response(2));
        ASSERT_EQ(initiator_.read(5, 500, 0, into).value(), 500u);
        EXPECT_EQ(into.back(), std::byte{0x5A});
        EXPECT_EQ(pipe_.resets, 0);
    }
    // And the response behind it, where one packet follows the other without anything between them.
    open();
    pipe_.say(bytes_of_hex(a_packet_of_data() + response(2)));
    ASSERT_EQ(initiator_.read(5, 500, 0, into).value(), 500u);
    EXPECT_EQ(pipe_.resets, 0);
}

TEST_F(Opened, AHeaderInAPacketOfItsOwnIsUnderstood)
{
    open();
    pipe_.say("0F000000 0200 1B10 02000000");
    pipe_.say("AABBCC");
    pipe_.say(response(2));
    std::array<std::byte, 3> into{};
    ASSERT_EQ(initiator_.read(5, 3, 0, into).value(), 3u);
    EXPECT_EQ(test::hex_of_bytes(into), "AABBCC");
    EXPECT_EQ(pipe_.resets, 0);
}

TEST_F(Opened, WithoutPartialReadsOneTransferIsReadInSteps)
{
    open("00000000", "");
    pipe_.say(data(2, "0910", "A0A1A2A3A4A5A6A7"));
    pipe_.say(response(2));
    std::array<std::byte, 3> into{};
    ASSERT_EQ(initiator_.read(5, 8, 1, into).value(), 3u); // the first byte is passed over
    EXPECT_EQ(test::hex_of_bytes(into), "A1A2A3");
    ASSERT_EQ(initiator_.read(5, 8, 4, into).value(), 3u);
    EXPECT_EQ(test::hex_of_bytes(into), "A4A5A6");
    EXPECT_EQ(pipe_.sent.size(), 1u);
    // Another question lets the rest pass first.
    pipe_.say(response(3, "0920"));
    ObjectFacts facts;
    EXPECT_EQ(initiator_.object(6, facts).fault(), Fault::kNoInput);
    EXPECT_EQ(pipe_.resets, 0);
}

TEST_F(Opened, SnapshotsAreListedFromANumberOn)
{
    open("01000000", "019D", kOurs);
    std::string note = "1100000000000000"
                       "40420F0000000000"
                       "00E1F50500000000"
                       "10010000"
                       "0700"
                       "0100";
    for (int i = 0; i < 32; ++i)
        note += "AB";
    pipe_.say(data(2, "019D", "01000000" + note));
    pipe_.say(response(2));
    std::vector<SnapshotNote> notes;
    ASSERT_TRUE(initiator_.list_snapshots(0x100000002, notes).fault() == Fault::kBadData); // 17 is not from there on
    EXPECT_EQ(pipe_.sent.at(0), "18000000"
                                "0100019D"
                                "02000000"
                                "02000000"
                                "01000000"
                                "00040000");
    pipe_.say(data(3, "019D", "01000000" + note));
    pipe_.say(response(3));
    ASSERT_TRUE(initiator_.list_snapshots(17, notes).ok());
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].sequence, 17);
    EXPECT_EQ(notes[0].began_us, 1'000'000);
    EXPECT_EQ(notes[0].bytes, 100'000'000u);
    EXPECT_EQ(notes[0].folder, 0x110u);
    EXPECT_EQ(notes[0].files, 7u);
    EXPECT_TRUE(notes[0].pulled);
    EXPECT_EQ(notes[0].sums.back(), std::byte{0xAB});
    pipe_.say(data(4, "019D", "02000000" + note + note)); // the same number twice
    pipe_.say(response(4));
    EXPECT_EQ(initiator_.list_snapshots(17, notes).fault(), Fault::kBadData);
}

TEST_F(Opened, MarksAndTimeGoOutAsTheyAreWrittenDown)
{
    open("02000000", "029D 039D", kOurs);
    PulledNote note;
    note.sequence = 17;
    note.sums.fill(std::byte{0xCD});
    pipe_.say(response(2));
    ASSERT_TRUE(initiator_.mark_pulled({&note, 1}).ok());
    std::string sums;
    for (int i = 0; i < 32; ++i)
        sums += "CD";
    EXPECT_EQ(pipe_.sent.at(0), "0C000000"
                                "0100029D"
                                "02000000");
    EXPECT_EQ(pipe_.sent.at(1), "38000000"
                                "0200029D"
                                "02000000"
                                "01000000"
                                "1100000000000000" +
                                    sums);
    pipe_.say(response(3, "1920")); // busy
    EXPECT_EQ(initiator_.mark_pulled({&note, 1}).fault(), Fault::kTryAgain);
    pipe_.say(response(4, "0F20")); // not allowed
    EXPECT_EQ(initiator_.offer_time({1'000'000}).fault(), Fault::kUsage);
    EXPECT_EQ(pipe_.sent.back(), "14000000"
                                 "0200039D"
                                 "04000000"
                                 "40420F0000000000");
}

} // namespace
} // namespace dicot::mtp
