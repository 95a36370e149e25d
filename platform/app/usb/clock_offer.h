// A host's time for a board that does not know it.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"
#include "dicot/mtp/snapshot_note.h"
#include "dicot/os/clock_trust.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dicot::app {

/// Where who may not set the clock leaves an offer for who may: dicot-clock.path waits for it.
inline constexpr const char* kClockOfferFile = "/run/dicot/clock-offer";

/// What an offer is judged by.
struct OfferCase
{
    std::string_view rule = "not set";     ///< usb.clock: "never", "not set"
    ClockReading clock;                    ///< of the board, now, as read_clock(latest_us) tells it
    std::int64_t built_us = 0;             ///< of this program
    std::optional<std::int64_t> latest_us; ///< when the snapshot began that began last; none: there is none
};

/// Ok, or Fault::kUsage with the rule that says no.
Status judge_offer(const mtp::TimeOffer& offer, const OfferCase& known) noexcept;

/// An offer on its way from who took it to who may set the clock: one line, "<offered us> <us since the board was
/// switched on>" and a line feed.
struct WaitingOffer
{
    std::int64_t now_us = 0;   ///< since 1970, UTC, when it was taken
    std::int64_t taken_us = 0; ///< by boot_us()

    friend bool operator==(const WaitingOffer&, const WaitingOffer&) = default;
};
ShortText<63> print_offer(const WaitingOffer& offer) noexcept;
/// Only what print_offer() writes.
std::optional<WaitingOffer> parse_offer(std::string_view text) noexcept;

/// Since the board was switched on, sleep counted (CLOCK_BOOTTIME): it never jumps.
std::int64_t boot_us() noexcept;

/// Fault::kOsError: this user may not (CAP_SYS_TIME); kUsage: this system's clock cannot hold it.
Status set_clock(std::int64_t now_us) noexcept;

/// Judged again and set, by who may; the file is removed whatever comes of it. `store`: the folder of the board's
/// snapshots, if there is one. Takes memory from the heap. Fault::kNoInput: there is no offer; kBadData: it is none;
/// kUsage: it is older than a minute, or the rules say no; kOsError.
Status take_waiting_offer(const std::string& file, const std::string& rule, const std::string& store);

} // namespace dicot::app
