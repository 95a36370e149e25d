// Local time as a value: how far from UTC a place is, and when that changes.
//
// Zone files and rules are read here, not by libc: its localtime() takes UTC without a word for a name it does not
// know, needs the environment, and ends in 2038 where time_t has 32 bits.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace dicot {

/// Offsets from UTC in seconds, east is positive, and the UTC seconds since 1970 from which each holds.
struct ZoneTable
{
    static constexpr int kMostChanges = 400; ///< two a year until 2100, and what was decided otherwise since 1970

    int changes = 0;
    std::array<std::int64_t, kMostChanges> from_s{};       ///< ascending
    std::array<std::int32_t, kMostChanges + 1> offset_s{}; ///< [0] until the first change, [i + 1] from from_s[i] on

    /// Not before the newest change; one of the same second takes its place. False: the table is full.
    bool change(std::int64_t at_s, std::int32_t to_offset_s) noexcept;
};

/// The local time of a place from 1970 to 2100; outside of that, the first and the last offset hold. A pure value.
class TimeZone
{
public:
    TimeZone() noexcept = default; ///< UTC

    /// `name`: of the IANA database ("Europe/Berlin"), a rule as POSIX has it in TZ ("CET-1CEST,M3.5.0,M10.5.0/3"), or
    /// empty, the system's (`local_file`; UTC if there is none). Read once; no globals, no environment.
    /// Fault::kConfig: no such zone, or its file is damaged (RFC 8536) or counts leap seconds.
    static Result<TimeZone> open(std::string_view name, const char* folder = "/usr/share/zoneinfo",
                                 const char* local_file = "/etc/localtime") noexcept;

    /// What open() was told; of the system's zone what its file is a link to, else "local time".
    const char* name() const noexcept { return name_.c_str(); }

    /// Seconds to be added to UTC.
    int offset_s(std::int64_t utc_us) const noexcept;
    std::int64_t local_us(std::int64_t utc_us) const noexcept;

    /// The UTC time at which local clocks show `in_day_s` seconds after midnight of a day, counted from 1970-01-01;
    /// 86400 is the next midnight. As RFC 5545, 3.3.5: a local time that does not occur is taken with the offset before
    /// the gap; of one that occurs twice the first is meant.
    std::int64_t utc_us(std::int64_t local_day, int in_day_s) const noexcept;

    /// The day, from 1970-01-01, that local calendars show.
    std::int64_t local_day(std::int64_t utc_us) const noexcept;

    const ZoneTable& table() const noexcept { return table_; }

private:
    ShortText<63> name_{"UTC"};
    ZoneTable table_;
};

/// "+02:00", with seconds only where there are some.
ShortText<9> offset_text(int offset_s) noexcept;

} // namespace dicot
