// One question and its answer, of any operation.
#pragma once

#include "conversation.h"

#include "dicot/mtp_host/initiator.h"

#include <array>

namespace dicot::mtp {

struct Initiator::Request
{
    std::uint16_t operation = 0;
    std::array<std::uint32_t, kMostParameters> words{};
    std::size_t count = 0;
    std::span<const std::byte> data; ///< to the device
    bool names_object = false;       ///< by a handle, which belongs to the session

    std::span<const std::uint32_t> parameters() const noexcept { return std::span{words}.first(count); }
};

struct Initiator::Answer
{
    std::span<std::byte> into; ///< room for data; none: no data phase is waited for
    std::size_t expected = 0;  ///< how much it will probably be
    std::size_t got = 0;
    std::uint16_t response_code = 0;

    std::span<const std::byte> bytes() const noexcept { return into.first(got); }
};

/// What a response code means to whoever asked; ok if it is OK.
Status refusal(std::uint16_t answered, std::uint16_t operation);

} // namespace dicot::mtp
