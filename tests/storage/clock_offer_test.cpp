// When a board believes a host's clock.
#include "temp_folder.h"

#include "clock_offer.h"

#include "dicot/os/clock_trust.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <optional>
#include <string>

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dicot::test {
namespace {

using namespace app;

constexpr std::int64_t kSecond = 1'000'000;
constexpr std::int64_t kDay = 86'400 * kSecond;
constexpr std::int64_t kBuilt = 1'780'272'000 * kSecond; ///< 2026-06-01
constexpr std::int64_t kMarch2100 = 4'107'542'400 * kSecond;

/// A board without a battery: it woke in 1970, and has a snapshot of a week after its program was built.
OfferCase board_of_1970()
{
    OfferCase board;
    board.clock.now_us = 100 * kSecond;
    board.clock.trust = ClockTrust::kNotSet;
    board.built_us = kBuilt;
    board.latest_us = kBuilt + 7 * kDay;
    return board;
}

struct OfferExample
{
    const char* what;
    std::int64_t offer_us;
    std::function<void(OfferCase&)> change;
    const char* refused; ///< a word of the sentence; null: taken
};

TEST(ClockOffer, IsTakenByAClockThatIsNotSetAndNeverFromThePast)
{
    const auto as_it_is = [](OfferCase&) {};
    const std::int64_t later_us = kBuilt + 8 * kDay;
    const OfferExample examples[] = {
        {"a good time", later_us, as_it_is, nullptr},
        {"a second after the newest snapshot", kBuilt + 7 * kDay + kSecond, as_it_is, nullptr},
        {"the second of the newest snapshot", kBuilt + 7 * kDay, as_it_is, "2026-06-08"},
        {"before the newest snapshot", kBuilt + 6 * kDay, as_it_is, "by hand"},
        {"before the build", kBuilt - kSecond, as_it_is, "built"},
        {"1970", 0, as_it_is, "built"},
        {"before 1970", -kDay, as_it_is, "built"},
        {"the least that can be said", INT64_MIN, as_it_is, "built"},
        {"2099", kEndOfOffersUs - 1, as_it_is, nullptr},
        {"2100", kEndOfOffersUs, as_it_is, "cannot be"},
        {"March 2100", kMarch2100, as_it_is, "cannot be"},
        {"the most that can be said", INT64_MAX, as_it_is, "cannot be"},
        {"no snapshot yet", kBuilt, [](OfferCase& board) { board.latest_us.reset(); }, nullptr},
        {"not configured", later_us, [](OfferCase& board) { board.rule = "never"; }, "usb.clock"},
        {"an unknown rule", later_us, [](OfferCase& board) { board.rule = "always"; }, "usb.clock"},
        {"no rule", later_us, [](OfferCase& board) { board.rule = ""; }, "usb.clock"},
        {"a clock that is set", later_us, [](OfferCase& board) { board.clock.trust = ClockTrust::kSet; }, "is set"},
        {"a clock that is steered", later_us, [](OfferCase& board) { board.clock.trust = ClockTrust::kSynchronised; },
         "synchronised"},
        {"a clock behind the newest snapshot", later_us,
         [](OfferCase& board) { board.clock = judge_clock(built_us() + kDay, {}, built_us() + 2 * kDay); }, nullptr},
        {"a clock that may be right", later_us,
         [](OfferCase& board) { board.clock = judge_clock(built_us() + kDay, {}, built_us()); }, "is set"},
    };
    for (const OfferExample& example : examples) {
        OfferCase board = board_of_1970();
        example.change(board);
        const Status status = judge_offer({example.offer_us}, board);
        EXPECT_EQ(status.fault(), example.refused == nullptr ? Fault::kOk : Fault::kUsage) << example.what;
        if (example.refused != nullptr) {
            EXPECT_NE(std::string(status.message()).find(example.refused), std::string::npos) << status.message();
        }
    }
}

TEST(ClockOffer, OnItsWayIsOneLineAndNothingElseIsRead)
{
    for (const WaitingOffer& offer :
         {WaitingOffer{0, 0}, WaitingOffer{kBuilt, 17}, WaitingOffer{-1, -1}, WaitingOffer{INT64_MIN, INT64_MAX}})
        EXPECT_EQ(parse_offer(print_offer(offer).view()), offer);
    EXPECT_EQ(print_offer({1780315200000000, 90000000}).view(), "1780315200000000 90000000\n");
    for (const char* text : {"", "\n", "1", "1 ", "1 2", "1 2\n\n", " 1 2\n", "1  2\n", "+1 2\n", "01 2\n", "1 2 3\n",
                             "99999999999999999999 1\n", "1 99999999999999999999\n", "a b\n", "1\n2\n", "0x1 2\n"})
        EXPECT_EQ(parse_offer(text), std::nullopt) << text;
}

TEST(ClockOffer, ThatWaitsIsTakenAwayWhateverComesOfIt)
{
    const TempFolder folder;
    const std::string file = folder.path("clock-offer");
    const auto offered = [&](const std::string& text) {
        folder.write("clock-offer", text);
        const Status status = take_waiting_offer(file, "never", folder.path("no store"));
        EXPECT_NE(::access(file.c_str(), F_OK), 0) << text;
        return status.fault();
    };
    EXPECT_EQ(take_waiting_offer(file, "never", folder.path("no store")).fault(), Fault::kNoInput);
    EXPECT_EQ(offered("no offer"), Fault::kBadData);
    EXPECT_EQ(offered(std::string(10'000, '1')), Fault::kBadData);
    EXPECT_EQ(offered(print_offer({kBuilt, boot_us() - 61 * kSecond}).c_str()), Fault::kUsage) << "too old";
    EXPECT_EQ(offered(print_offer({kBuilt, boot_us() + 3600 * kSecond}).c_str()), Fault::kUsage) << "of another start";
    EXPECT_EQ(offered(print_offer({kBuilt, boot_us()}).c_str()), Fault::kUsage);
    // A link that somebody laid is no offer, and what it leads to stays.
    const std::string other = folder.write("other", print_offer({kBuilt, boot_us()}).c_str());
    ASSERT_EQ(::symlink(other.c_str(), file.c_str()), 0);
    EXPECT_EQ(take_waiting_offer(file, "never", folder.path("no store")).fault(), Fault::kBadData);
    EXPECT_NE(::access(file.c_str(), F_OK), 0);
    EXPECT_EQ(::access(other.c_str(), F_OK), 0);
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    EXPECT_EQ(take_waiting_offer(file, "never", folder.path("no store")).fault(), Fault::kBadData);
}

/// In a process without any right: no test sets the clock of the machine that it runs on.
int without_rights(const std::function<bool()>& work)
{
    const pid_t child = ::fork();
    if (child == 0) {
        constexpr uid_t kNobody = 65'534;
        const bool is_nobody = ::geteuid() != 0 || ::setresuid(kNobody, kNobody, kNobody) == 0;
        ::_exit(is_nobody && work() ? 0 : 1);
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    return status;
}

TEST(ClockOffer, IsPassedOnByWhoMayNotSetTheClockAndTakenBackWhenNobodyAnswers)
{
    const TempFolder folder;
    ASSERT_EQ(::chmod(folder.path(".").c_str(), 0777), 0);
    const std::string file = folder.path("clock-offer");
    const auto now_us = [] { return read_clock({}).now_us; };
    EXPECT_EQ(without_rights([&] {
                  const Status status = set_or_pass_on({now_us() + kDay}, file.c_str(), kSecond / 5);
                  return status.fault() == Fault::kOsError &&
                         std::string(status.message()).find("dicot-clock.path") != std::string::npos;
              }),
              0);
    EXPECT_NE(::access(file.c_str(), F_OK), 0);
    // Somebody has set it, as the clock shows.
    EXPECT_EQ(without_rights([&] {
                  const std::int64_t offer_us = now_us(), taken_us = boot_us();
                  if (!set_or_pass_on({offer_us}, file.c_str(), 5 * kSecond).ok())
                      return false;
                  const std::optional<WaitingOffer> waits = parse_offer(bytes_of(file).empty() ? "" : [&] {
                      const Bytes bytes = bytes_of(file);
                      return std::string(bytes.begin(), bytes.end());
                  }());
                  return waits && waits->now_us == offer_us && waits->taken_us >= taken_us;
              }),
              0);
    EXPECT_EQ(
        without_rights([] { return set_or_pass_on({0}, "/nowhere/at/all/offer", kSecond).fault() == Fault::kOsError; }),
        0);
}

TEST(ClockOffer, ATimeThatTheSystemCannotHoldIsNotSet)
{
    EXPECT_EQ(set_clock(-kSecond).fault(), Fault::kOsError);
    if (sizeof(time_t) == 4) {
        EXPECT_EQ(set_clock(std::int64_t{1} << 52).fault(), Fault::kOsError);
    }
}

} // namespace
} // namespace dicot::test
