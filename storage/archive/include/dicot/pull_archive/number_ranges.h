// Sequence numbers as ranges: "1-20,25,30-41".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dicot {

struct NumberRange
{
    std::int64_t first = 0, last = 0; ///< both included

    std::int64_t count() const { return last - first + 1; }
    friend bool operator==(const NumberRange&, const NumberRange&) = default;
};

/// Ascending, and never touching one another.
class NumberRanges
{
public:
    /// In ascending order; a number that is there already changes nothing.
    void add(std::int64_t number);

    const std::vector<NumberRange>& all() const { return ranges_; }
    bool empty() const { return ranges_.empty(); }
    bool has(std::int64_t number) const;
    std::int64_t count() const;

    /// The numbers of [first, last] that are not among these.
    NumberRanges absent(std::int64_t first, std::int64_t last) const;
    /// Those that are in both.
    NumberRanges common(const NumberRanges& other) const;
    /// Those that are in one of both.
    NumberRanges together(const NumberRanges& other) const;
    /// Those of these that are not in the other.
    NumberRanges without(const NumberRanges& other) const;

    std::string text() const;
    /// Only what text() writes, of numbers from 1 to kMaxSequence.
    static std::optional<NumberRanges> parse(std::string_view text);

    friend bool operator==(const NumberRanges&, const NumberRanges&) = default;

private:
    void add_range(NumberRange range);

    std::vector<NumberRange> ranges_;
};

} // namespace dicot
