#include "clock_offer.h"

#include "dicot/base/utc_time.h"
#include "dicot/medium/disk_medium.h"
#include "dicot/os/output_file.h"
#include "dicot/os/shown_path.h"
#include "dicot/shelf/snapshot_shelf.h"

#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <limits>
#include <system_error>

#include <unistd.h>

namespace dicot::app {
namespace {

constexpr std::int64_t kSecondUs = 1'000'000;
constexpr std::int64_t kMostAgeUs = 60 * kSecondUs;
constexpr std::int64_t kLooseUs = 2 * kSecondUs; ///< what setting it may take
constexpr useconds_t kPauseUs = 50'000;

std::int64_t us_of(clockid_t clock) noexcept
{
    timespec now{};
    ::clock_gettime(clock, &now);
    return std::int64_t{now.tv_sec} * kSecondUs + now.tv_nsec / 1000;
}

Result<std::optional<std::int64_t>> latest_in(const std::string& store)
{
    std::error_code error;
    const std::filesystem::file_status there = std::filesystem::status(store, error);
    if (there.type() == std::filesystem::file_type::not_found)
        return std::optional<std::int64_t>{};
    if (error)
        return failure(Fault::kIoError, "%s cannot be looked at (%s): no time is taken", shown_path(store.c_str()),
                       error.message().c_str());
    const auto medium = TRY(open_disk_medium(store));
    return latest_in_store(*medium, kEndOfOffersUs);
}

/// Whatever it is: what stays would be seen again at once. A folder's links are removed, not followed.
bool drop(const std::string& file) noexcept
{
    constexpr int kMostEntries = 1000; // more than that is left for the start limit of the unit
    std::error_code error;
    std::filesystem::recursive_directory_iterator each(file, error), end;
    for (int count = 0; !error && each != end; each.increment(error))
        if (++count > kMostEntries)
            return false;
    std::filesystem::remove_all(file, error);
    return !error;
}

/// Its folder belongs to somebody else: no link is followed, nothing but a file is opened.
Result<WaitingOffer> take_away(const std::string& file)
{
    const std::filesystem::path path = file;
    const auto folder = TRY(open_disk_medium(path.parent_path().string()));
    const std::string name = path.filename().string();
    Medium::File opened = 0;
    std::uint64_t size = 0;
    const Errno outcome = folder->open(name.c_str(), opened, size);
    if (outcome.number() == ENOENT)
        return failure(Fault::kNoInput, "%s: nobody offers a time", shown_path(file.c_str()));
    char text[64] = {};
    std::size_t got = 0;
    bool whole = outcome.ok() && folder->read(opened, std::as_writable_bytes(std::span(text)), got).ok();
    if (outcome.ok())
        (void)folder->close(opened);
    if (!folder->remove_file(name.c_str()).ok() && !drop(file))
        return failure(Fault::kIoError, "%s cannot be removed", shown_path(file.c_str()));
    const auto offer = whole ? parse_offer({text, got}) : std::nullopt;
    if (!offer)
        return failure(Fault::kBadData, "%s: this is no offer of a time", shown_path(file.c_str()));
    return *offer;
}

bool shows(std::int64_t expected_us) noexcept
{
    const std::int64_t off_us = us_of(CLOCK_REALTIME) - expected_us;
    return off_us > -kLooseUs && off_us < kLooseUs;
}

} // namespace

std::int64_t boot_us() noexcept
{
    return us_of(CLOCK_BOOTTIME);
}

Status set_clock(std::int64_t now_us) noexcept
{
    const std::int64_t second = now_us / kSecondUs;
    if (now_us < 0 || second > std::numeric_limits<time_t>::max())
        return failure(Fault::kOsError, "the clock of this system cannot show %s", utc_text(now_us).c_str());
    timespec time{};
    time.tv_sec = static_cast<time_t>(second);
    time.tv_nsec = static_cast<decltype(time.tv_nsec)>(now_us % kSecondUs * 1000);
    if (::clock_settime(CLOCK_REALTIME, &time) != 0)
        return failure(Fault::kOsError, "the clock cannot be set (%s)", strerrordesc_np(errno));
    return {};
}

Result<WaitingOffer> take_offer(const std::string& file)
{
    return take_away(file);
}

Status take_waiting_offer(const std::string& file, const std::string& rule, const std::string& store)
{
    return judge_and_set(TRY(take_offer(file)), file, rule, store);
}

Status judge_and_set(const WaitingOffer& offer, const std::string& file, const std::string& rule,
                     const std::string& store)
{
    const std::int64_t age_us = boot_us() - offer.taken_us;
    if (age_us < 0 || age_us > kMostAgeUs)
        return failure(Fault::kUsage, "%s: this offer of a time is too old", shown_path(file.c_str()));
    const std::optional<std::int64_t> latest_us = TRY(latest_in(store));
    const std::int64_t now_us = offer.now_us + age_us;
    TRY(judge_offer({now_us}, {rule, read_clock(latest_us), built_us(), latest_us}));
    return set_clock(offer.now_us + boot_us() - offer.taken_us);
}

Status set_or_pass_on(const mtp::TimeOffer& offer, const char* file, std::int64_t patience_us) noexcept
{
    const std::int64_t taken_us = boot_us();
    const Status set = set_clock(offer.now_us);
    if (set.ok())
        return {};
    const ShortText<63> text = print_offer({offer.now_us, taken_us});
    OutputFile waiting;
    Status passed_on = waiting.open(file);
    if (passed_on.ok())
        passed_on = waiting.write(text.c_str(), text.view().size());
    if (passed_on.ok())
        passed_on = waiting.commit();
    if (!passed_on.ok())
        return failure(Fault::kOsError, "%s, and not passed on either: %s", set.message(), passed_on.message());
    while (boot_us() - taken_us < patience_us) {
        ::usleep(kPauseUs);
        if (shows(offer.now_us + boot_us() - taken_us))
            return {};
    }
    (void)::unlink(file);
    return failure(Fault::kOsError,
                   "%s, and nobody did it in dicot's place: enable dicot-clock.path on the board, or see its log",
                   set.message());
}

} // namespace dicot::app
