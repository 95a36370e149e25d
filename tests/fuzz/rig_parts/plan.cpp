// A plan is made of what was offered, fits, and asks for less each time that the bus refuses.
#include "parts.h"

#include "dicot/camera/bandwidth.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace dicot::fuzz {
namespace {

struct FuzzUser
{
    std::vector<AlternateSetting> settings;
    std::vector<StreamOffer> offers;
    BusUser user;
};

FuzzUser read_user(Numbers& numbers)
{
    constexpr std::uint32_t kIntervals[] = {0, 1, 333333, 400000, 666666, 1000000, 2000000, 4294967295U};
    FuzzUser read;
    const std::uint8_t how = numbers.byte();
    read.user.bus = how % 4 - 1;
    read.user.speed = static_cast<UsbSpeed>(how / 4 % 3);
    read.user.bulk = (how & 0x40) != 0;
    read.user.chooses_alternate = (how & 0x80) != 0;
    const std::uint8_t counts = numbers.byte();
    for (int i = 0; i < (counts & 7); ++i)
        read.settings.push_back({numbers.byte(), numbers.word(), numbers.byte() % 9U});
    for (int i = 0; i < (counts >> 3 & 7); ++i) {
        const std::uint8_t kind = numbers.byte();
        StreamOffer offer;
        offer.mode = {static_cast<PixelFormat>(kind % 5), 16 * numbers.byte(), 16 * numbers.byte(),
                      kIntervals[kind >> 5]};
        if ((kind & 0x10) != 0)
            offer.payload_bytes = numbers.word();
        read.offers.push_back(offer);
    }
    return read;
}

void require_stream(const FuzzUser& of, const PlannedStream& stream)
{
    require(std::ranges::any_of(of.offers, [&](const StreamOffer& offer) { return offer.mode == stream.mode; }));
    require(stream.mode.interval_100ns != 0);
    require(of.user.bus < 0 || stream.bus_time <= bus_budget(of.user.speed));
    const bool reserves = of.user.bus >= 0 && !of.user.bulk;
    require(reserves || stream.reserved_bytes_per_s == 0);
    if (!reserves || of.settings.empty()) {
        require(stream.alternate == 0);
        return;
    }
    const std::uint64_t rate = of.user.speed == UsbSpeed::kFull ? 1000 : 8000;
    const std::uint32_t estimate = estimated_payload(stream.mode, of.user.speed);
    require(std::ranges::any_of(of.settings, [&](const AlternateSetting& one) {
        const std::uint32_t apart = std::max(one.intervals_apart, 1U);
        const bool carries = one.bytes_per_interval / apart >= estimate;
        const bool asked = std::ranges::any_of(of.offers, [&](const StreamOffer& offer) {
            return offer.mode == stream.mode && offer.payload_bytes != 0 &&
                   one.bytes_per_interval >= offer.payload_bytes;
        });
        return one.number == stream.alternate && (carries || asked) &&
               stream.reserved_bytes_per_s == one.bytes_per_interval * rate / apart &&
               stream.bus_time == bus_time(one.bytes_per_interval, of.user.speed, false);
    }));
}

} // namespace

void plan(Numbers& numbers)
{
    FuzzUser left = read_user(numbers);
    FuzzUser right = read_user(numbers);
    for (FuzzUser* side : {&left, &right}) {
        side->user.settings = side->settings;
        side->user.offers = side->offers;
    }
    const bool one_wire = left.user.bus >= 0 && left.user.bus == right.user.bus && left.user.speed == right.user.speed;
    std::uint64_t asked_before = std::numeric_limits<std::uint64_t>::max();
    Together before = Together::kAtOnce;
    for (int refused = 0; refused < 12; ++refused) {
        const BandwidthPlan got = plan_bandwidth(left.user, right.user, refused);
        require_sentence(got.why);
        require(got.together >= before); // once one after the other, never at once again
        before = got.together;
        if (got.together == Together::kNotAtAll) {
            require(got.left.bus_time == 0 && got.right.bus_time == 0 && got.left.reserved_bytes_per_s == 0);
            continue;
        }
        require_stream(left, got.left);
        require_stream(right, got.right);
        require(got.left.mode.format == got.right.mode.format && got.left.mode.width == got.right.mode.width &&
                got.left.mode.height == got.right.mode.height);
        const std::uint64_t sum = std::uint64_t{got.left.bus_time} + got.right.bus_time;
        const bool at_once = got.together == Together::kAtOnce;
        require(!at_once || !one_wire || sum <= bus_budget(left.user.speed));
        const std::uint64_t asked = at_once ? sum : std::max(got.left.bus_time, got.right.bus_time);
        require(asked < asked_before);
        asked_before = asked;
    }
}

} // namespace dicot::fuzz
