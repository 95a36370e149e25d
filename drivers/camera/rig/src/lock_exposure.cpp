#include "dicot/camera_rig/lock_exposure.h"

#include <algorithm>
#include <optional>

namespace dicot {
namespace {

// UVC 1.5, table 4-11 (auto-exposure mode): the bits of kExposureAuto.
constexpr std::int32_t kManualExposure = 1;
constexpr std::int32_t kAutoExposure = 2;
constexpr std::int32_t kAperturePriority = 8; // a fixed iris and automatic time: what webcams have

const ControlRange* range_of(const Camera& camera, ControlId id) noexcept
{
    const std::span<const ControlRange> all = camera.controls();
    const auto at = std::ranges::find(all, id, &ControlRange::id);
    return at == all.end() ? nullptr : &*at;
}

/// Sets controls of one camera until too many were refused.
class Setter
{
public:
    explicit Setter(Camera& camera) noexcept : camera_(camera) {}

    std::optional<std::int32_t> read(ControlId id)
    {
        if (range_of(camera_, id) == nullptr)
            return std::nullopt;
        const Result<std::int32_t> value = camera_.get(id);
        if (value.ok())
            return value.value();
        note(value.status());
        return std::nullopt;
    }

    ControlSide set(ControlId id, std::int32_t wanted)
    {
        if (range_of(camera_, id) == nullptr)
            return {};
        if (refused_ >= kMostRefusedControls)
            return {ControlOutcome::kRefused, 0};
        const Result<std::int32_t> value = camera_.set(id, wanted);
        if (value.ok())
            return {value.value() == wanted ? ControlOutcome::kSet : ControlOutcome::kOther, value.value()};
        note(value.status());
        return {ControlOutcome::kRefused, 0};
    }

    Status verdict() const
    {
        if (refused_ < kMostRefusedControls)
            return {};
        return failure(Fault::kUnavailable, "camera %s: %d of its controls failed, the last with: %s",
                       camera_.identity().port.text, refused_, last_.message());
    }

private:
    void note(const Status& why)
    {
        ++refused_;
        last_ = why;
    }

    Camera& camera_;
    int refused_ = 0;
    Status last_;
};

/// Near `wanted`, and the same on both where both can have it.
std::int32_t common_value(const ControlRange* lead, const ControlRange* other, std::int32_t wanted) noexcept
{
    if (lead == nullptr || other == nullptr)
        return wanted;
    const std::int32_t others = nearest_value(*other, wanted);
    return nearest_value(*lead, others) == others ? others : wanted;
}

} // namespace

const char* name_of(ControlOutcome outcome) noexcept
{
    switch (outcome) {
    case ControlOutcome::kSet:
        return "set";
    case ControlOutcome::kOther:
        return "other value";
    case ControlOutcome::kAbsent:
        return "absent";
    case ControlOutcome::kRefused:
        break;
    }
    return "refused";
}

int ExposureLock::differing() const noexcept
{
    return static_cast<int>(std::ranges::count_if(all(), [](const LockedControl& one) { return !one.alike(); }));
}

Status let_converge(Camera& camera, PowerLine power_line)
{
    Setter setter(camera);
    setter.set(ControlId::kFocusAuto, 0);
    setter.set(ControlId::kPowerLine, static_cast<std::int32_t>(power_line));
    setter.set(ControlId::kExposurePriority, 0);
    setter.set(ControlId::kWhiteBalanceAuto, 1);
    if (setter.set(ControlId::kExposureAuto, kAperturePriority).outcome != ControlOutcome::kSet)
        setter.set(ControlId::kExposureAuto, kAutoExposure);
    return setter.verdict();
}

Result<ExposureLock> lock_exposure(Camera& lead, Camera& other, PowerLine power_line, const Camera** at_fault)
{
    const auto verdict_on = [&](const Setter& setter, const Camera& camera) {
        const Status verdict = setter.verdict();
        if (!verdict.ok() && at_fault != nullptr)
            *at_fault = &camera;
        return verdict;
    };
    Setter of_lead(lead);
    Setter of_other(other);
    constexpr std::array kCopied{ControlId::kExposureTime, ControlId::kGain, ControlId::kWhiteBalance};
    std::array<std::optional<std::int32_t>, kCopied.size()> converged;
    for (std::size_t i = 0; i < kCopied.size(); ++i)
        converged[i] = of_lead.read(kCopied[i]);
    TRY(verdict_on(of_lead, lead));

    ExposureLock lock;
    const auto set_both = [&](ControlId id, std::int32_t wanted) {
        LockedControl& one = lock.controls[static_cast<std::size_t>(lock.count++)];
        one.id = id;
        one.wanted = wanted;
        one.lead = of_lead.set(id, wanted);
        one.other = of_other.set(id, wanted);
    };
    set_both(ControlId::kFocusAuto, 0);
    set_both(ControlId::kPowerLine, static_cast<std::int32_t>(power_line));
    set_both(ControlId::kExposurePriority, 0);
    // A device takes times and temperatures only while it does not choose them itself.
    set_both(ControlId::kExposureAuto, kManualExposure);
    set_both(ControlId::kWhiteBalanceAuto, 0);
    for (std::size_t i = 0; i < kCopied.size(); ++i) {
        const ControlRange* others = range_of(other, kCopied[i]);
        if (converged[i]) {
            set_both(kCopied[i], common_value(range_of(lead, kCopied[i]), others, *converged[i]));
        } else {
            LockedControl& one = lock.controls[static_cast<std::size_t>(lock.count++)];
            one.id = kCopied[i];
            one.lead.outcome =
                range_of(lead, kCopied[i]) == nullptr ? ControlOutcome::kAbsent : ControlOutcome::kRefused;
            if (const std::optional<std::int32_t> value = of_other.read(kCopied[i]))
                one.other = {ControlOutcome::kOther, *value};
            else if (others != nullptr)
                one.other.outcome = ControlOutcome::kRefused;
        }
    }
    TRY(verdict_on(of_lead, lead));
    TRY(verdict_on(of_other, other));
    return lock;
}

Status lock_again(Camera& camera, const ExposureLock& lock, bool is_lead)
{
    Setter setter(camera);
    for (const LockedControl& one : lock.all()) {
        const ControlSide& side = is_lead ? one.lead : one.other;
        if (side.outcome == ControlOutcome::kSet || side.outcome == ControlOutcome::kOther)
            setter.set(one.id, side.value);
    }
    return setter.verdict();
}

} // namespace dicot
