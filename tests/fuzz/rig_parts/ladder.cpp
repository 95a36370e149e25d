// The ladder ends, whatever the camera does, and keeps its rules on the way.
#include "parts.h"

#include "dicot/camera_rig/ladder.h"

#include <vector>

namespace dicot::fuzz {
namespace {

constexpr std::int64_t kMostCallUs = std::int64_t{Camera::kMostCallMs} * 1000;
constexpr std::int64_t kMostProofUs = 2'000'000;

/// A camera that answers each shake as the input says, and takes its time. Nothing else of it is used.
class ShakenCamera final : public Camera
{
public:
    ShakenCamera(Numbers& numbers, std::int64_t& now_us) : numbers_(numbers), now_us_(now_us)
    {
        identity_.port.assign("1-1", 3);
    }

    const CameraIdentity& identity() const noexcept override { return identity_; }
    std::span<const CameraMode> modes() const noexcept override { return {}; }
    std::span<const ControlRange> controls() const noexcept override { return {}; }
    Result<std::int32_t> get(ControlId) override { return unused(); }
    Result<std::int32_t> set(ControlId, std::int32_t) override { return unused(); }
    Status start(const CameraMode&) override { return unused(); }
    Result<FrameLease> next(std::int64_t) override { return unused(); }
    Status stop() override { return unused(); }
    void give_back(int) noexcept override {}

    Status shake(Shake how) override
    {
        steps.push_back(how);
        begun_us.push_back(now_us_);
        return answer(kMostCallUs);
    }
    /// Ok for one input byte in four.
    Status answer(std::int64_t most_us)
    {
        const std::uint8_t how = numbers_.byte();
        now_us_ += most_us * (how >> 2) / 63;
        return (how & 3) == 3 ? Status{} : failure(Fault::kTryAgain, "answer %d", how);
    }

    std::vector<Shake> steps;
    std::vector<std::int64_t> begun_us;

private:
    static Status unused() { return failure(Fault::kSoftware, "not of the ladder"); }

    CameraIdentity identity_;
    Numbers& numbers_;
    std::int64_t& now_us_;
};

void require_rules(const ShakenCamera& camera, const LadderRules& rules, std::int64_t since_us)
{
    std::array<int, kShakeCount> tries{};
    for (std::size_t i = 0; i < camera.steps.size(); ++i) {
        require(i == 0 || camera.steps[i] >= camera.steps[i - 1]);
        require(camera.begun_us[i] - since_us < rules.most_us);
        const auto step = static_cast<std::size_t>(camera.steps[i]);
        require(++tries[step] <= rules.tries[step]);
    }
}

} // namespace

void climb_ladder(Numbers& numbers)
{
    LadderRules rules;
    for (std::uint8_t& tries : rules.tries)
        tries = numbers.byte() & 15;
    rules.most_shakes = numbers.byte();
    rules.most_us = numbers.number();
    std::int64_t now_us = numbers.number();
    Ladder ladder{rules};
    std::size_t shakes = 0;
    std::uint32_t recoveries = 0;
    bool gave_up = false;
    for (int failures = 0; failures < 300 && !(gave_up && numbers.empty()); ++failures) {
        ShakenCamera camera{numbers, now_us};
        const std::int64_t since_us = now_us;
        const Status outcome = climb(
            ladder, camera, failure(Fault::kTryAgain, "failure %d", failures),
            [&](Camera&) { return camera.answer(kMostProofUs); }, [&] { return now_us; });
        require_rules(camera, rules, since_us);
        require(camera.steps.empty() || now_us - since_us < rules.most_us + kMostCallUs + kMostProofUs);
        require(!camera.steps.empty() || !outcome.ok());
        require(!gave_up || camera.steps.empty()); // given up is given up
        shakes += camera.steps.size();
        recoveries += outcome.ok() ? 1U : 0U;
        gave_up = !outcome.ok();
        require(gave_up == ladder.figures().gave_up && recoveries == ladder.figures().recoveries);
        if (gave_up) {
            require(outcome.fault() == Fault::kUnavailable);
            require_sentence(outcome.message());
        }
        now_us += numbers.word();
    }
    require(shakes <= rules.most_shakes);
    require(gave_up); // 300 failures are more than most_shakes can be
    std::size_t counted = 0;
    for (const std::uint32_t each : ladder.figures().shakes)
        counted += each;
    require(counted == shakes);
}

} // namespace dicot::fuzz
