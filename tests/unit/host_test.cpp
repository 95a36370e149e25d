// What a computer tells of itself: how far its clock can be believed, and how warm it is.
#include "dicot/base/utc_time.h"
#include "dicot/os/clock_trust.h"
#include "dicot/os/host.h"

#include "temp_folder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>

namespace dicot {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kDayUs = std::int64_t{86'400} * 1'000'000;

TEST(ClockTrust, AClockOf1970IsNotSet)
{
    const ClockReading woken = judge_clock(17'000'000, {}, {});
    EXPECT_EQ(woken.trust, ClockTrust::kNotSet);
    EXPECT_STREQ(name_of(woken.trust), "not set");
    EXPECT_FALSE(woken.most_error_us);
}

TEST(ClockTrust, ATimeThatIsOverIsNotSetAndLaterOnesAre)
{
    const std::int64_t later = built_us() + 40 * kDayUs;
    EXPECT_EQ(judge_clock(built_us() - 1, {}, {}).trust, ClockTrust::kNotSet);
    EXPECT_EQ(judge_clock(built_us(), {}, {}).trust, ClockTrust::kSet);
    EXPECT_EQ(judge_clock(later - 1, {}, later).trust, ClockTrust::kNotSet);
    EXPECT_EQ(judge_clock(later, {}, later).trust, ClockTrust::kSet);
}

TEST(ClockTrust, ASteeredClockIsSynchronisedWithTheKernelsBound)
{
    const ClockReading steered = judge_clock(built_us() + kDayUs, 2500, built_us() + 2 * kDayUs);
    EXPECT_EQ(steered.trust, ClockTrust::kSynchronised);
    EXPECT_EQ(steered.most_error_us, 2500);
}

TEST(ClockTrust, TheProgramWasBuiltBeforeItRunsAndTheReadingIsOfNow)
{
    const auto now =
        std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
            .count();
    EXPECT_GT(built_us(), parse_utc_text("2025-01-01T00:00:00Z").value());
    EXPECT_LE(built_us(), now);
    const ClockReading reading = read_clock({});
    EXPECT_GE(reading.now_us, now);
    EXPECT_LT(reading.now_us, now + kDayUs);
    EXPECT_NE(reading.trust, ClockTrust::kNotSet);
    EXPECT_EQ(reading.most_error_us.has_value(), reading.trust == ClockTrust::kSynchronised);
}

class Sensors : public testing::Test
{
protected:
    void sensor(const std::string& path, const std::string& text) const
    {
        fs::create_directories(fs::path(sys_.path("class/" + path)).parent_path());
        sys_.write("class/" + path, text);
    }
    std::vector<Temperature> read() const { return read_temperatures(sys_.path("")); }

    test::TempFolder sys_;
};

TEST_F(Sensors, AreNamedByTypeOrByChipAndLabel)
{
    sensor("thermal/thermal_zone0/type", "cpu-thermal\n");
    sensor("thermal/thermal_zone0/temp", "48312\n");
    sensor("hwmon/hwmon1/name", "coretemp\n");
    sensor("hwmon/hwmon1/temp1_input", "-5500\n");
    sensor("hwmon/hwmon1/temp2_label", "Package id 0\n");
    sensor("hwmon/hwmon1/temp2_input", "61000\n");
    sensor("hwmon/hwmon1/fan1_input", "1200\n");
    const std::vector<Temperature> all = read();
    ASSERT_EQ(all.size(), 3U);
    EXPECT_EQ(all[0].name, "thermal/cpu-thermal");
    EXPECT_DOUBLE_EQ(all[0].celsius, 48.312);
    EXPECT_EQ(all[1].name, "hwmon/coretemp/temp1");
    EXPECT_DOUBLE_EQ(all[1].celsius, -5.5);
    EXPECT_EQ(all[2].name, "hwmon/coretemp/Package id 0");
}

TEST_F(Sensors, OfOneNameAreToldApart)
{
    for (const char* zone : {"thermal_zone0", "thermal_zone1"}) {
        sensor(std::string("thermal/") + zone + "/type", "soc");
        sensor(std::string("thermal/") + zone + "/temp", "20000");
    }
    const std::vector<Temperature> all = read();
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].name, "thermal/soc");
    EXPECT_EQ(all[1].name, "thermal/soc 2");
}

TEST_F(Sensors, ThatSayNothingSensibleAreLeftOut)
{
    EXPECT_TRUE(read().empty());
    sensor("thermal/thermal_zone0/type", "broken");
    for (const char* text : {"", "n/a", "400000", "-273150", "99999999999999", "1e3"}) {
        sensor("thermal/thermal_zone0/temp", text);
        EXPECT_TRUE(read().empty()) << text;
    }
    sensor("thermal/thermal_zone0/type", "a\x01\xFF");
    sensor("thermal/thermal_zone0/temp", "1000");
    ASSERT_EQ(read().size(), 1U);
    EXPECT_EQ(read()[0].name, "thermal/a??");
}

} // namespace
} // namespace dicot
