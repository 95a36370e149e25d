// What is done with a camera that stopped: restart, reopen, port reset, and then a miss with its reason.
#pragma once

#include "dicot/camera/camera.h"

#include <array>
#include <cstdint>
#include <optional>

namespace dicot {

constexpr int kShakeCount = static_cast<int>(Shake::kPort) + 1;

struct LadderRules
{
    std::array<std::uint8_t, kShakeCount> tries{2, 2, 1}; ///< of each Shake, before the next harder one
    std::uint8_t most_shakes = 12;                        ///< in all; success does not give them back
    std::int64_t most_us = 60'000'000; ///< from a failure on; no step is begun later, none is cut short
};

struct LadderFigures
{
    std::array<std::uint32_t, kShakeCount> shakes{}; ///< of each Shake, over the ladder's life
    std::uint32_t recoveries = 0;
    bool gave_up = false;
    DeviceText<127> first_reason; ///< of the failure that is being climbed from, or of the last one that was
    DeviceText<127> last_reason;
};

/// The state of one camera. Ends: every failure costs one of `most_shakes`, and after giving up it stays so.
class Ladder
{
public:
    explicit Ladder(const LadderRules& rules) noexcept : rules_(rules) {}

    /// The camera failed, `why` says how; `now_us`: any clock that does not go back. None: given up.
    std::optional<Shake> failed(const char* why, std::int64_t now_us) noexcept;
    /// The camera delivers again: the next failure begins at the mildest step, with its whole time.
    void delivered() noexcept;

    const LadderFigures& figures() const noexcept { return figures_; }
    /// Ok unless given up; then Fault::kUnavailable, with the shakes and the reasons. `port` names the camera.
    Status verdict(const char* port) const noexcept;

private:
    LadderRules rules_;
    LadderFigures figures_;
    std::array<std::uint32_t, kShakeCount> tried_{}; ///< since the camera last delivered
    std::uint32_t all_shakes_ = 0;
    bool climbing_ = false;
    std::int64_t since_us_ = 0;
};

/// Ok when a whole frame arrives; else the camera's fault, or the flaw of the last torn frame. Fault::kTryAgain: none
/// until `deadline_us` (monotonic_us()), or among `most_frames`.
Status wait_for_whole_frame(Camera& camera, std::int64_t deadline_us, int most_frames) noexcept;

/// Shakes `camera`, which failed with `why`, until `proof(camera)`, a Status, is ok or the ladder gives up. `now_us()`
/// tells the time. Ends within LadderRules::most_us, one Camera::kMostCallMs and one proof. Fault::kUnavailable: given
/// up, see Ladder::verdict().
template <typename Proof, typename Clock>
Status climb(Ladder& ladder, Camera& camera, const Status& why, Proof&& proof, Clock&& now_us)
{
    Status last = why;
    while (const std::optional<Shake> step = ladder.failed(last.message(), now_us())) {
        last = camera.shake(*step);
        if (last.ok())
            last = proof(camera);
        if (last.ok()) {
            ladder.delivered();
            return {};
        }
    }
    return ladder.verdict(camera.identity().port.text);
}

} // namespace dicot
