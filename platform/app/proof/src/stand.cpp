#include "stand.h"

#include "dicot/os/clock.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace dicot::proof {
namespace {

// As much noise around a buffer as is watched for stray writes; beyond it the guard page watches.
constexpr std::size_t kMargin = 256;

} // namespace

const char* word_for(Placement placement)
{
    switch (placement) {
    case Placement::kFirst:
        return "behind a guard page";
    case Placement::kLast:
        return "before a guard page";
    case Placement::kAskew:
        return "unaligned";
    }
    return "";
}

const char* word_for(Filling filling)
{
    switch (filling) {
    case Filling::kRandom:
        return "random";
    case Filling::kZero:
        return "all zero";
    case Filling::kLargest:
        return "all largest";
    case Filling::kExtremes:
        return "zero or largest";
    }
    return "";
}

std::uint32_t draw(Dice& dice, Filling filling, std::uint32_t most)
{
    switch (filling) {
    case Filling::kRandom:
        return dice.up_to(most);
    case Filling::kZero:
        return 0;
    case Filling::kLargest:
        return most;
    case Filling::kExtremes:
        return dice.up_to(1) * most;
    }
    return 0;
}

Result<Stand> Stand::set_up()
{
    Stand stand;
    for (GuardedArea& area : stand.areas_)
        area = TRY(GuardedArea::reserve(kAreaBytes));
    return stand;
}

void Stand::begin(Placement placement)
{
    areas_used_ = outputs_used_ = 0;
    placement_ = placement;
}

void* Stand::place(std::size_t bytes, std::size_t alignment)
{
    const std::span<std::byte> area = areas_.at(areas_used_++).bytes();
    if (bytes + alignment > area.size())
        std::abort(); // a case larger than the stand is a fault of the proof itself
    std::size_t offset = 0;
    if (placement_ == Placement::kLast)
        offset = area.size() - bytes;
    else if (placement_ == Placement::kAskew)
        offset = alignment;
    const std::size_t from = offset > kMargin ? offset - kMargin : 0;
    const std::size_t to = std::min(offset + bytes + kMargin, area.size());
    for (std::size_t i = from; i < to; ++i)
        area[i] = static_cast<std::byte>(90 + 167 * i);
    return area.data() + offset;
}

Stand::Pair Stand::place_twice(std::size_t bytes, std::size_t alignment)
{
    const auto watched = [&](const void* start) {
        const std::span<std::byte> area = areas_.at(areas_used_ - 1).bytes();
        const auto offset = static_cast<std::size_t>(static_cast<const std::byte*>(start) - area.data());
        const std::size_t from = offset > kMargin ? offset - kMargin : 0;
        return area.subspan(from, std::min(offset + bytes + kMargin, area.size()) - from);
    };
    void* const law = place(bytes, alignment);
    const std::span<const std::byte> law_watched = watched(law);
    void* const tested = place(bytes, alignment);
    outputs_.at(outputs_used_++) = {law_watched, watched(tested), static_cast<std::byte*>(law) - law_watched.data()};
    return {law, tested};
}

const char* Stand::trespass(TaskRef tested)
{
    FaultTrap trap;
    return trap.holds(tested) ? "" : "memory outside the buffers was touched";
}

const char* Stand::difference(TaskRef law, TaskRef tested)
{
    law(0);
    if (const char* words = trespass(tested); words[0] != 0)
        return words;
    for (std::size_t o = 0; o < outputs_used_; ++o) {
        const Compared& output = outputs_[o];
        const auto [expected, found] = std::mismatch(output.law.begin(), output.law.end(), output.tested.begin());
        if (expected == output.law.end())
            continue;
        std::snprintf(words_, sizeof words_, "byte %td of output %zu is 0x%02X, the law writes 0x%02X",
                      (expected - output.law.begin()) - output.offset, o, static_cast<unsigned>(*found),
                      static_cast<unsigned>(*expected));
        return words_;
    }
    return "";
}

double best_rate(double units, TaskRef step)
{
    constexpr std::int64_t kRun_us = 3000;
    constexpr int kRuns = 7;
    int batch = 1;
    double best_us = 0;
    for (int run = 0; run < kRuns;) {
        const std::int64_t start = monotonic_us();
        for (int i = 0; i < batch; ++i)
            step(0);
        const std::int64_t taken = monotonic_us() - start;
        if (taken < kRun_us) {
            batch *= 2;
            continue;
        }
        const double each_us = static_cast<double>(taken) / batch;
        if (run == 0 || each_us < best_us)
            best_us = each_us;
        ++run;
    }
    return units * 1e6 / best_us;
}

void note_fault(Verdict& verdict, const char* format, ...)
{
    if (verdict.fault[0] != 0)
        return;
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(verdict.fault, sizeof verdict.fault, format,
                   arguments); // NOLINT(clang-analyzer-valist.Uninitialized)
    va_end(arguments);
}

} // namespace dicot::proof
