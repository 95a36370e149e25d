#include "dicot/camera_rig/lock_exposure.h"
#include "dicot/replay/replay_camera.h"
#include "picture_bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace dicot {
namespace {

using testing::HasSubstr;

constexpr const char* kWebcam = "control exposure_auto 1 8 1 8; control exposure_time 3 2047 1 250\n"
                                "control exposure_priority 0 1 1 1; control gain 0 255 1 64\n"
                                "control white_balance_auto 0 1 1 1; control white_balance 2000 7500 10 4000\n"
                                "control power_line 0 2 1 2; control focus_auto 0 1 1 1\n";

/// Two cameras of recorded pictures whose controls behave as their scripts say.
class CameraRigLockExposure : public testing::Test
{
protected:
    void SetUp() override
    {
        test::Bytes file = test::text_bytes("P6 4 2 255\n");
        test::append(file, test::Bytes(24, 90));
        path_ = folder_.write("left.ppm", file);
        files_[0] = path_.c_str();
    }
    void open(ReplayCamera& camera, const std::string& script)
    {
        const Result<ReplayScript> parsed = parse_replay_script(script, "test");
        ASSERT_TRUE(parsed.ok()) << parsed.status().message();
        ASSERT_TRUE(camera.open(files_, {.script = parsed.value(), .virtual_now_us = &now_us_}).ok());
    }
    void open_both(const std::string& lead, const std::string& other)
    {
        open(lead_, lead);
        open(other_, other);
    }
    void unplug(ReplayCamera& camera)
    {
        ASSERT_TRUE(camera.start(camera.modes()[0]).ok());
        ASSERT_EQ(camera.next(now_us_ + 500'000).status().fault(), Fault::kUnavailable);
    }
    static void put(ReplayCamera& camera, ControlId id, std::int32_t value) { ASSERT_TRUE(camera.set(id, value).ok()); }
    static std::int32_t value_of(ReplayCamera& camera, ControlId id)
    {
        const Result<std::int32_t> value = camera.get(id);
        EXPECT_TRUE(value.ok()) << value.status().message();
        return value.ok() ? value.value() : -1;
    }
    static LockedControl control(const ExposureLock& lock, ControlId id)
    {
        for (const LockedControl& one : lock.all())
            if (one.id == id)
                return one;
        ADD_FAILURE() << name_of(id) << " was not locked";
        return {};
    }

    const test::TempFolder folder_;
    std::string path_;
    std::vector<const char*> files_{nullptr};
    std::int64_t now_us_ = 0;
    ReplayCamera lead_;
    ReplayCamera other_;
};

TEST_F(CameraRigLockExposure, ConvergingLeavesLightToTheCameraAndFocusNot)
{
    open(lead_, kWebcam);
    put(lead_, ControlId::kExposureAuto, 1);
    put(lead_, ControlId::kWhiteBalanceAuto, 0);
    ASSERT_TRUE(let_converge(lead_, PowerLine::k50Hz).ok());
    EXPECT_EQ(value_of(lead_, ControlId::kExposureAuto), 8);
    EXPECT_EQ(value_of(lead_, ControlId::kWhiteBalanceAuto), 1);
    EXPECT_EQ(value_of(lead_, ControlId::kExposurePriority), 0);
    EXPECT_EQ(value_of(lead_, ControlId::kFocusAuto), 0);
    EXPECT_EQ(value_of(lead_, ControlId::kPowerLine), 1);
}

TEST_F(CameraRigLockExposure, ACameraWithAnIrisConvergesInFullAuto)
{
    open(lead_, "control exposure_auto 1 2 1 1");
    ASSERT_TRUE(let_converge(lead_, PowerLine::k60Hz).ok());
    EXPECT_EQ(value_of(lead_, ControlId::kExposureAuto), 2);
}

TEST_F(CameraRigLockExposure, TheOtherCameraGetsWhatTheLeadConvergedTo)
{
    open_both(kWebcam, kWebcam);
    put(lead_, ControlId::kExposureTime, 333);
    put(lead_, ControlId::kGain, 17);
    put(lead_, ControlId::kWhiteBalance, 5210);
    const Result<ExposureLock> lock = lock_exposure(lead_, other_, PowerLine::k50Hz);
    ASSERT_TRUE(lock.ok()) << lock.status().message();
    EXPECT_EQ(lock.value().differing(), 0);
    EXPECT_EQ(lock.value().count, 8);
    for (ReplayCamera* camera : {&lead_, &other_}) {
        EXPECT_EQ(value_of(*camera, ControlId::kExposureTime), 333);
        EXPECT_EQ(value_of(*camera, ControlId::kGain), 17);
        EXPECT_EQ(value_of(*camera, ControlId::kWhiteBalance), 5210);
        EXPECT_EQ(value_of(*camera, ControlId::kExposureAuto), 1);
        EXPECT_EQ(value_of(*camera, ControlId::kWhiteBalanceAuto), 0);
        EXPECT_EQ(value_of(*camera, ControlId::kFocusAuto), 0);
        EXPECT_EQ(value_of(*camera, ControlId::kPowerLine), 1);
    }
    EXPECT_EQ(control(lock.value(), ControlId::kGain).lead.outcome, ControlOutcome::kSet);
    EXPECT_EQ(control(lock.value(), ControlId::kGain).other.outcome, ControlOutcome::kSet);
}

TEST_F(CameraRigLockExposure, AValueThatOneCannotHaveIsTakenFromTheOtherForBoth)
{
    open_both("control gain 0 255 1 64; control exposure_time 1 5000 1 156",
              "control gain 0 100 10 50; control exposure_time 1 5000 1 156");
    put(lead_, ControlId::kGain, 188);
    const Result<ExposureLock> lock = lock_exposure(lead_, other_, PowerLine::k50Hz);
    ASSERT_TRUE(lock.ok());
    EXPECT_EQ(value_of(lead_, ControlId::kGain), 100);
    EXPECT_EQ(value_of(other_, ControlId::kGain), 100);
    EXPECT_EQ(lock.value().differing(), 0);
}

TEST_F(CameraRigLockExposure, RangesWithNothingInCommonDiffer)
{
    open_both("control gain 0 50 1 10", "control gain 60 90 1 70");
    const Result<ExposureLock> lock = lock_exposure(lead_, other_, PowerLine::k50Hz);
    ASSERT_TRUE(lock.ok());
    const LockedControl gain = control(lock.value(), ControlId::kGain);
    EXPECT_EQ(gain.wanted, 10);
    EXPECT_EQ(gain.lead.value, 10);
    EXPECT_EQ(gain.other.outcome, ControlOutcome::kOther);
    EXPECT_EQ(gain.other.value, 60);
    EXPECT_EQ(lock.value().differing(), 1);
}

TEST_F(CameraRigLockExposure, AStuckControlIsToldWithTheValueThatItReallyHas)
{
    open_both("control exposure_time 1 5000 1 156", "control exposure_time 1 5000 1 400 stuck");
    const Result<ExposureLock> lock = lock_exposure(lead_, other_, PowerLine::k50Hz);
    ASSERT_TRUE(lock.ok());
    const LockedControl time = control(lock.value(), ControlId::kExposureTime);
    EXPECT_EQ(time.wanted, 156);
    EXPECT_EQ(time.lead.outcome, ControlOutcome::kSet);
    EXPECT_EQ(time.other.outcome, ControlOutcome::kOther);
    EXPECT_EQ(time.other.value, 400);
    EXPECT_FALSE(time.alike());
    EXPECT_EQ(lock.value().differing(), 1);
}

TEST_F(CameraRigLockExposure, AControlOfOneCameraAloneDiffersAndOfNoneDoesNot)
{
    open_both("control exposure_time 1 5000 1 156", "control exposure_time 1 5000 1 400; control gain 0 9 1 5");
    const Result<ExposureLock> lock = lock_exposure(lead_, other_, PowerLine::k50Hz);
    ASSERT_TRUE(lock.ok());
    const LockedControl gain = control(lock.value(), ControlId::kGain);
    EXPECT_EQ(gain.lead.outcome, ControlOutcome::kAbsent);
    EXPECT_EQ(gain.other.value, 5);
    EXPECT_FALSE(gain.alike());
    EXPECT_TRUE(control(lock.value(), ControlId::kWhiteBalance).alike());
    EXPECT_EQ(lock.value().differing(), 1);
}

TEST_F(CameraRigLockExposure, ACameraThatIsGoneIsAFaultWithItsCause)
{
    open_both(kWebcam, std::string(kWebcam) + "gone 0");
    unplug(other_);
    const Result<ExposureLock> lock = lock_exposure(lead_, other_, PowerLine::k50Hz);
    EXPECT_EQ(lock.status().fault(), Fault::kUnavailable);
    EXPECT_THAT(lock.status().message(), HasSubstr("3 of its controls failed, the last with: "));
    EXPECT_EQ(lock_exposure(other_, lead_, PowerLine::k50Hz).status().fault(), Fault::kUnavailable);
    EXPECT_EQ(let_converge(other_, PowerLine::k50Hz).fault(), Fault::kUnavailable);
}

TEST_F(CameraRigLockExposure, AFewRefusedControlsAreToldAsSuch)
{
    open_both("control gain 0 9 1 3", "control gain 0 9 1 3; gone 0");
    unplug(other_);
    const Result<ExposureLock> lock = lock_exposure(lead_, other_, PowerLine::k50Hz);
    ASSERT_TRUE(lock.ok()) << lock.status().message();
    EXPECT_EQ(control(lock.value(), ControlId::kGain).other.outcome, ControlOutcome::kRefused);
    EXPECT_FALSE(control(lock.value(), ControlId::kGain).alike());
    const Result<ExposureLock> swapped = lock_exposure(other_, lead_, PowerLine::k50Hz);
    ASSERT_TRUE(swapped.ok()) << swapped.status().message();
    EXPECT_EQ(control(swapped.value(), ControlId::kGain).lead.outcome, ControlOutcome::kRefused);
    EXPECT_EQ(control(swapped.value(), ControlId::kGain).other.value, 3);
}

} // namespace
} // namespace dicot
