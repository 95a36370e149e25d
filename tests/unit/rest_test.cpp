// The pause between two slots, on a board whose clock, alarm and sleep are drawn: what a real one does is for the
// machines of tests/vm.
#include "dicot/os/heap_gate.h"
#include "dicot/os/stage_watch.h"
#include "dicot/power/cameras_power.h"
#include "dicot/power/lead_time.h"
#include "dicot/power/linux_board.h"
#include "dicot/power/rest.h"
#include "dicot/power/state_folder.h"

#include "temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <random>
#include <string>

namespace dicot::app {
namespace {

using test::TempFolder;
using testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000;
constexpr std::int64_t kMinute = 60 * kSecond;
constexpr std::int64_t kHour = 60 * kMinute;
constexpr std::int64_t kNoon = 1'780'315'200 * kSecond; // 2026-06-01T12:00:00Z

class DrawnBoard final : public Board
{
public:
    std::int64_t now_us() noexcept override { return true_us_ + clock_error_us; }
    std::int64_t boottime_us() noexcept override { return true_us_ - booted_us; }
    BootId boot() noexcept override
    {
        BootId id;
        std::snprintf(id.text, sizeof id.text, "00000000-0000-0000-0000-%012d", boot_number);
        return id;
    }
    WaitEnd wait_until(std::int64_t until_us, std::int64_t step_us, FunctionRef<bool()> step) noexcept override
    {
        while (true) {
            const std::int64_t error_us = clock_error_us;
            if (!step())
                return WaitEnd::kAsked;
            if (clock_error_us != error_us)
                return WaitEnd::kClockChanged;
            if (now_us() >= until_us)
                return WaitEnd::kTime;
            pass(std::min(step_us, until_us - now_us()));
        }
    }
    Status wake_after(std::int64_t after_s) noexcept override
    {
        if (!has_rtc)
            return failure(Fault::kUnavailable, "no clock");
        alarm_us = true_us_ + after_s * kSecond;
        return {};
    }
    Status no_alarm() noexcept override
    {
        alarm_us.reset();
        return {};
    }
    Result<Slept> suspend() noexcept override
    {
        ++suspends;
        if (suspends <= refusals)
            return failure(Fault::kTryAgain, "a device is busy");
        EXPECT_TRUE(alarm_us) << "a sleep without an alarm is for ever";
        const std::int64_t asleep_us = std::min(*alarm_us - true_us_, woken_after_us.value_or(INT64_MAX));
        pass(asleep_us + resume_us);
        if (on_wake)
            on_wake();
        return Slept{asleep_us, woken_after_us ? "eth0" : "rtc"};
    }
    bool computer_is_there() noexcept override { return true_us_ < kNoon + computer_us; }
    void pass(std::int64_t us) noexcept { true_us_ += us; }

    std::int64_t booted_us = kNoon - 10 * kHour;
    std::int64_t clock_error_us = 0;
    int boot_number = 1;
    bool has_rtc = true;
    int refusals = 0; ///< of the first suspends
    std::int64_t resume_us = 2 * kSecond;
    std::optional<std::int64_t> woken_after_us; ///< by something else
    std::function<void()> on_wake;
    std::int64_t computer_us = 0; ///< how long from noon on there is one at the cable

    std::optional<std::int64_t> alarm_us;
    int suspends = 0;

private:
    std::int64_t true_us_ = kNoon;
};

class RestTest : public testing::Test
{
protected:
    RestRules rules(Between way) const
    {
        RestRules rules;
        rules.between = way;
        rules.state = std::string_view{folder_.path("")};
        rules.request = std::string_view{folder_.path("power-off")};
        return rules;
    }
    bool exists(const char* name) const { return std::filesystem::exists(folder_.path(name)); }
    static constexpr auto go_on = [] { return true; };

    TempFolder folder_;
    DrawnBoard board_;
    LeadTime lead_;
};

TEST_F(RestTest, NeitherSleepsNorIsPoweredOffWhileAComputerIsAtTheCable)
{
    for (const Between way : {Between::kSuspend, Between::kOff}) {
        DrawnBoard board;
        board.computer_us = 5 * kMinute / 2;
        LeadTime lead;
        Rest rest(board, lead, rules(way));
        int visits = 0;
        while (board.computer_is_there()) {
            const Woken woken = rest.until({kNoon + kHour, 1}, [] { return true; });
            EXPECT_EQ(woken.way, Between::kIdle);
            EXPECT_EQ(woken.reason, WakeReason::kTime);
            ++visits;
        }
        EXPECT_EQ(visits, 3) << "looked at each minute";
        EXPECT_EQ(board.suspends, 0);
        EXPECT_FALSE(board.alarm_us);
        EXPECT_EQ(rest.way_to(kNoon + kHour), way) << "it has gone";
    }
}

TEST_F(RestTest, GivesAComputerAMomentToSeeTheBoardBeforeItSleeps)
{
    RestRules patient = rules(Between::kSuspend);
    patient.awake_first_us = kMinute;
    Rest rest(board_, lead_, patient);
    (void)rest.begun();
    const std::int64_t began_us = board_.now_us();
    EXPECT_EQ(rest.until({kNoon + kHour, 1}, go_on).way, Between::kIdle);
    EXPECT_EQ(board_.now_us(), began_us + kMinute);
    EXPECT_EQ(rest.until({kNoon + kHour, 1}, go_on).way, Between::kSuspend);
}

TEST(LinuxBoard, SeesAComputerThatHasConfiguredItsGadget)
{
    TempFolder sys;
    const auto say = [&](const std::string& file, const std::string& text) {
        const std::string path = sys.path(file);
        std::filesystem::create_directories(std::filesystem::path(path).parent_path());
        std::ofstream(path) << text;
    };
    LinuxBoard board("/dev/none", sys.path("").c_str());
    EXPECT_FALSE(board.computer_is_there()) << "no gadget";
    say("kernel/config/usb_gadget/dicot/UDC", "\n");
    EXPECT_FALSE(board.computer_is_there()) << "not bound";
    say("kernel/config/usb_gadget/dicot/UDC", "fe980000.usb\n");
    EXPECT_FALSE(board.computer_is_there()) << "no such controller";
    say("class/udc/fe980000.usb/state", "not attached\n");
    EXPECT_FALSE(board.computer_is_there());
    say("class/udc/fe980000.usb/state", "configured\n");
    EXPECT_TRUE(board.computer_is_there());
    say("class/udc/fe980000.usb/state", "suspended\n");
    EXPECT_FALSE(board.computer_is_there()) << "the computer sleeps";
}

TEST_F(RestTest, IdlesUntilTheCamerasHaveTimeToWarmUp)
{
    Rest rest{board_, lead_, rules(Between::kIdle)};
    std::int64_t longest_us = 0, last_us = board_.now_us();
    const auto step = [&] {
        longest_us = std::max(longest_us, board_.now_us() - last_us);
        last_us = board_.now_us();
        return true;
    };
    const Woken woken = rest.until({kNoon + kHour, 5}, step);
    EXPECT_EQ(woken.reason, WakeReason::kTime);
    EXPECT_EQ(woken.way, Between::kIdle);
    EXPECT_EQ(board_.now_us(), kNoon + kHour - 30 * kSecond);
    EXPECT_LE(longest_us, 20 * kSecond);
    EXPECT_EQ(board_.suspends, 0);
    EXPECT_FALSE(board_.alarm_us);
}

TEST_F(RestTest, SleepsAndIsThereWhenTheSlotBegins)
{
    Rest rest{board_, lead_, rules(Between::kSuspend)};
    const Woken woken = rest.until({kNoon + kHour, 5}, go_on);
    EXPECT_EQ(woken.reason, WakeReason::kAlarm);
    EXPECT_EQ(woken.way, Between::kSuspend);
    EXPECT_EQ(woken.woken_by.view(), "rtc");
    EXPECT_EQ(board_.suspends, 1);
    EXPECT_GE(woken.asleep_us, kHour - kMinute);
    EXPECT_EQ(board_.now_us(), kNoon + kHour - 30 * kSecond) << "the lead of 30 s, whatever resuming took";
    EXPECT_FALSE(board_.alarm_us);
    EXPECT_TRUE(woken.trouble.empty());
}

TEST_F(RestTest, LearnsHowLongResumingTakes)
{
    Rest rest{board_, lead_, rules(Between::kSuspend)};
    board_.resume_us = 17 * kSecond;
    EXPECT_EQ(rest.until({kNoon + kHour, 1}, go_on).reason, WakeReason::kAlarm);
    EXPECT_EQ(board_.now_us(), kNoon + kHour - 18 * kSecond) << "5 s were planned: 12 s late";
    EXPECT_EQ(rest.until({kNoon + 2 * kHour, 2}, go_on).reason, WakeReason::kAlarm);
    EXPECT_EQ(board_.now_us(), kNoon + 2 * kHour - 30 * kSecond) << "and no more";
}

TEST_F(RestTest, SleepsAgainWhenItIsWokenEarly)
{
    Rest rest{board_, lead_, rules(Between::kSuspend)};
    board_.woken_after_us = 10 * kMinute;
    const Woken woken = rest.until({kNoon + kHour, 5}, go_on);
    EXPECT_EQ(woken.woken_by.view(), "eth0");
    EXPECT_EQ(board_.suspends, 6);
    EXPECT_EQ(board_.now_us(), kNoon + kHour - 30 * kSecond);
}

TEST_F(RestTest, GivesUpOnASleepThatIsWokenAtOnceAndTellsItOnce)
{
    Rest rest{board_, lead_, rules(Between::kSuspend)};
    board_.woken_after_us = 0;
    board_.resume_us = kSecond;
    Woken woken = rest.until({kNoon + kHour, 5}, go_on);
    EXPECT_EQ(board_.suspends, 3);
    EXPECT_EQ(woken.reason, WakeReason::kOther);
    EXPECT_THAT(woken.trouble.c_str(), HasSubstr("woken as soon as it sleeps (by eth0)"));
    EXPECT_EQ(board_.now_us(), kNoon + kHour - 30 * kSecond) << "idled to its end";
    woken = rest.until({kNoon + 2 * kHour, 6}, go_on);
    EXPECT_TRUE(woken.trouble.empty());
    EXPECT_EQ(board_.now_us(), kNoon + 2 * kHour - 30 * kSecond);
}

TEST_F(RestTest, TriesARefusedSleepAgainAndIdlesInTheEnd)
{
    Rest rest{board_, lead_, rules(Between::kSuspend)};
    board_.refusals = 2;
    Woken woken = rest.until({kNoon + kHour, 5}, go_on);
    EXPECT_EQ(board_.suspends, 3);
    EXPECT_EQ(woken.way, Between::kSuspend);
    EXPECT_EQ(woken.trouble.view(), "a device is busy");
    board_.refusals = 1000;
    woken = rest.until({kNoon + 2 * kHour, 6}, go_on);
    EXPECT_EQ(woken.way, Between::kIdle);
    EXPECT_EQ(woken.reason, WakeReason::kTime);
    EXPECT_EQ(board_.suspends, 6);
    EXPECT_TRUE(woken.trouble.empty()) << "told before";
    EXPECT_EQ(board_.now_us(), kNoon + 2 * kHour - 30 * kSecond);
}

TEST_F(RestTest, NeverSleepsWithoutAnAlarm)
{
    for (const Between way : {Between::kSuspend, Between::kOff}) {
        Rest rest{board_, lead_, rules(way)};
        board_.has_rtc = false;
        const std::int64_t due_us = board_.now_us() + kHour;
        const Woken woken = rest.until({due_us, 5}, go_on);
        EXPECT_EQ(woken.reason, WakeReason::kTime);
        EXPECT_EQ(woken.trouble.view(), "no clock");
        EXPECT_EQ(board_.suspends, 0);
        EXPECT_FALSE(exists("power-off"));
        EXPECT_EQ(board_.now_us(), due_us - 30 * kSecond);
    }
}

TEST_F(RestTest, IdlesShortPauses)
{
    for (const Between way : {Between::kSuspend, Between::kOff}) {
        Rest rest{board_, lead_, rules(way)};
        EXPECT_EQ(rest.way_to(board_.now_us() + 2 * kMinute), Between::kIdle);
        EXPECT_EQ(rest.way_to(board_.now_us() - kHour), Between::kIdle);
        EXPECT_EQ(rest.way_to(board_.now_us() + kHour), way);
    }
}

TEST_F(RestTest, EndsAtOnceWhenTheClockIsSet)
{
    Rest idle{board_, lead_, rules(Between::kIdle)};
    int steps = 0;
    const auto set_clock = [&] {
        board_.clock_error_us = ++steps == 3 ? -20 * 365 * 24 * kHour : board_.clock_error_us;
        return true;
    };
    EXPECT_EQ(idle.until({kNoon + kHour, 5}, set_clock).reason, WakeReason::kClockChanged);
    EXPECT_EQ(steps, 3);
    board_.clock_error_us = 0;
    Rest sleeping{board_, lead_, rules(Between::kSuspend)};
    board_.on_wake = [this] { board_.clock_error_us = kHour; };
    EXPECT_EQ(sleeping.until({kNoon + 3 * kHour, 5}, go_on).reason, WakeReason::kClockChanged);
    EXPECT_EQ(board_.suspends, 1);
}

TEST_F(RestTest, EndsWhenItIsAsked)
{
    for (const Between way : {Between::kIdle, Between::kSuspend, Between::kOff}) {
        Rest rest{board_, lead_, rules(way)};
        const std::int64_t began_us = board_.now_us();
        EXPECT_EQ(rest.until({began_us + kHour, 5}, [] { return false; }).reason, WakeReason::kAsked) << name_of(way);
        EXPECT_EQ(board_.now_us(), began_us);
    }
}

TEST_F(RestTest, AsksToBePoweredOffWithTheAlarmSetAndKnowsWhyItIsBack)
{
    Rest rest{board_, lead_, rules(Between::kOff)};
    int steps = 0;
    Woken woken = rest.until({kNoon + kHour, 5}, [&] {
        EXPECT_EQ(exists("power-off"), true);
        EXPECT_EQ(board_.alarm_us, kNoon + kHour - (30 + 90) * kSecond) << "the leads of cameras and boot";
        return ++steps < 2; // the system stops its services
    });
    EXPECT_EQ(woken.reason, WakeReason::kAsked);
    EXPECT_EQ(woken.way, Between::kOff);
    EXPECT_TRUE(board_.alarm_us);

    board_.pass(*board_.alarm_us - board_.now_us() + 4 * kSecond); // the alarm rang, the kernel began
    board_.booted_us = board_.now_us();
    board_.boot_number = 2;
    board_.pass(40 * kSecond);
    LeadTime lead;
    lead.open(folder_.path("").c_str());
    Rest next{board_, lead, rules(Between::kOff)};
    woken = next.begun();
    EXPECT_EQ(woken.reason, WakeReason::kAlarm);
    EXPECT_EQ(woken.way, Between::kOff);
    EXPECT_EQ(lead.of(LeadPart::kBoot), 56 * kSecond) << "44 s, a quarter and one more";

    Rest again{board_, lead, rules(Between::kOff)};
    EXPECT_EQ(again.begun().reason, WakeReason::kOther) << "the program was started again, the board was up";
}

TEST_F(RestTest, DoesNotPowerOffInTheFaceOfWhoSwitchedTheBoardOn)
{
    Rest rest{board_, lead_, rules(Between::kOff)};
    ASSERT_NE(rest.begun().reason, WakeReason::kAlarm);
    const std::int64_t began_us = board_.now_us();
    const Woken woken = rest.until({began_us + 5 * kHour, 5}, [&] {
        EXPECT_FALSE(exists("power-off"));
        return true;
    });
    EXPECT_EQ(woken.reason, WakeReason::kTime);
    EXPECT_EQ(board_.now_us(), began_us + 600 * kSecond) << "ten minutes to log in";
    (void)rest.until({began_us + 5 * kHour, 5}, [&] {
        EXPECT_TRUE(exists("power-off"));
        return false;
    });
}

TEST_F(RestTest, TellsPowerThatCameBackFromTheAlarm)
{
    Rest rest{board_, lead_, rules(Between::kOff)};
    (void)rest.until({kNoon + 5 * kHour, 5}, [] { return false; });
    board_.pass(kHour);
    board_.booted_us = board_.now_us();
    board_.boot_number = 2;
    board_.pass(40 * kSecond);
    const Woken woken = Rest{board_, lead_, rules(Between::kOff)}.begun();
    EXPECT_EQ(woken.reason, WakeReason::kPowerOn);
    EXPECT_EQ(woken.way, Between::kOff);
    EXPECT_EQ(lead_.of(LeadPart::kBoot), 90 * kSecond) << "nothing is learned from that";
}

TEST_F(RestTest, KnowsAFirstStartFromAStartAfterAPowerCut)
{
    EXPECT_EQ((Rest{board_, lead_, rules(Between::kIdle)}.begun().reason), WakeReason::kOther)
        << "installed on a board that is long up";
    EXPECT_EQ((Rest{board_, lead_, rules(Between::kIdle)}.begun().reason), WakeReason::kOther);
    board_.booted_us = board_.now_us();
    board_.boot_number = 2;
    const Woken woken = Rest{board_, lead_, rules(Between::kIdle)}.begun();
    EXPECT_EQ(woken.reason, WakeReason::kPowerOn);
    EXPECT_EQ(woken.way, Between::kIdle);
}

TEST_F(RestTest, WithdrawsARequestThatNobodyAnswers)
{
    Rest rest{board_, lead_, rules(Between::kOff)};
    const Woken woken = rest.until({kNoon + kHour, 5}, go_on);
    EXPECT_EQ(woken.reason, WakeReason::kTime);
    EXPECT_EQ(woken.way, Between::kIdle);
    EXPECT_THAT(woken.trouble.c_str(), HasSubstr("nobody answered the request to power off"));
    EXPECT_FALSE(exists("power-off"));
    EXPECT_FALSE(board_.alarm_us);
    EXPECT_EQ(board_.now_us(), kNoon + kHour - 30 * kSecond);
    EXPECT_EQ((Rest{board_, lead_, rules(Between::kOff)}.begun().reason), WakeReason::kOther);
}

TEST_F(RestTest, GoesOnWhereItCanWriteNothing)
{
    RestRules nowhere = rules(Between::kOff);
    nowhere.state = "/nowhere";
    nowhere.request = "/nowhere/power-off";
    lead_.open("/nowhere");
    Rest rest{board_, lead_, nowhere};
    EXPECT_FALSE(rest.begun().trouble.empty());
    (void)rest.until({kNoon + kHour, 5}, go_on); // the first ten minutes
    EXPECT_EQ(rest.until({kNoon + kHour, 5}, go_on).reason, WakeReason::kTime);
    EXPECT_EQ(board_.now_us(), kNoon + kHour - 30 * kSecond);
    EXPECT_FALSE(open_state_folder("/nowhere/state").ok());
}

/// Whatever happens: a pause ends, never after the slot is to begin by more than a resume, never with an alarm or a
/// request left.
TEST_F(RestTest, EndsInTimeWhateverIsDrawn)
{
    for (unsigned seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 draw{seed};
        const auto below = [&](unsigned n) { return static_cast<std::int64_t>(draw() % n); };
        DrawnBoard board;
        LeadTime lead;
        Rest rest{board, lead, rules(seed < 4 ? Between::kOff : Between::kSuspend)};
        for (std::uint64_t slot = 1; slot < 12; ++slot) {
            board.has_rtc = below(5) != 0;
            board.refusals = board.suspends + static_cast<int>(below(3) * below(4));
            board.resume_us = below(5) * kSecond;
            board.woken_after_us.reset();
            if (below(3) == 0)
                board.woken_after_us = below(40) * kMinute / 4;
            board.on_wake = nullptr;
            if (below(5) == 0)
                board.on_wake = [&] { board.clock_error_us += (below(2000) - 1000) * kMinute; };
            const std::int64_t due_us = board.now_us() + below(200) * kMinute;
            std::int64_t steps = 0;
            const std::int64_t began_us = board.boottime_us();
            const Woken woken = rest.until({due_us, slot}, [&] { return ++steps > 0; });
            EXPECT_GT(steps, 0);
            EXPECT_FALSE(board.alarm_us);
            EXPECT_FALSE(exists("power-off"));
            EXPECT_LE(board.boottime_us() - began_us, 201 * kMinute);
            if (woken.reason != WakeReason::kClockChanged) {
                EXPECT_GE(board.now_us(), due_us - lead.of(LeadPart::kCameras));
                EXPECT_LE(board.now_us(), std::max(due_us - lead.of(LeadPart::kCameras), due_us - 30 * kSecond) +
                                              kMinute + std::max<std::int64_t>(0, began_us + board.booted_us - due_us));
            }
        }
    }
}

/// Sealed, the gate ends a program that asks operator new.
TEST(RestDeathTest, TakesNothingFromTheHeap)
{
    if (!heap_gate::replaces_operator_new())
        GTEST_SKIP() << "the sanitizer has an operator new of its own";
    const TempFolder folder;
    const std::string state = folder.path(""), stage = folder.path("stage"), request = folder.path("power-off");
    const auto rest_once = [&] {
        heap_gate::seal();
        StageWatchRules watched;
        watched.stage_file = stage.c_str();
        StageWatch watch;
        LinuxBoard board{"/nowhere/rtc0", "/nowhere"};
        LeadTime lead;
        lead.open(state.c_str());
        RestRules rules;
        rules.between = Between::kSuspend;
        rules.state = std::string_view{state};
        rules.request = std::string_view{request};
        rules.least_rest_us = 0;
        Rest rest{board, lead, rules};
        CamerasPower cameras{CamerasBetween::kPort, "/nowhere"};
        bool well = watch.open(watched).ok() && cameras.use("1-1", "1-2").ok() && !cameras.off().ok();
        (void)rest.begun();
        well = well && lead.note(LeadPart::kCameras, 0).ok() && lead.note(LeadPart::kResume, 0).ok(); // a second each
        StageWatch::enter("match", kSecond);
        StageWatch::leave();
        const auto step = [] { return true; };
        well = well && !rest.until({board.now_us() + 2'100'000, 1}, step).trouble.empty();
        std::_Exit(well ? 0 : 1);
    };
    EXPECT_EXIT(rest_once(), testing::ExitedWithCode(0), "");
}

TEST(LinuxBoard, IdlesByTheRealClock)
{
    LinuxBoard board{"/nowhere/rtc0"};
    LeadTime lead;
    lead.parse("cameras_ms 0\n"); // a lead of one second
    Rest rest{board, lead, RestRules{}};
    const std::int64_t due_us = board.now_us() + 1'100'000;
    EXPECT_EQ(rest.until({due_us, 1}, [] { return true; }).reason, WakeReason::kTime);
    EXPECT_GE(board.now_us(), due_us - kSecond);
    EXPECT_EQ(board.wake_after(60).fault(), Fault::kUnavailable);
}

} // namespace
} // namespace dicot::app
