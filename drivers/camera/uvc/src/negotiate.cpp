#include "negotiate.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace dicot {
namespace {

constexpr std::uint8_t kProbe = 1;
constexpr std::uint8_t kCommit = 2;
constexpr std::uint16_t kKeepInterval = 1; ///< bmHint, D0

Result<StreamControl> probe(UsbPort& port, const UvcDevice& device, const StreamControl& wish) noexcept
{
    std::array<std::byte, kMostStreamControlBytes> room{};
    const auto block = std::span{room}.first(stream_control_bytes(device.version));
    write_stream_control(wish, block);
    if (const int sent = port.streaming(UvcRequest::kSetCur, kProbe, block); sent < 0)
        return usb_failure(port.name(), "offer a mode (SET_CUR of the probe control)", sent);
    std::ranges::fill(block, std::byte{0});
    const int got = port.streaming(UvcRequest::kGetCur, kProbe, block);
    if (got < 0)
        return usb_failure(port.name(), "hear its answer to a mode (GET_CUR of the probe control)", got);
    const Result<StreamControl> answer = read_stream_control(block.first(static_cast<std::size_t>(got)));
    if (!answer.ok())
        return failure(Fault::kTryAgain, "the camera at USB port %s: %s", port.name(), answer.status().message());
    return answer.value();
}

/// Cameras round: 333333 and 333300 are one rate.
bool one_rate(std::uint32_t a, std::uint32_t b) noexcept
{
    return std::llabs(std::int64_t{a} - std::int64_t{b}) <= std::int64_t{a} / 100;
}

Status check_answer(const UsbPort& port, const StreamControl& wish, const StreamControl& answer) noexcept
{
    if (answer.format_index == wish.format_index && answer.frame_index == wish.frame_index &&
        one_rate(wish.interval_100ns, answer.interval_100ns))
        return {};
    return failure(
        Fault::kTryAgain,
        "the camera at USB port %s was asked for format %u, frame %u every %u x 100 ns and offers %u, %u, %u",
        port.name(), unsigned{wish.format_index}, unsigned{wish.frame_index}, wish.interval_100ns,
        unsigned{answer.format_index}, unsigned{answer.frame_index}, answer.interval_100ns);
}

std::uint32_t bytes_of(const UvcAlternate& one) noexcept
{
    return one.setting.bytes_per_interval;
}

Result<UvcAlternate> smallest_that_fits(const UsbPort& port, const UvcDevice& device, std::uint32_t payload) noexcept
{
    const auto settings = device.settings();
    const UvcAlternate* chosen = nullptr;
    for (const UvcAlternate& one : settings)
        if (bytes_of(one) >= payload && (chosen == nullptr || bytes_of(one) < bytes_of(*chosen)))
            chosen = &one;
    const UvcAlternate& largest = *std::ranges::max_element(settings, {}, bytes_of);
    if (payload == 0)
        return largest;
    if (chosen == nullptr)
        return failure(Fault::kTryAgain,
                       "the camera at USB port %s wants %u bytes an interval; its largest setting has %u", port.name(),
                       payload, bytes_of(largest));
    return *chosen;
}

Result<StreamControl> wish_of(const UsbPort& port, const UvcDevice& device, const CameraMode& mode) noexcept
{
    const std::optional<UvcModePlace> place = place_of(device, mode);
    if (!place)
        return failure(Fault::kUnavailable, "the camera at USB port %s has no %s of %d x %d every %u x 100 ns",
                       port.name(), name_of(mode.format), mode.width, mode.height, mode.interval_100ns);
    StreamControl wish;
    wish.hint = kKeepInterval;
    wish.format_index = place->format_index;
    wish.frame_index = place->frame_index;
    wish.interval_100ns = mode.interval_100ns;
    return wish;
}

} // namespace

Result<StreamControl> ask_mode(UsbPort& port, const UvcDevice& device, const CameraMode& mode) noexcept
{
    const StreamControl wish = TRY(wish_of(port, device, mode));
    const StreamControl answer = TRY(probe(port, device, wish));
    TRY(check_answer(port, wish, answer));
    return answer;
}

Result<Agreement> agree(UsbPort& port, const UvcDevice& device, const CameraMode& mode, std::uint8_t alternate) noexcept
{
    StreamControl answer = TRY(ask_mode(port, device, mode));
    UvcAlternate setting = device.settings().front();
    if (!device.bulk() && alternate == 0) {
        setting = TRY(smallest_that_fits(port, device, answer.most_payload_bytes));
    } else if (!device.bulk()) {
        const auto planned = std::ranges::find_if(
            device.settings(), [&](const UvcAlternate& one) { return one.setting.number == alternate; });
        if (planned == device.settings().end())
            return failure(Fault::kUnavailable, "the camera at USB port %s has no alternate setting %u", port.name(),
                           unsigned{alternate});
        setting = *planned;
        if (answer.most_payload_bytes > bytes_of(setting)) {
            StreamControl smaller = answer;
            smaller.hint = kKeepInterval;
            smaller.most_payload_bytes = bytes_of(setting);
            const StreamControl second = TRY(probe(port, device, smaller));
            TRY(check_answer(port, answer, second));
            answer = second; // a camera that insists may still cut its payloads to the endpoint: its frames will tell
        }
    }

    std::array<std::byte, kMostStreamControlBytes> room{};
    const auto block = std::span{room}.first(stream_control_bytes(device.version));
    write_stream_control(answer, block);
    if (const int sent = port.streaming(UvcRequest::kSetCur, kCommit, block); sent < 0)
        return usb_failure(port.name(), "commit a mode (SET_CUR of the commit control)", sent);
    return Agreement{answer, setting};
}

} // namespace dicot
