// Both cameras with one exposure: one converges by itself, its values are locked and copied to the other.
#pragma once

#include "dicot/camera/camera.h"

#include <array>
#include <cstdint>
#include <span>

namespace dicot {

/// In UVC's numbers of ControlId::kPowerLine.
enum class PowerLine : std::uint8_t
{
    kOff = 0,
    k50Hz = 1,
    k60Hz = 2,
};

enum class ControlOutcome : std::uint8_t
{
    kSet,     ///< the device has what it was asked for
    kOther,   ///< it says that it has another value
    kAbsent,  ///< it does not have this control
    kRefused, ///< the call failed
};
const char* name_of(ControlOutcome outcome) noexcept;

struct ControlSide
{
    ControlOutcome outcome = ControlOutcome::kAbsent;
    std::int32_t value = 0; ///< as read back, of kSet and kOther
};

/// One control on both cameras.
struct LockedControl
{
    ControlId id{};
    std::int32_t wanted = 0; ///< of a value that `lead` does not tell: 0, and nothing is asked
    ControlSide lead;
    ControlSide other;

    bool alike() const noexcept
    {
        const auto held = [](ControlOutcome outcome) {
            return outcome == ControlOutcome::kSet || outcome == ControlOutcome::kOther;
        };
        if (held(lead.outcome) && held(other.outcome))
            return lead.value == other.value;
        return lead.outcome == ControlOutcome::kAbsent && other.outcome == ControlOutcome::kAbsent;
    }
};

struct ExposureLock
{
    static constexpr int kMostControls = 8;

    std::array<LockedControl, kMostControls> controls{};
    int count = 0;

    std::span<const LockedControl> all() const noexcept { return {controls.data(), static_cast<std::size_t>(count)}; }
    /// How many are not alike.
    int differing() const noexcept;
};

/// So many refused controls of one camera are a camera that is not there: a device may hold each call up for seconds.
constexpr int kMostRefusedControls = 3;

/// Autofocus off, power-line frequency set, exposure and white balance left to the camera: before its warm-up. Controls
/// that it does not have are passed over. Fault::kUnavailable: kMostRefusedControls calls failed.
Status let_converge(Camera& camera, PowerLine power_line);

/// Reads exposure time, gain and white balance of `lead`, after its warm-up; switches the autos of both cameras off and
/// sets these values on both. A value is one that both devices can have, if their ranges hold one near it; what each
/// has in the end is read back. A focus is not copied, since lenses differ. Fault::kUnavailable: kMostRefusedControls
/// calls of one camera failed: the one in `at_fault`.
Result<ExposureLock> lock_exposure(Camera& lead, Camera& other, PowerLine power_line,
                                   const Camera** at_fault = nullptr);

/// Sets once more what lock_exposure() left on one of the cameras, which may have lost it since: a device that was
/// plugged in again begins with its own values. Fault::kUnavailable: kMostRefusedControls calls failed.
Status lock_again(Camera& camera, const ExposureLock& lock, bool is_lead);

} // namespace dicot
