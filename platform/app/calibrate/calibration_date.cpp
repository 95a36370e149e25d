#include "calibration_date.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <limits>

namespace dicot::app {
namespace {

constexpr std::time_t kYear2020 = 1577836800;
// What four digits can say, or time_t: on armhf that ends in 2038.
constexpr long long kLatest =
    std::min(253'402'300'799LL, static_cast<long long>(std::numeric_limits<std::time_t>::max()));

} // namespace

Status date_rig(RigFile& rig)
{
    rig.calibrated_at[0] = '\0';
    std::time_t seconds = std::time(nullptr);
    if (const char* fixed = std::getenv("SOURCE_DATE_EPOCH"); fixed != nullptr) {
        const char* end = fixed + std::strlen(fixed);
        long long given = 0;
        const auto read = std::from_chars(fixed, end, given);
        if (read.ec != std::errc{} || read.ptr != end || given < 0 || given > kLatest)
            return failure(Fault::kUsage, "SOURCE_DATE_EPOCH is '%.40s': give seconds since 1970, or unset it", fixed);
        seconds = static_cast<std::time_t>(given);
    } else if (seconds < kYear2020) {
        return {};
    }
    std::tm utc{};
    if (gmtime_r(&seconds, &utc) != nullptr)
        std::strftime(rig.calibrated_at, sizeof rig.calibrated_at, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return {};
}

} // namespace dicot::app
