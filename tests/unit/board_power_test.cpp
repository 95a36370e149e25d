// The kernel's words for clocks, alarms, sleep and ports: real timers, and folders that stand for /sys.
#include "dicot/os/hardware_watchdog.h"
#include "dicot/os/rtc.h"
#include "dicot/os/suspend.h"
#include "dicot/os/usb_power.h"
#include "dicot/os/wait.h"

#include "temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>

#include <sys/resource.h>
#include <sys/time.h>

namespace dicot {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;
using testing::HasSubstr;

std::string text_of(const std::string& path)
{
    const test::Bytes bytes = test::bytes_of(path);
    return {bytes.begin(), bytes.end()};
}

void make(const TempFolder& sys, const std::string& file, const std::string& text)
{
    fs::create_directories(fs::path{sys.path(file)}.parent_path());
    sys.write(file, text);
}

TEST(Wait, EndsWhenTheClockShowsTheTime)
{
    const std::int64_t until_us = utc_now_us() + 150'000;
    int steps = 0;
    EXPECT_EQ(wait_until(until_us, 40'000, [&] { return ++steps > 0; }), WaitEnd::kTime);
    EXPECT_GE(utc_now_us(), until_us);
    EXPECT_LT(utc_now_us(), until_us + 1'000'000);
    EXPECT_GE(steps, 2) << "one at the start, then one each 40 ms";
    EXPECT_LE(steps, 5);
}

TEST(Wait, IsOverAtOnceForATimeThatIsPast)
{
    int steps = 0;
    EXPECT_EQ(wait_until(utc_now_us() - 1, 1'000'000, [&] { return ++steps > 0; }), WaitEnd::kTime);
    EXPECT_EQ(steps, 1);
}

TEST(Wait, AsksAgainAfterASignal)
{
    static volatile sig_atomic_t heard = 0;
    struct sigaction action
    {
    };
    struct sigaction before
    {
    };
    action.sa_handler = [](int) { heard = 1; };
    action.sa_flags = SA_RESTART;
    ASSERT_EQ(::sigaction(SIGALRM, &action, &before), 0);
    const itimerval soon{{0, 0}, {0, 50'000}};
    const std::int64_t began_us = boottime_us();
    ASSERT_EQ(::setitimer(ITIMER_REAL, &soon, nullptr), 0);
    EXPECT_EQ(wait_until(utc_now_us() + 60'000'000, 60'000'000, [] { return heard == 0; }), WaitEnd::kAsked);
    EXPECT_LT(boottime_us() - began_us, 10'000'000);
    (void)::sigaction(SIGALRM, &before, nullptr);
}

TEST(Boot, HasANameOf36CharactersOrNone)
{
    EXPECT_EQ(std::string{boot_id().text}.size(), 36U);
    EXPECT_STREQ(boot_id("/nowhere").text, "");
}

class RtcFolder : public testing::Test
{
protected:
    TempFolder sys_;
    std::string device_ = sys_.path("rtc7"); // a file: whoever asks it for a clock's words hears ENOTTY
    Rtc rtc_{device_.c_str(), sys_.path("").c_str()};
    std::string wake_ = "class/rtc/rtc7/wakealarm";
};

TEST_F(RtcFolder, FallsBackToTheFilesOfTheKernel)
{
    sys_.write("rtc7", "");
    make(sys_, "class/rtc/rtc7/since_epoch", "1780000000\n");
    make(sys_, wake_, "");
    ASSERT_TRUE(rtc_.now_s().ok());
    EXPECT_EQ(rtc_.now_s().value(), 1'780'000'000);
    ASSERT_TRUE(rtc_.alarm_s().ok());
    EXPECT_FALSE(rtc_.alarm_s().value());
    ASSERT_TRUE(rtc_.wake_after(3600).ok());
    EXPECT_EQ(text_of(sys_.path(wake_)), "+3600");
    ASSERT_TRUE(rtc_.no_alarm().ok());
    EXPECT_EQ(text_of(sys_.path(wake_)), "0");
}

TEST_F(RtcFolder, ThatIsNotThereIsNamedWithTheRemedy)
{
    const Status why = rtc_.wake_after(60);
    EXPECT_EQ(why.fault(), Fault::kUnavailable);
    EXPECT_THAT(why.message(), HasSubstr("rtc7: the board has no such clock; name its clock in power.rtc"));
    EXPECT_EQ(rtc_.now_s().status().fault(), Fault::kUnavailable);
    EXPECT_EQ(rtc_.alarm_s().status().fault(), Fault::kUnavailable);
}

TEST(Suspend, WritesTheDeepestSleepThatIsOffered)
{
    for (const auto& [offered, written] : {std::pair{"freeze mem disk\n", "mem"}, {"freeze standby\n", "freeze"}}) {
        const TempFolder sys;
        make(sys, "power/state", offered);
        ASSERT_TRUE(can_suspend(sys.path("").c_str()).ok());
        const Result<Slept> slept = suspend_board(sys.path("").c_str());
        ASSERT_TRUE(slept.ok()) << slept.status().message();
        EXPECT_EQ(text_of(sys.path("power/state")), written);
        EXPECT_LT(slept.value().asleep_us, 1'000'000) << "nothing slept";
    }
}

TEST(Suspend, NamesWhatWokeTheBoard)
{
    const TempFolder sys;
    make(sys, "power/state", "mem\n");
    make(sys, "power/pm_wakeup_irq", "43\n");
    Result<Slept> slept = suspend_board(sys.path("").c_str());
    ASSERT_TRUE(slept.ok());
    EXPECT_EQ(slept.value().woken_by.view(), "43");
    make(sys, "kernel/irq/43/actions", "rtc-pl031\n");
    sys.write("power/state", "mem\n");
    ASSERT_TRUE(suspend_board(sys.path("").c_str()).ok());
    EXPECT_EQ(suspend_board(sys.path("").c_str()).value().woken_by.view(), "rtc-pl031");
}

TEST(Suspend, OfABoardThatOffersNoneIsRefused)
{
    const TempFolder sys;
    EXPECT_EQ(suspend_board(sys.path("").c_str()).status().fault(), Fault::kUnavailable);
    make(sys, "power/state", "disk memory\n"); // "mem" as a word, not as a beginning
    EXPECT_EQ(suspend_board(sys.path("").c_str()).status().fault(), Fault::kUnavailable);
    EXPECT_EQ(text_of(sys.path("power/state")), "disk memory\n");
}

TEST(Suspend, SaysWhichDeviceRefused)
{
    const TempFolder sys;
    make(sys, "power/state", "mem\n");
    make(sys, "power/suspend_stats/last_failed_dev", "1-1.2\n");
    // A process that may write no byte more meets a file that says "mem" and takes nothing.
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit nothing{0, before.rlim_max};
    (void)std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &nothing), 0);
    const Status why = suspend_board(sys.path("").c_str()).status();
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    (void)std::signal(SIGXFSZ, SIG_DFL);
    EXPECT_EQ(why.fault(), Fault::kTryAgain);
    EXPECT_THAT(why.message(), HasSubstr("the last device that refused is 1-1.2"));
}

TEST(HardwareWatchdog, IsNotMadeOfAnyFile)
{
    const TempFolder folder;
    HardwareWatchdog dog;
    EXPECT_EQ(dog.open(folder.write("file", "kept").c_str(), 180).fault(), Fault::kConfig);
    EXPECT_EQ(text_of(folder.path("file")), "kept");
    EXPECT_EQ(dog.open(folder.path("none").c_str(), 180).fault(), Fault::kUnavailable);
    EXPECT_FALSE(dog.held());
}

TEST(UsbPower, FindsTheFilesOfAPortByItsName)
{
    const TempFolder sys;
    const std::string root = sys.path("");
    // As Linux 6.1 has them: a camera in port 2 of a hub in port 1 of bus 1, and one in a port of the root hub of
    // bus 3.
    make(sys, "bus/usb/devices/1-1:1.0/1-1-port2/disable", "0\n");
    make(sys, "bus/usb/devices/3-0:1.0/usb3-port4/disable", "0\n");
    make(sys, "bus/usb/devices/3-0:1.0/usb3-port4/peer/disable", "0\n");
    for (const char* port : {"1-1.2", "3-4"}) {
        Result<UsbPower> power = UsbPower::at(port, root.c_str());
        ASSERT_TRUE(power.ok());
        EXPECT_TRUE(power.value().can_switch().ok()) << power.value().can_switch().message();
        EXPECT_TRUE(power.value().off().ok());
    }
    EXPECT_EQ(text_of(sys.path("bus/usb/devices/1-1:1.0/1-1-port2/disable")), "1");
    EXPECT_EQ(text_of(sys.path("bus/usb/devices/3-0:1.0/usb3-port4/disable")), "1");
    EXPECT_EQ(text_of(sys.path("bus/usb/devices/3-0:1.0/usb3-port4/peer/disable")), "1") << "the socket's other half";
    EXPECT_TRUE(UsbPower::at("3-4", root.c_str()).value().on().ok());
    EXPECT_EQ(text_of(sys.path("bus/usb/devices/3-0:1.0/usb3-port4/peer/disable")), "0");
}

TEST(UsbPower, OfAHubThatTakesNoOrdersSaysSo)
{
    const TempFolder sys;
    Result<UsbPower> power = UsbPower::at("1-1.2", sys.path("").c_str());
    ASSERT_TRUE(power.ok());
    EXPECT_EQ(power.value().off().fault(), Fault::kUnavailable);
    EXPECT_THAT(power.value().off().message(), HasSubstr("its hub 1-1 takes no orders for single ports"));
}

TEST(UsbPower, LetsTheKernelPutACameraToSleep)
{
    const TempFolder sys;
    make(sys, "bus/usb/devices/1-2/power/control", "on\n");
    make(sys, "bus/usb/devices/1-2/power/autosuspend_delay_ms", "-1000\n");
    make(sys, "bus/usb/devices/1-2/power/runtime_status", "suspended\n");
    Result<UsbPower> power = UsbPower::at("1-2", sys.path("").c_str());
    ASSERT_TRUE(power.ok());
    EXPECT_TRUE(power.value().let_sleep(2000).ok());
    EXPECT_EQ(text_of(sys.path("bus/usb/devices/1-2/power/control")), "auto");
    EXPECT_EQ(text_of(sys.path("bus/usb/devices/1-2/power/autosuspend_delay_ms")), "2000");
    EXPECT_TRUE(power.value().sleeps().value());
    EXPECT_EQ(UsbPower::at("1-3", sys.path("").c_str()).value().let_sleep(2000).fault(), Fault::kUnavailable);
}

TEST(UsbPower, RefusesWhatIsNoPort)
{
    for (const char* name :
         {"", "1", "1-", "-1", "1-1.", "1.1", "1-1-1", "1-1..2", "../1-1", "1-1.2/", "1-1234", "a-1"})
        EXPECT_EQ(UsbPower::at(name).status().fault(), Fault::kConfig) << name;
    for (const char* name : {"1-1", "12-3.4.5"})
        EXPECT_TRUE(UsbPower::at(name).ok()) << name;
}

TEST(UsbPower, WaitsForADeviceNoLongerThanTold)
{
    const TempFolder sys;
    make(sys, "bus/usb/devices/1-2/bConfigurationValue", "1\n");
    EXPECT_TRUE(wait_for_device("1-2", 0, sys.path("").c_str()).ok());
    const std::int64_t began_us = boottime_us();
    EXPECT_EQ(wait_for_device("1-3", 120, sys.path("").c_str()).fault(), Fault::kTryAgain);
    EXPECT_GE(boottime_us() - began_us, 120'000);
    make(sys, "bus/usb/devices/1-4/bConfigurationValue", "\n"); // there, and not configured yet
    EXPECT_EQ(wait_for_device("1-4", 0, sys.path("").c_str()).fault(), Fault::kTryAgain);
}

} // namespace
} // namespace dicot
