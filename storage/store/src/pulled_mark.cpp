#include "pulled_mark.h"

#include "dicot/base/crc32.h"
#include "dicot/base/utc_time.h"

#include <cstddef>
#include <cstdio>
#include <span>

namespace dicot {

PulledText print_pulled(const PulledMark& mark)
{
    char text[PulledText::kCapacity + 1];
    const int length = std::snprintf(text, sizeof text, "%s %s", utc_text(mark.pulled_us).c_str(), mark.sums.c_str());
    const auto bytes = std::as_bytes(std::span(text, static_cast<std::size_t>(length)));
    std::snprintf(text + length, sizeof text - static_cast<std::size_t>(length), " %08x\n", crc32(bytes));
    return text;
}

Result<PulledMark> parse_pulled(std::string_view text)
{
    constexpr std::size_t kTime = 20;
    constexpr std::size_t kDigits = 64;
    if (text.size() == kTime + 1 + kDigits + 10) {
        const PulledMark mark{parse_utc_text(text.substr(0, kTime)).value_or(0), text.substr(kTime + 1, kDigits)};
        if (print_pulled(mark).view() == text)
            return mark;
    }
    return failure(Fault::kBadData, "it is no mark of a pull");
}

} // namespace dicot
