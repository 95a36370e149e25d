#include "dicot/pull_archive/number_ranges.h"

#include "dicot/record/record.h"

#include <algorithm>
#include <charconv>
#include <iterator>

namespace dicot {
namespace {

/// One number of at most nine digits without a leading zero, taken away from `text`.
std::optional<std::int64_t> take_number(std::string_view& text)
{
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || text.front() == '0' || number < 1 || number > kMaxSequence)
        return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

} // namespace

void NumberRanges::add_range(NumberRange range)
{
    if (range.last < range.first)
        return;
    if (!ranges_.empty() && range.first <= ranges_.back().last + 1)
        ranges_.back().last = std::max(ranges_.back().last, range.last);
    else
        ranges_.push_back(range);
}

void NumberRanges::add(std::int64_t number)
{
    add_range({number, number});
}

bool NumberRanges::has(std::int64_t number) const
{
    const auto after = std::ranges::upper_bound(ranges_, number, {}, &NumberRange::first);
    return after != ranges_.begin() && std::prev(after)->last >= number;
}

std::int64_t NumberRanges::count() const
{
    std::int64_t numbers = 0;
    for (const NumberRange& range : ranges_)
        numbers += range.count();
    return numbers;
}

NumberRanges NumberRanges::absent(std::int64_t first, std::int64_t last) const
{
    NumberRanges gaps;
    std::int64_t next = first;
    for (const NumberRange& range : ranges_) {
        gaps.add_range({next, std::min(range.first - 1, last)});
        next = std::max(next, range.last + 1);
    }
    gaps.add_range({next, last});
    return gaps;
}

NumberRanges NumberRanges::common(const NumberRanges& other) const
{
    NumberRanges both;
    auto theirs = other.ranges_.begin();
    for (auto ours = ranges_.begin(); ours != ranges_.end() && theirs != other.ranges_.end();) {
        both.add_range({std::max(ours->first, theirs->first), std::min(ours->last, theirs->last)});
        if (ours->last < theirs->last)
            ++ours;
        else
            ++theirs;
    }
    return both;
}

NumberRanges NumberRanges::together(const NumberRanges& other) const
{
    std::vector<NumberRange> both;
    std::ranges::merge(ranges_, other.ranges_, std::back_inserter(both), {}, &NumberRange::first, &NumberRange::first);
    NumberRanges all;
    for (const NumberRange& range : both)
        all.add_range(range);
    return all;
}

NumberRanges NumberRanges::without(const NumberRanges& other) const
{
    return common(other.absent(1, kMaxSequence));
}

std::string NumberRanges::text() const
{
    std::string text;
    for (const NumberRange& range : ranges_) {
        text += (text.empty() ? "" : ",") + std::to_string(range.first);
        if (range.last > range.first)
            text += "-" + std::to_string(range.last);
    }
    return text;
}

std::optional<NumberRanges> NumberRanges::parse(std::string_view text)
{
    NumberRanges ranges;
    while (!text.empty()) {
        const std::optional<std::int64_t> first = take_number(text);
        std::optional<std::int64_t> last = first;
        if (first && text.starts_with('-')) {
            text.remove_prefix(1);
            last = take_number(text);
            if (last && *last <= *first)
                return {};
        }
        if (!last || (!ranges.empty() && *first <= ranges.ranges_.back().last + 1))
            return {};
        ranges.add_range({*first, *last});
        if (text.empty())
            return ranges;
        if (text.front() != ',' || text.size() == 1)
            return {};
        text.remove_prefix(1);
    }
    return ranges;
}

} // namespace dicot
