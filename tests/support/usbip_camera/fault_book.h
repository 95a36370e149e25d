// The faults that one camera still has before it.
#pragma once

#include "fault.h"

#include <cstdint>
#include <vector>

namespace dicot::usbip {

class FaultBook
{
public:
    void add(PlannedFault fault) { faults_.push_back(std::move(fault)); }
    void forget() { faults_.clear(); }

    /// Those that stand in frame `frame` of stream `stream`.
    std::vector<PlannedFault> in_frame(std::uint64_t stream, std::int64_t frame) const
    {
        std::vector<PlannedFault> found;
        for (const PlannedFault& fault : faults_)
            if (fault.place == Place::kFrame && (fault.stream == 0 || fault.stream == stream) &&
                (fault.frame < 0 || fault.frame == frame))
                found.push_back(fault);
        return found;
    }

    /// The first fault of `kind` that wants a control request with these numbers to go wrong; it is counted down.
    const PlannedFault* in_request(FaultKind kind, int unit, int selector, int request)
    {
        const auto fits = [](std::int64_t wanted, int number) { return wanted < 0 || wanted == number; };
        for (PlannedFault& fault : faults_) {
            if (fault.kind != kind || fault.left == 0)
                continue;
            if (kind != FaultKind::kRefuseInterface &&
                !(fits(fault["unit"], unit) && fits(fault["selector"], selector) && fits(fault["request"], request)))
                continue;
            if (fault.left > 0)
                --fault.left;
            return &fault;
        }
        return nullptr;
    }

    const PlannedFault* at_plug(FaultKind kind) const
    {
        for (const PlannedFault& fault : faults_)
            if (fault.place == Place::kPlug && fault.kind == kind)
                return &fault;
        return nullptr;
    }

private:
    std::vector<PlannedFault> faults_;
};

} // namespace dicot::usbip
