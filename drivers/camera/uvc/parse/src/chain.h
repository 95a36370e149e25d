// The chain of descriptors of one configuration.
#pragma once

#include "bytes.h"

#include "dicot/base/status.h"

#include <cstdint>

namespace dicot {

// bDescriptorType (USB 2.0, table 9-5; USB 3.2, table 9-6; UVC, table A-4).
constexpr std::uint8_t kDeviceDescriptor = 1;
constexpr std::uint8_t kConfigurationDescriptor = 2;
constexpr std::uint8_t kInterfaceDescriptor = 4;
constexpr std::uint8_t kEndpointDescriptor = 5;
constexpr std::uint8_t kCompanionDescriptor = 0x30;
constexpr std::uint8_t kClassInterface = 0x24;

constexpr std::uint8_t kVideoClass = 0x0E;
constexpr std::uint8_t kVideoControl = 1;
constexpr std::uint8_t kVideoStreaming = 2;

inline std::uint8_t type_of(Bytes descriptor) noexcept
{
    return u8_at(descriptor, 1);
}

/// Walks a chain that check_chain() has found whole: every descriptor has 2 bytes at least.
class ChainWalk
{
public:
    explicit ChainWalk(Bytes chain) noexcept : rest_(chain) {}

    /// The next descriptor; empty at the end.
    Bytes next() noexcept
    {
        if (rest_.empty())
            return {};
        const Bytes one = rest_.first(u8_at(rest_, 0));
        rest_ = rest_.subspan(one.size());
        return one;
    }

private:
    Bytes rest_;
};

/// Fault::kBadData: a descriptor is shorter than its head or longer than what is left.
Status check_chain(Bytes chain, std::size_t offset) noexcept;

/// An interface descriptor (USB 2.0, table 9-12).
struct InterfaceHead
{
    std::uint8_t number = 0;
    std::uint8_t alternate = 0;
    std::uint8_t subclass = 0; ///< of the video class; 0: another class
};

constexpr std::size_t kInterfaceBytes = 9;

inline InterfaceHead interface_of(Bytes descriptor) noexcept
{
    return {u8_at(descriptor, 2), u8_at(descriptor, 3),
            u8_at(descriptor, 5) == kVideoClass ? u8_at(descriptor, 6) : std::uint8_t{0}};
}

inline bool is_interface(Bytes descriptor) noexcept
{
    return type_of(descriptor) == kInterfaceDescriptor && descriptor.size() >= kInterfaceBytes;
}

} // namespace dicot
