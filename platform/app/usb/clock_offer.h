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

/// Where who may not set the clock leaves an offer for who may.
inline constexpr const char* kClockOfferFile = "/run/dicot/clock-offer";

/// 2100-01-01: no offer, and no snapshot that counts against one, is later.
inline constexpr std::int64_t kEndOfOffersUs = 4'102'444'800'000'000;

/// What an offer is judged by.
struct OfferCase
{
    std::string_view rule = "not set";     ///< usb.clock: "never", "not set"
    ClockReading clock;                    ///< of the board, now: read_clock(latest_us)
    std::int64_t built_us = 0;             ///< of this program
    std::optional<std::int64_t> latest_us; ///< when the snapshot began that began last, before kEndOfOffersUs
};

/// Ok, or Fault::kUsage with the rule that says no.
Status judge_offer(const mtp::TimeOffer& offer, const OfferCase& known) noexcept;

/// An offer on its way from who took it to who may set the clock: one line, "<us since 1970> <us since the board was
/// switched on>".
struct WaitingOffer
{
    std::int64_t now_us = 0;   ///< since 1970, UTC, when it was taken
    std::int64_t taken_us = 0; ///< by boot_us()

    friend bool operator==(const WaitingOffer&, const WaitingOffer&) = default;
};
/// With a line feed.
ShortText<63> print_offer(const WaitingOffer& offer) noexcept;
/// Only what print_offer() writes.
std::optional<WaitingOffer> parse_offer(std::string_view text) noexcept;

/// Since the board was switched on, its sleep counted: it never jumps.
std::int64_t boot_us() noexcept;

/// Fault::kOsError: this user may not (CAP_SYS_TIME), or the system's clock cannot hold it.
Status set_clock(std::int64_t now_us) noexcept;

/// What a process does that may set the clock: the offer in `file` is judged by `rule` (usb.clock) and by the snapshots
/// in the folder `store` (which need not be there), and set. The file is removed whatever comes of it. Takes memory
/// from the heap. Fault::kNoInput: there is no offer; kBadData: it is none; kUsage: it is older than a minute, or the
/// rules say no; kIoError: the snapshots cannot be looked at; kOsError.
Status take_waiting_offer(const std::string& file, const std::string& rule, const std::string& store);
/// Its two halves, so that an offer is away before there is anything to judge it by.
Result<WaitingOffer> take_offer(const std::string& file);
Status judge_and_set(const WaitingOffer& offer, const std::string& file, const std::string& rule,
                     const std::string& store);

/// Sets the clock, or leaves the offer in `file` for who may, and waits up to `patience_us` until the clock shows it.
/// No heap. Fault::kOsError: nobody did.
Status set_or_pass_on(const mtp::TimeOffer& offer, const char* file, std::int64_t patience_us) noexcept;

} // namespace dicot::app
