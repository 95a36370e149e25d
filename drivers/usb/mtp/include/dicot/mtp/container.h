// What goes over the bulk and interrupt endpoints: Still Image Capture Device Definition 1.0, clause 7.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace dicot::mtp {

enum class ContainerType : std::uint16_t
{
    kCommand = 1,
    kData = 2,
    kResponse = 3,
    kEvent = 4,
};

inline constexpr std::size_t kHeaderBytes = 12;
inline constexpr std::size_t kMostParameters = 5; ///< of a command and a response; an event has 3
inline constexpr std::size_t kMostBlockBytes = kHeaderBytes + 4 * kMostParameters;
/// `length` of a data container that does not fit 32 bits: the data ends with a short packet.
inline constexpr std::uint32_t kUnknownLength = 0xFFFFFFFF;
/// Events that belong to no transaction (ISO 15740, clause 12.3).
inline constexpr std::uint32_t kNoTransaction = 0xFFFFFFFF;

/// The 12 bytes at the front, as they came: nothing in them is checked.
struct Header
{
    std::uint32_t length = 0; ///< bytes, the header too
    std::uint16_t type = 0;
    std::uint16_t code = 0;
    std::uint32_t transaction = 0;

    bool is(ContainerType wanted) const noexcept { return type == static_cast<std::uint16_t>(wanted); }
};

/// A command, a response or an event.
struct Block
{
    std::uint16_t code = 0;
    std::uint32_t transaction = 0;
    std::array<std::uint32_t, kMostParameters> parameters{}; ///< those that were not sent are 0
    std::size_t parameter_count = 0;
};

/// Empty if there are fewer than 12 bytes.
std::optional<Header> read_header(std::span<const std::byte> bytes) noexcept;
void write_header(const Header& header, std::span<std::byte, kHeaderBytes> into) noexcept;

/// A whole transfer as one block. Empty unless it is of `type`, its length says what arrived, and whole parameters,
/// five at most, follow the header.
std::optional<Block> read_block(ContainerType type, std::span<const std::byte> transfer) noexcept;
/// How many bytes it took.
std::size_t write_block(ContainerType type, const Block& block, std::span<std::byte, kMostBlockBytes> into) noexcept;

/// The header of `bytes` of data.
Header data_header(std::uint16_t code, std::uint32_t transaction, std::uint64_t bytes) noexcept;

} // namespace dicot::mtp
