// The cable, by the kernel's FunctionFS: one bulk endpoint each way, one for events, and the requests beside them.
#pragma once

#include "dicot/mtp/device_link.h"

#include "dicot/base/function_ref.h"
#include "dicot/base/status.h"

#include <atomic>
#include <cstdint>
#include <memory>

namespace dicot {

enum class CableState : std::uint32_t
{
    kNoHost,     ///< nothing is plugged in, or nobody has configured us
    kConfigured, ///< a computer may talk to us
    kSuspended,  ///< it has put us to sleep
};
const char* name_of(CableState state) noexcept; ///< "no host", "configured", "suspended"

/// What happened on the cable since open().
struct CableCounts
{
    std::atomic<std::uint64_t> hosts{0}; ///< times that a computer configured us
    std::atomic<std::uint64_t> cancels{0}, resets{0}, stalls{0};
    std::atomic<std::uint64_t> given_up{0}; ///< transfers that the host forgot, and another request ended
    std::atomic<std::uint64_t> events_dropped{0};
};

/// Transfers are asynchronous (AIO): two parts are on their way to the host at once, out of the caller's memory, and
/// all waits are for an eventfd, so that nothing is stuck in the kernel. A thread of its own answers endpoint 0,
/// whatever the responder is doing. All memory is taken by open(). Source: Linux, Documentation/usb/functionfs.rst; USB
/// Still Image Capture Device Definition 1.0.
class FfsLink final : public mtp::DeviceLink
{
public:
    static constexpr std::size_t kMostPartBytes = 262'144; ///< of one send()
    static constexpr int kEvents = 8;                      ///< on their way at once

    struct Rules
    {
        const char* mount = nullptr; ///< of FunctionFS
        FunctionRef<bool()> goes_on; ///< false: everything that waits ends. Asked each second and after each signal
        int forgotten_ms = 500;      ///< a host that asks anew and takes nothing for so long has given its transfer up
    };
    /// Hands the kernel our descriptors; UsbGadget::bind() comes next. Fault::kUnavailable: not mounted, not this
    /// user's, another process serves; kOsError.
    static Result<std::unique_ptr<FfsLink>> open(const Rules& rules);
    FfsLink(const FfsLink&) = delete;
    FfsLink& operator=(const FfsLink&) = delete;
    ~FfsLink() override;

    /// Until a computer has configured us; what was under way with the last one is forgotten. Fault::kTryAgain: none
    /// has in that time; kUnavailable: an end is wanted.
    Status await_host(int patience_ms);

    Result<std::size_t> receive(std::span<std::byte> into, int patience_ms) override;
    Status send(std::span<const std::byte> bytes, bool last) override;
    void post_event(std::span<const std::byte> container) override;
    bool interrupted() const override;
    void begin_transaction(std::uint32_t id) override;
    void end_transaction() override;
    bool take_reset() override;

    const CableCounts& counts() const noexcept;
    CableState state() const noexcept;

private:
    struct Parts;
    explicit FfsLink(std::unique_ptr<Parts> parts) noexcept;
    std::unique_ptr<Parts> parts_;
};

} // namespace dicot
