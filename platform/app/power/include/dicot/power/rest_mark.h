// What a board that is powered off by its own wish leaves for its next start.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/os/wait.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace dicot::app {

struct RestMark
{
    std::uint64_t slot = 0;
    std::int64_t due_us = 0;
    std::int64_t alarm_us = 0; ///< when the alarm rings, by the system's clock
    BootId boot;               ///< the one that ended

    friend bool operator==(const RestMark& a, const RestMark& b) noexcept
    {
        return a.slot == b.slot && a.due_us == b.due_us && a.alarm_us == b.alarm_us &&
               std::string_view{a.boot.text} == b.boot.text;
    }
};

/// One line of text; none: it is no such line.
ShortText<200> text_of(const RestMark& mark) noexcept;
std::optional<RestMark> parse_rest_mark(std::string_view text) noexcept;

} // namespace dicot::app
