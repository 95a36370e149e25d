#include "clock_offer.h"

#include "dicot/base/utc_time.h"

#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <system_error>

namespace dicot::app {
namespace {

Status says_no(const char* sentence) noexcept
{
    return failure(Fault::kUsage, "the board does not take this time: %s", sentence);
}

} // namespace

Status judge_offer(const mtp::TimeOffer& offer, const OfferCase& known) noexcept
{
    char why[200];
    if (known.rule != "not set")
        return says_no("its configuration says so (usb.clock)");
    if (known.clock.trust != ClockTrust::kNotSet) {
        std::snprintf(why, sizeof why, "its clock shows %s and is %s, and only one that is not set is set by a host",
                      utc_text(known.clock.now_us).c_str(), name_of(known.clock.trust));
        return says_no(why);
    }
    if (offer.now_us < known.built_us) {
        std::snprintf(why, sizeof why, "%s is before its program was built (%s)", utc_text(offer.now_us).c_str(),
                      utc_day(known.built_us).c_str());
        return says_no(why);
    }
    if (offer.now_us >= kEndOfOffersUs) {
        std::snprintf(why, sizeof why, "%s cannot be", utc_text(offer.now_us).c_str());
        return says_no(why);
    }
    if (known.latest_us && offer.now_us <= *known.latest_us) {
        std::snprintf(
            why, sizeof why,
            "%s is not after its snapshot of %s; if it is that snapshot's time that is wrong, set the clock by "
            "hand",
            utc_text(offer.now_us).c_str(), utc_text(*known.latest_us).c_str());
        return says_no(why);
    }
    return {};
}

ShortText<63> print_offer(const WaitingOffer& offer) noexcept
{
    char text[64];
    std::snprintf(text, sizeof text, "%" PRId64 " %" PRId64 "\n", offer.now_us, offer.taken_us);
    return text;
}

std::optional<WaitingOffer> parse_offer(std::string_view text) noexcept
{
    WaitingOffer offer;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, offer.now_us);
    if (first.ec != std::errc{} || first.ptr == end)
        return std::nullopt;
    (void)std::from_chars(first.ptr + 1, end, offer.taken_us);
    if (print_offer(offer).view() != text)
        return std::nullopt;
    return offer;
}

} // namespace dicot::app
