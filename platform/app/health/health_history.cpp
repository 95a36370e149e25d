#include "health_history.h"

#include <algorithm>

namespace dicot::app {

void HealthHistory::add(const HealthFigures& figures) noexcept
{
    if (!figures.done) {
        ++misses_;
        return;
    }
    misses_ = 0;
    ring_[next_] = figures;
    next_ = (next_ + 1) % kMost;
    size_ = std::min(size_ + 1, kMost);
    if (!figures.epipolar)
        return;
    if (!(figures.calibration_id == reference_id_)) {
        reference_id_ = figures.calibration_id;
        references_ = 0;
    }
    if (references_ < kReference)
        reference_[references_++] = figures.epipolar->median_px;
}

void HealthHistory::set_reference(const ShortText<63>& calibration_id, std::span<const double> medians_px) noexcept
{
    reference_id_ = calibration_id;
    references_ = std::min(medians_px.size(), kReference);
    std::copy_n(medians_px.begin(), references_, reference_.begin());
}

} // namespace dicot::app
