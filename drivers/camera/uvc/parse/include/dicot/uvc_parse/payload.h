// Frames out of payloads: what the endpoint delivers, put together in a caller's buffer.
#pragma once

#include "dicot/camera/frame.h"
#include "dicot/uvc_parse/device_clock.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace dicot {

/// How the frames of a stream are told apart and judged.
struct PayloadRules
{
    bool jpeg = false;                  ///< frames are JPEG: begin with FF D8, end with FF D9 and zeros
    std::size_t exact_bytes = 0;        ///< size of every frame; 0: any
    std::size_t most_payload_bytes = 0; ///< a payload ends when it has as many; 0: only where the caller says so
    std::uint32_t clock_hz = 0;
};

/// A frame that is finished. Its bytes lie in the buffer that was in use.
struct AssembledFrame
{
    std::size_t bytes = 0;
    FrameVerdict verdict = FrameVerdict::kCancelled;
    char flaw[64] = {}; ///< empty of a whole frame
    std::int64_t start_us = 0;
};

/// Puts payloads together (UVC 2.4.3). Never writes past the buffer, allocates nothing, believes no length.
///
/// What ends a frame: the end-of-frame bit, or a payload whose frame id differs from the one before (then the end bit
/// was lost). What tears it: the error bit, a header that is no header, a loss that the caller reports, too many or too
/// few bytes, JPEG markers that are missing, a frame id that did not toggle behind an end of frame. Header-only
/// payloads between frames are idle talk.
class FrameAssembler
{
public:
    enum class Fed : std::uint8_t
    {
        kMore,         ///< taken; the frame goes on
        kClosed,       ///< taken, and closed() is a frame
        kClosedBefore, ///< NOT taken: closed() is a frame; give a buffer and feed the same bytes again
    };

    /// Forgets everything; there is no buffer.
    void restart(const PayloadRules& rules) noexcept;

    /// Where the next frame goes; one that is under way keeps what it has. Empty: the frame is followed but not kept.
    void use(std::span<std::byte> buffer) noexcept
    {
        if (!open_)
            buffer_ = buffer;
    }

    /// Bytes as they came: an isochronous packet (`last`), or a bulk transfer, which ends a payload if it was short
    /// (`last`). `arrival_us` is the time of monotonic_us() at which they were on the bus.
    Fed feed(std::span<const std::byte> bytes, bool last, std::int64_t arrival_us) noexcept;

    /// Something did not arrive: the frame under way, or the next one, is torn. `why` is a literal.
    void lose(const char* why) noexcept;

    /// Ends the frame under way: Fed::kClosed as cancelled, or kMore if there is none.
    Fed cancel(const char* why) noexcept;

    /// The last finished frame. After it there is no buffer until use().
    const AssembledFrame& closed() const noexcept { return closed_; }
    bool under_way() const noexcept { return open_; }

private:
    struct Header
    {
        std::size_t length = 0;
        std::uint8_t flags = 0;
    };

    static std::optional<Header> header_of(std::span<const std::byte> payload) noexcept;
    void open(std::uint8_t frame_id) noexcept;
    void note_time(const Header& header, std::span<const std::byte> payload, std::int64_t arrival_us) noexcept;
    void add(std::span<const std::byte> data, std::int64_t arrival_us) noexcept;
    void judge() noexcept;
    void close() noexcept;

    PayloadRules rules_;
    std::span<std::byte> buffer_;
    AssembledFrame closed_;

    bool open_ = false;
    std::size_t held_ = 0;    ///< bytes in the buffer
    std::size_t claimed_ = 0; ///< bytes that came, kept or not
    const char* flaw_ = nullptr;
    std::int64_t first_data_us_ = 0;
    std::int64_t device_start_us_ = 0;
    bool has_device_start_ = false;

    int frame_id_ = -1;    ///< of the last payload; -1: none yet
    bool toggles_ = false; ///< the device has changed its frame id at least once
    int ended_without_toggle_ = 0;

    bool in_payload_ = false;
    bool skip_payload_ = false;
    bool end_of_frame_ = false;
    std::size_t payload_bytes_ = 0;
};

} // namespace dicot
