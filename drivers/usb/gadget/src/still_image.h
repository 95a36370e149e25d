// What a computer may ask beside the transfers, and what state that leaves: pure, without a cable.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot::gadget_parts {

/// Of a setup packet; numbers as the processor has them.
struct Setup
{
    std::uint8_t type = 0, request = 0;
    std::uint16_t value = 0, index = 0, length = 0;
};

enum class Ep0Event
{
    kBind,
    kUnbind,
    kEnable,
    kDisable,
    kSuspend,
    kResume,
};

/// How a setup is answered.
struct Ep0Answer
{
    enum class Kind
    {
        kStall,
        kSend, ///< `data`, as far as the host asks for it
        kTake, ///< so many bytes of the host's, which taken() is shown; 0: none, it is acknowledged
    };
    Kind kind = Kind::kStall;
    std::array<std::byte, 40> data{};
    std::size_t bytes = 0;
};

/// The state behind endpoint 0. What the responder does and what the host asks come from two threads: whoever calls
/// holds one lock around it. Source: USB Still Image Capture Device Definition 1.0, 5.2 (requests 64h to 67h).
class StillImage
{
public:
    static constexpr std::uint8_t kCancel = 0x64, kExtendedEvent = 0x65, kReset = 0x66, kStatus = 0x67;
    static constexpr std::size_t kCancelBytes = 6;

    void hear(Ep0Event event) noexcept;
    Ep0Answer asked(const Setup& setup) const noexcept;
    /// After a kTake: the data that came. False: it means nothing.
    bool taken(const Setup& setup, std::span<const std::byte> data) noexcept;

    bool enabled() const noexcept { return enabled_; }
    bool suspended() const noexcept { return suspended_; }
    /// Grows with each configuration: requests of another generation are dead.
    std::uint32_t generation() const noexcept { return generation_; }

    void begin(std::uint32_t id) noexcept;
    void end() noexcept { under_way_ = interrupted_ = false; }
    bool under_way() const noexcept { return under_way_; }
    bool interrupted() const noexcept { return interrupted_; }
    /// Something on the endpoints has to be thrown away; until done with it, the status is "busy".
    bool must_flush() const noexcept { return must_flush_; }
    void flushed() noexcept { must_flush_ = false; }
    /// The transaction under way ends here, by the link's own judgement.
    void give_up() noexcept { interrupted_ = true; }
    bool take_reset() noexcept;
    /// What "extended event data" will tell.
    void posted(std::span<const std::byte> container) noexcept;

private:
    Ep0Answer status() const noexcept;
    Ep0Answer extended_event() const noexcept;

    bool enabled_ = false, suspended_ = false;
    bool under_way_ = false, interrupted_ = false, must_flush_ = false, reset_ = false, cancelled_ = false;
    std::uint32_t generation_ = 0, cancelled_id_ = 0;
    std::array<std::byte, 24> event_{};
    std::size_t event_bytes_ = 0;
};

} // namespace dicot::gadget_parts
