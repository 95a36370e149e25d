// What is wrong with a rig, why that may be, and what to do about it.
#pragma once

#include "health_figures.h"
#include "health_history.h"

#include "dicot/base/short_text.h"

#include <array>
#include <cstddef>

namespace dicot::app {

enum class Severity
{
    kNotice,  ///< worth knowing
    kWarning, ///< snapshots are worse than they could be
    kAlarm,   ///< snapshots are lost, or wrong, or soon will be
};

/// "notice", "warning", "alarm".
const char* name_of(Severity severity) noexcept;

struct HealthFlag
{
    const char* id = ""; ///< one word, of the table in platform/app/health/README.md
    Severity severity = Severity::kNotice;
    ShortText<191> cause;  ///< one sentence with the figures
    ShortText<191> action; ///< one sentence: what to do
};

/// In the order of the table; each id at most once.
class HealthFlags
{
public:
    static constexpr std::size_t kMost = 12;

    const HealthFlag* begin() const noexcept { return flags_.data(); }
    const HealthFlag* end() const noexcept { return flags_.data() + size_; }
    std::size_t size() const noexcept { return size_; }
    bool empty() const noexcept { return size_ == 0; }
    void add(const HealthFlag& flag) noexcept;

private:
    std::array<HealthFlag, kMost> flags_{};
    std::size_t size_ = 0;
};

/// `history`: the slots before this one. Pure; no heap.
HealthFlags judge_health(const HealthHistory& history, const HealthFigures& figures) noexcept;

} // namespace dicot::app
