// The newest slots' figures, and what a rig's first residuals were.
#pragma once

#include "health_figures.h"

#include <array>
#include <cstddef>
#include <span>

namespace dicot::app {

/// A fixed ring of the newest snapshots; no heap. Its figures come from the records, so nothing else keeps the trend.
class HealthHistory
{
public:
    static constexpr std::size_t kMost = 64;
    static constexpr std::size_t kReference = 8;

    /// In order of the slots. A miss counts, and is not kept.
    void add(const HealthFigures& figures) noexcept;

    std::size_t size() const noexcept { return size_; }
    bool empty() const noexcept { return size_ == 0; }
    /// 0: the newest.
    const HealthFigures& back(std::size_t before) const noexcept { return ring_[(next_ + kMost - 1 - before) % kMost]; }
    /// Slots missed since the newest snapshot.
    int misses_in_a_row() const noexcept { return misses_; }

    /// The first residuals (median_px) of the calibration of the newest snapshot that had one: what drift is measured
    /// against. They are handed on from record to record, as the first records do not stay for ever.
    std::span<const double> reference_px() const noexcept { return {reference_.data(), references_}; }
    const ShortText<63>& reference_id() const noexcept { return reference_id_; }
    /// As the newest record has it; then add() adds nothing to a full one.
    void set_reference(const ShortText<63>& calibration_id, std::span<const double> medians_px) noexcept;

private:
    std::array<HealthFigures, kMost> ring_{};
    std::size_t next_ = 0;
    std::size_t size_ = 0;
    int misses_ = 0;
    ShortText<63> reference_id_;
    std::array<double, kReference> reference_{};
    std::size_t references_ = 0;
};

} // namespace dicot::app
