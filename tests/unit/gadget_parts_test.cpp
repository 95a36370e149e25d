// The gadget's pure parts: bytes for FunctionFS, by the kernel's layout and the USB classes' documents written out by
// hand, and the state behind endpoint 0.
#include "descriptors.h"
#include "still_image.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace dicot::gadget_parts;
using Bytes = std::vector<unsigned>;

Bytes plain(std::span<const std::byte> bytes)
{
    Bytes values;
    for (const std::byte each : bytes)
        values.push_back(std::to_integer<unsigned>(each));
    return values;
}

Bytes part(const Bytes& all, std::size_t at, std::size_t count)
{
    return {all.begin() + static_cast<std::ptrdiff_t>(at), all.begin() + static_cast<std::ptrdiff_t>(at + count)};
}

Bytes joined(std::initializer_list<Bytes> parts)
{
    Bytes all;
    for (const Bytes& each : parts)
        all.insert(all.end(), each.begin(), each.end());
    return all;
}

const Bytes kInterface{9, 4, 0, 0, 3, 6, 1, 1, 1};

TEST(GadgetDescriptors, AreTheBlockThatFunctionFsReads)
{
    const Bytes all = plain(DescriptorBlock(0x0100).bytes());
    // Magic 3, the whole length, four kinds: full, high, super speed, OS descriptors; how many of each.
    const Bytes head = joined({{3, 0, 0, 0},
                               {static_cast<unsigned>(all.size()), 0, 0, 0},
                               {15, 0, 0, 0},
                               {4, 0, 0, 0},
                               {4, 0, 0, 0},
                               {7, 0, 0, 0},
                               {1, 0, 0, 0}});
    EXPECT_EQ(part(all, 0, 28), head);
    const Bytes full =
        joined({kInterface, {7, 5, 0x81, 2, 64, 0, 0}, {7, 5, 2, 2, 64, 0, 0}, {7, 5, 0x83, 3, 28, 0, 32}});
    const Bytes high = joined({kInterface, {7, 5, 0x81, 2, 0, 2, 0}, {7, 5, 2, 2, 0, 2, 0}, {7, 5, 0x83, 3, 28, 0, 9}});
    const Bytes super = joined({kInterface,
                                {7, 5, 0x81, 2, 0, 4, 0},
                                {6, 48, 15, 0, 0, 0},
                                {7, 5, 2, 2, 0, 4, 0},
                                {6, 48, 15, 0, 0, 0},
                                {7, 5, 0x83, 3, 28, 0, 9},
                                {6, 48, 0, 0, 28, 0}});
    EXPECT_EQ(part(all, 28, 30), full);
    EXPECT_EQ(part(all, 58, 30), high);
    EXPECT_EQ(part(all, 88, 48), super);
    const Bytes os =
        joined({{0}, {35, 0, 0, 0}, {0, 1}, {4, 0}, {1}, {0}, {0, 1}, {'M', 'T', 'P', 0, 0, 0, 0, 0}, Bytes(14, 0)});
    EXPECT_EQ(part(all, 136, all.size() - 136), os);
}

TEST(GadgetDescriptors, NameTheInterfaceMtpInEnglish)
{
    EXPECT_EQ(plain(interface_string()),
              (Bytes{2, 0, 0, 0, 22, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 9, 4, 'M', 'T', 'P', 0}));
}

constexpr Setup kStatus{0xa1, 0x67, 0, 0, 20};
constexpr Setup kCancel{0x21, 0x64, 0, 0, 6};
constexpr Setup kReset{0x21, 0x66, 0, 0, 0};

Bytes sent(const Ep0Answer& answer)
{
    return answer.kind == Ep0Answer::Kind::kSend ? part(plain(answer.data), 0, answer.bytes) : Bytes{};
}

const Bytes kOk{4, 0, 0x01, 0x20}, kBusy{4, 0, 0x19, 0x20};

std::vector<std::byte> cancellation(unsigned code, unsigned id)
{
    return {std::byte(code & 0xff), std::byte(code >> 8), std::byte(id), std::byte(0), std::byte(0), std::byte(0)};
}

StillImage configured()
{
    StillImage image;
    image.hear(Ep0Event::kBind);
    image.hear(Ep0Event::kEnable);
    return image;
}

TEST(StillImage, IsBusyWhileATransactionIsUnderWay)
{
    StillImage image = configured();
    EXPECT_EQ(sent(image.asked(kStatus)), kOk);
    image.begin(7);
    EXPECT_EQ(sent(image.asked(kStatus)), kBusy);
    image.end();
    EXPECT_EQ(sent(image.asked(kStatus)), kOk);
}

TEST(StillImage, CancelsTheTransactionAndIsBusyUntilTheEndpointsAreClear)
{
    StillImage image = configured();
    image.begin(7);
    const Ep0Answer answer = image.asked(kCancel);
    EXPECT_EQ(answer.kind, Ep0Answer::Kind::kTake);
    EXPECT_EQ(answer.bytes, 6U);
    EXPECT_TRUE(image.taken(kCancel, cancellation(0x4001, 7)));
    EXPECT_TRUE(image.interrupted());
    EXPECT_TRUE(image.must_flush());
    image.flushed();
    EXPECT_EQ(sent(image.asked(kStatus)), kBusy);
    image.end();
    EXPECT_FALSE(image.interrupted());
    EXPECT_EQ(sent(image.asked(kStatus)), kOk);
}

TEST(StillImage, CancelsARequestThatStillWaits)
{
    StillImage image = configured();
    EXPECT_TRUE(image.taken(kCancel, cancellation(0x4001, 8)));
    EXPECT_EQ(sent(image.asked(kStatus)), kBusy);
    image.begin(8);
    EXPECT_TRUE(image.interrupted());
}

TEST(StillImage, DoesNotCancelTheNextTransactionForTheLastOne)
{
    StillImage image = configured();
    EXPECT_TRUE(image.taken(kCancel, cancellation(0x4001, 8)));
    image.flushed();
    image.begin(9);
    EXPECT_FALSE(image.interrupted());
}

TEST(StillImage, TakesNoCancellationThatIsNone)
{
    StillImage image = configured();
    image.begin(7);
    EXPECT_FALSE(image.taken(kCancel, cancellation(0x4002, 7)));
    EXPECT_FALSE(image.taken(kCancel, std::span<const std::byte>{}));
    EXPECT_FALSE(image.interrupted());
    auto longer = kCancel;
    longer.length = 7;
    EXPECT_EQ(image.asked(longer).kind, Ep0Answer::Kind::kStall);
}

TEST(StillImage, TellsOfAResetOnce)
{
    StillImage image = configured();
    EXPECT_EQ(image.asked(kReset).kind, Ep0Answer::Kind::kTake);
    EXPECT_TRUE(image.taken(kReset, {}));
    EXPECT_TRUE(image.must_flush());
    EXPECT_TRUE(image.take_reset());
    EXPECT_FALSE(image.take_reset());
}

TEST(StillImage, StallsWhatItDoesNotKnow)
{
    const StillImage image = configured();
    for (int type = 0; type < 256; ++type)
        for (int request = 0; request < 256; ++request) {
            const dicot::gadget_parts::Setup setup{static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(request),
                                                   0, 0, 512};
            const bool known = type == 0xa1 && request == 0x67; // no event to tell; the others have other lengths
            EXPECT_EQ(image.asked(setup).kind == Ep0Answer::Kind::kStall, !known) << type << " " << request;
        }
}

TEST(StillImage, TellsTheLastEventInFull)
{
    StillImage image = configured();
    constexpr dicot::gadget_parts::Setup kEvent{0xa1, 0x65, 0, 0, 512};
    EXPECT_EQ(image.asked(kEvent).kind, Ep0Answer::Kind::kStall);
    // ObjectAdded, transaction 5, one parameter.
    std::vector<std::byte> container(16);
    const unsigned bytes[16] = {16, 0, 0, 0, 4, 0, 0x02, 0x40, 5, 0, 0, 0, 0x11, 0x22, 0x33, 0x44};
    for (std::size_t i = 0; i < 16; ++i)
        container[i] = std::byte(bytes[i]);
    image.posted(container);
    EXPECT_EQ(sent(image.asked(kEvent)), (Bytes{0x02, 0x40, 5, 0, 0, 0, 1, 0, 4, 0, 0x11, 0x22, 0x33, 0x44}));
}

TEST(StillImage, BeginsAnewWithEachConfiguration)
{
    StillImage image = configured();
    const std::uint32_t first = image.generation();
    image.begin(7);
    image.hear(Ep0Event::kSuspend);
    EXPECT_TRUE(image.suspended());
    EXPECT_FALSE(image.interrupted());
    image.hear(Ep0Event::kDisable);
    EXPECT_FALSE(image.enabled());
    EXPECT_FALSE(image.suspended());
    EXPECT_TRUE(image.interrupted());
    // A host that sets the configuration again tells no end of the first one.
    image.hear(Ep0Event::kEnable);
    image.hear(Ep0Event::kEnable);
    EXPECT_EQ(image.generation(), first + 2);
    EXPECT_TRUE(image.enabled());
    EXPECT_TRUE(image.interrupted());
    EXPECT_FALSE(image.take_reset());
}

} // namespace
