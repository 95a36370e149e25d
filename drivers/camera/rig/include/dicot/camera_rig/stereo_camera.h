// Two cameras as one: from switching on to whole pairs, with a bound on every wait.
#pragma once

#include "dicot/camera/bandwidth.h"
#include "dicot/camera/camera.h"
#include "dicot/camera_rig/ladder.h"
#include "dicot/camera_rig/lock_exposure.h"
#include "dicot/camera_rig/pairing.h"
#include "dicot/camera_rig/settling.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

namespace dicot {

/// Chooses the modes of both cameras, and prepares their drivers for them.
class ModePlanner
{
public:
    /// `refused` as of plan_bandwidth().
    virtual BandwidthPlan plan(int refused) = 0;

protected:
    ~ModePlanner() = default;
};

struct StereoRules
{
    LadderRules ladder;
    SettlingRules settling;
    bool lock_exposure = true; ///< false: both cameras stay automatic
    PowerLine power_line = PowerLine::k50Hz;
    bool one_after_the_other = true;      ///< allowed where both do not fit on their bus
    std::int64_t patience_us = 3'000'000; ///< without a frame for so long a camera has failed
    int most_torn = 30;                   ///< so many torn frames in a row too
    int frames_after_start = 4;           ///< of each new stream, passed over: sensors begin dark or green
    /// Older frames are passed over, for work that is to be live, if they are older than three intervals too; 0: any
    /// age will do.
    std::int64_t most_age_us = 0;
    std::int64_t* virtual_now_us = nullptr;  ///< the clock of replay cameras; null: monotonic_us()
    bool (*stop_asked)() noexcept = nullptr; ///< asked before each frame: whether somebody wants an end
};

/// What a camera delivered since it was opened.
struct SideFigures
{
    std::uint64_t whole = 0;
    std::uint64_t torn = 0;
    std::uint64_t cancelled = 0;
    std::uint64_t warming_up = 0; ///< whole, but before the picture was steady
    std::uint64_t lost = 0;
    DeviceText<63> last_flaw; ///< of the last torn frame
    SettlingFigures settling; ///< of the last phase of the warm-up
    bool settled = true;      ///< no phase reached its bound
    LadderFigures ladder;
};

struct StereoFigures
{
    SideFigures left, right;
    BandwidthPlan plan;
    int refused = 0; ///< plans that the bus or a camera did not carry
    std::optional<ExposureLock> lock;
};

struct StereoFrames
{
    FrameLease left;
    FrameLease right;
    std::int64_t skew_us = 0; ///< start of the right frame minus start of the left one
};

/// Neither call waits for ever: each frame is waited for StereoRules::patience_us, each failure costs one of
/// LadderRules::most_shakes, and the warm-up has the bound of SettlingRules. Each of them ends with Fault::kTryAgain
/// soon after StereoRules::stop_asked() says so.
class StereoCamera
{
public:
    /// Plans that are tried before the cameras are given up.
    static constexpr int kMostRefusals = 16;

    StereoCamera(Camera& left, Camera& right, const StereoRules& rules) noexcept;
    StereoCamera(const StereoCamera&) = delete;
    StereoCamera& operator=(const StereoCamera&) = delete;
    ~StereoCamera();

    /// Streams in the first modes that bus and cameras carry, each proven by a whole frame. A camera that is silent is
    /// asked once more, then for less, then shaken. Fault::kUnavailable: no plan, or a camera that stays dead; the
    /// sentence has the reasons.
    Status start(ModePlanner& planner);

    /// Exposure, gain and white balance are left to the cameras, autofocus is off. Devices keep what they were told by
    /// whoever had them before. Fault::kUnavailable: a camera's controls fail for good.
    Status let_converge();

    /// Until both pictures are as bright as they will stay, with one exposure (StereoRules::lock_exposure): the left
    /// camera converges, the right one gets its values. The bound holds for both phases together, but that the second
    /// one has 2 s at least; reaching it is no failure: the figures say so. Fault::kUnavailable: a camera stays dead.
    Status warm_up();

    /// Frames that began before now are passed over: the buffers may hold what was long ago.
    void skip_to_now() noexcept { not_before_us_ = now_us(); }

    /// The next pair: of the frames that neighbour each other the two whole ones that began nearest to each other. One
    /// after the other: a frame of each, the streams started and stopped in between. Fault::kUnavailable: a camera
    /// stays dead; the sentence is a miss's reason.
    Result<StereoFrames> next();

    /// Ends both streams; leases that are out stay readable.
    Status stop();

    const StereoFigures& figures() noexcept;
    bool one_at_a_time() const noexcept { return figures_.plan.together == Together::kOneAfterTheOther; }
    std::int64_t now_us() const noexcept;

private:
    struct Side
    {
        Camera* camera = nullptr;
        SideFigures* figures = nullptr;
        const PlannedStream* planned = nullptr;
        Ladder ladder;
        bool streams = false;
        int fresh = 0;                     ///< frames that are still to be passed over
        std::optional<FrameLease> ahead{}; ///< looked at, and not yet used
    };
    /// How far a plan got.
    struct Attempt
    {
        Status status;
        Side* side = nullptr; ///< whose fault it is
        bool streamed = false;
    };

    Status begin(Side& side);
    Status end(Side& side);
    Attempt try_plan();
    Status recover(Side& side, const Status& why);
    Result<FrameLease> look(Side& side);
    Result<FrameLease> whole_frame(Side& side);
    /// What may fail because the camera does: it is shaken, and the work done once more.
    template <typename Work>
    Status insist(Side& side, Work&& work)
    {
        const Status status = work();
        if (status.ok())
            return status;
        TRY(recover(side, status));
        return work();
    }
    Result<FrameLease> first_frame(Side& side);
    Status stopped() const noexcept;
    Status settle(std::span<Side* const> sides, std::int64_t most_us);
    Status converge(Side& side);
    Status lock();
    Status warm_up_at_once();
    Status warm_up_in_turn();
    Result<FrameLease> frame_in_turn(Side& side);
    Result<StereoFrames> next_at_once();
    Result<StereoFrames> next_in_turn();
    void count(Side& side, const Frame& frame);

    StereoRules rules_;
    StereoFigures figures_;
    Side left_;
    Side right_;
    bool warming_ = false;
    std::int64_t not_before_us_ = std::numeric_limits<std::int64_t>::min();
};

} // namespace dicot
