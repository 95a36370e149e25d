// Devices that lie, break off, or go away.
#include "conversation_bytes.h"

#include <gtest/gtest.h>

namespace dicot::mtp {
namespace {

using test::data;
using test::device_info;
using test::response;

class Hostile : public testing::Test
{
protected:
    /// A board of ours: its handles outlive the session.
    void open(const std::string& count = "02000000", const std::string& operations = "1B10 019D",
              const std::string& extension = test::kOurs)
    {
        pipe_.say(response(0));
        pipe_.say(data(1, "0110", device_info(count, operations, extension)));
        pipe_.say(response(1));
        ASSERT_TRUE(initiator_.open().ok());
        pipe_.sent.clear();
    }

    test::ScriptedPipe pipe_;
    Initiator initiator_{pipe_, test::kNoPatience};
    std::array<std::byte, 600> into_{};
};

TEST_F(Hostile, ABrokenTransactionIsCancelledAndAskedAgainInANewSession)
{
    open();
    pipe_.say(data(7, "1B10", "AABBCC")); // of no transaction that anybody began
    pipe_.fail(Fault::kTryAgain);         // nothing left of it
    pipe_.fail(Fault::kTryAgain);
    pipe_.say(response(0));
    pipe_.say(data(1, "1B10", "AABBCC"));
    pipe_.say(response(1));
    ASSERT_EQ(initiator_.read(5, 3, 0, into_).value(), 3u);
    EXPECT_EQ(test::hex_of_bytes(std::span{into_}.first(3)), "AABBCC");
    ASSERT_EQ(pipe_.sent.size(), 5u);
    EXPECT_EQ(pipe_.sent[1], "cancel 2");
    EXPECT_EQ(pipe_.sent[2], "reset");
    EXPECT_EQ(pipe_.sent[3].substr(8, 8), "01000210"); // OpenSession
    EXPECT_EQ(pipe_.sent[4].substr(8, 8), "01001B10");
    EXPECT_EQ(initiator_.session(), 2u);
}

TEST_F(Hostile, HandlesOfOthersAreNotUsedInANewSession)
{
    open("01000000", "1B10", "00");
    pipe_.fail(Fault::kIoError);
    pipe_.fail(Fault::kTryAgain);
    pipe_.fail(Fault::kTryAgain);
    pipe_.say(response(0));
    EXPECT_EQ(initiator_.read(5, 3, 0, into_).status().fault(), Fault::kTryAgain);
    EXPECT_EQ(initiator_.session(), 2u);
    EXPECT_EQ(pipe_.sent.back().substr(8, 8), "01000210"); // nothing was asked behind OpenSession
}

TEST_F(Hostile, ADeviceThatForgotTheSessionGetsANewOne)
{
    open();
    pipe_.say(response(2, "0320"));
    pipe_.fail(Fault::kTryAgain);
    pipe_.fail(Fault::kTryAgain);
    pipe_.say(response(0));
    pipe_.say(data(1, "0410", "01000000 01000100"));
    pipe_.say(response(1));
    std::vector<std::uint32_t> storages;
    ASSERT_TRUE(initiator_.storages(storages).ok());
    EXPECT_EQ(storages, std::vector<std::uint32_t>{0x00010001});
}

TEST_F(Hostile, SilenceEndsInABoundedNumberOfQuestions)
{
    open();
    EXPECT_EQ(initiator_.read(5, 600, 0, into_).status().fault(), Fault::kUnavailable);
    EXPECT_EQ(pipe_.resets, Initiator::kMostRecoveries);
    EXPECT_LE(pipe_.sent.size(), 1u + 3u * Initiator::kMostRecoveries);
}

TEST_F(Hostile, ADeviceThatIsGoneIsAskedNothingMore)
{
    open();
    pipe_.fail(Fault::kUnavailable);
    EXPECT_EQ(initiator_.read(5, 600, 0, into_).status().fault(), Fault::kUnavailable);
    EXPECT_EQ(pipe_.sent.size(), 1u);
}

TEST_F(Hostile, AHaltedEndpointIsNoEnd)
{
    open();
    pipe_.fail(Fault::kIoError);
    pipe_.fail(Fault::kTryAgain);
    pipe_.fail(Fault::kTryAgain);
    pipe_.say(response(0));
    pipe_.say(data(1, "1B10", "AABBCC"));
    pipe_.say(response(1));
    EXPECT_EQ(initiator_.read(5, 3, 0, into_).value(), 3u);
}

TEST_F(Hostile, APersonWhoWantsTheEndIsNotMadeToWait)
{
    open();
    pipe_.fail(Fault::kUsage);
    EXPECT_EQ(initiator_.read(5, 600, 0, into_).status().fault(), Fault::kUsage);
    EXPECT_EQ(pipe_.resets, 0);
}

struct Lie
{
    const char* name;
    const char* answer; ///< to transaction 2, a read of 4 bytes
    const char* then;
};

void PrintTo(const Lie& lie, std::ostream* out)
{
    *out << lie.name;
}

class Liar : public Hostile, public testing::WithParamInterface<Lie>
{
};

TEST_P(Liar, IsFoundOutAndNotBelieved)
{
    open();
    for (int session = 0; session <= Initiator::kMostRecoveries; ++session) {
        const std::uint32_t transaction = session == 0 ? 2 : 1;
        std::string answer = GetParam().answer;
        std::string then = GetParam().then;
        for (std::string* text : {&answer, &then})
            for (std::size_t at; (at = text->find("TTTTTTTT")) != std::string::npos;)
                text->replace(at, 8, test::le32(transaction));
        pipe_.say(answer);
        if (!then.empty())
            pipe_.say(then);
        pipe_.fail(Fault::kTryAgain);
        pipe_.fail(Fault::kTryAgain);
        if (session < Initiator::kMostRecoveries)
            pipe_.say(response(0));
    }
    const Result<std::size_t> got = initiator_.read(5, 4, 0, std::span{into_}.first(4));
    EXPECT_EQ(got.status().fault(), Fault::kBadData) << got.status().message();
    EXPECT_EQ(pipe_.resets, Initiator::kMostRecoveries);
    EXPECT_LE(pipe_.receives, 100);
}

constexpr Lie kLies[] = {
    {"AnnouncesMoreThanWasAskedFor", "11000000 0200 1B10 TTTTTTTT AABBCCDDEE", ""},
    {"AnnouncesFourGigabytes", "FFFFFFFF 0200 1B10 TTTTTTTT AABBCCDD", ""},
    {"AnnouncesLessThanAHeader", "0B000000 0200 1B10 TTTTTTTT", ""},
    {"AnnouncesNothing", "00000000 0200 1B10 TTTTTTTT", ""},
    {"SendsLessThanItAnnounced", "10000000 0200 1B10 TTTTTTTT AABB", "0C000000 0300 0120 TTTTTTTT"},
    {"SendsMoreThanItAnnounced", "10000000 0200 1B10 TTTTTTTT AABBCCDDEEFF", ""},
    {"SendsHalfAHeader", "10000000 0200", ""},
    {"NamesAnotherOperation", "10000000 0200 0910 TTTTTTTT AABBCCDD", ""},
    {"NamesAnotherKind", "10000000 0100 1B10 TTTTTTTT AABBCCDD", ""},
    {"EndsAnotherTransaction", "10000000 0200 1B10 TTTTTTTT AABBCCDD", "0C000000 0300 0120 77777777"},
    {"EndsWithData", "10000000 0200 1B10 TTTTTTTT AABBCCDD", "10000000 0200 1B10 TTTTTTTT AABBCCDD"},
    {"EndsWithAnEvent", "10000000 0200 1B10 TTTTTTTT AABBCCDD", "0C000000 0400 0240 TTTTTTTT"},
    {"EndsWithSixWords", "10000000 0200 1B10 TTTTTTTT AABBCCDD",
     "24000000 0300 0120 TTTTTTTT 010000000200000003000000040000000500000006000000"},
    {"EndsWithACodeOfNone", "10000000 0200 1B10 TTTTTTTT AABBCCDD", "0C000000 0300 0000 TTTTTTTT"},
    {"EndsLongerThanItSays", "10000000 0200 1B10 TTTTTTTT AABBCCDD", "0C000000 0300 0120 TTTTTTTT FF"},
};
INSTANTIATE_TEST_SUITE_P(Each, Liar, testing::ValuesIn(kLies),
                         [](const testing::TestParamInfo<Lie>& lie) { return std::string{lie.param.name}; });

TEST_F(Hostile, ShortPartsOfAFileAreNonsense)
{
    open();
    pipe_.say(data(2, "1B10", "AA"));
    pipe_.say(response(2));
    EXPECT_EQ(initiator_.read(5, 600, 0, into_).status().fault(), Fault::kBadData);
}

TEST_F(Hostile, WholeObjectsOfAnotherSizeThanWasSaidAreNonsense)
{
    open("01000000", "019D");
    for (int session = 0; session <= Initiator::kMostRecoveries; ++session) {
        pipe_.say(data(session == 0 ? 2 : 1, "0910", "AABBCC"));
        pipe_.fail(Fault::kTryAgain);
        pipe_.fail(Fault::kTryAgain);
        pipe_.say(response(0));
    }
    EXPECT_EQ(initiator_.read(5, 600, 0, into_).status().fault(), Fault::kBadData);
}

TEST_F(Hostile, ListsThatEndTooEarlyAreNonsense)
{
    open();
    std::vector<std::uint32_t> handles;
    pipe_.say(data(2, "0710", "FFFFFFFF 01000000"));
    pipe_.say(response(2));
    EXPECT_EQ(initiator_.children(1, 0, false, handles).fault(), Fault::kBadData);
    pipe_.say(data(3, "0710", ""));
    pipe_.say(response(3));
    EXPECT_EQ(initiator_.children(1, 0, false, handles).fault(), Fault::kBadData);
    ObjectFacts facts;
    pipe_.say(data(4, "0810", "01000100 0030"));
    pipe_.say(response(4));
    EXPECT_EQ(initiator_.object(1, facts).fault(), Fault::kBadData);
    EXPECT_EQ(pipe_.resets, 0); // the containers were sound
}

TEST_F(Hostile, FilesOfFourGigabytesAreNotAskedFor)
{
    open();
    EXPECT_EQ(initiator_.read(5, Initiator::kTooLarge, 0, into_).status().fault(), Fault::kBadData);
    EXPECT_TRUE(pipe_.sent.empty());
}

} // namespace
} // namespace dicot::mtp
