#include "dicot/mtp/container.h"

#include "dicot/mtp/data_reader.h"

namespace dicot::mtp {
namespace {

void put(std::span<std::byte> into, std::size_t at, std::uint32_t value, std::size_t size) noexcept
{
    for (std::size_t i = 0; i < size; ++i)
        into[at + i] = static_cast<std::byte>(value >> (8 * i));
}

} // namespace

std::optional<Header> read_header(std::span<const std::byte> bytes) noexcept
{
    DataReader in{bytes};
    Header header;
    header.length = in.u32();
    header.type = in.u16();
    header.code = in.u16();
    header.transaction = in.u32();
    return in.ok() ? std::optional{header} : std::nullopt;
}

void write_header(const Header& header, std::span<std::byte, kHeaderBytes> into) noexcept
{
    put(into, 0, header.length, 4);
    put(into, 4, header.type, 2);
    put(into, 6, header.code, 2);
    put(into, 8, header.transaction, 4);
}

std::optional<Block> read_block(ContainerType type, std::span<const std::byte> transfer) noexcept
{
    const std::optional<Header> header = read_header(transfer);
    if (!header || !header->is(type) || header->length != transfer.size() || transfer.size() > kMostBlockBytes ||
        transfer.size() % 4 != 0)
        return std::nullopt;
    Block block;
    block.code = header->code;
    block.transaction = header->transaction;
    block.parameter_count = (transfer.size() - kHeaderBytes) / 4;
    DataReader in{transfer.subspan(kHeaderBytes)};
    for (std::size_t i = 0; i < block.parameter_count; ++i)
        block.parameters[i] = in.u32();
    return block;
}

std::size_t write_block(ContainerType type, const Block& block, std::span<std::byte, kMostBlockBytes> into) noexcept
{
    const std::size_t size = kHeaderBytes + 4 * block.parameter_count;
    write_header({static_cast<std::uint32_t>(size), static_cast<std::uint16_t>(type), block.code, block.transaction},
                 into.first<kHeaderBytes>());
    for (std::size_t i = 0; i < block.parameter_count; ++i)
        put(into, kHeaderBytes + 4 * i, block.parameters[i], 4);
    return size;
}

Header data_header(std::uint16_t code, std::uint32_t transaction, std::uint64_t bytes) noexcept
{
    const std::uint64_t length = bytes + kHeaderBytes;
    return {length < kUnknownLength ? static_cast<std::uint32_t>(length) : kUnknownLength,
            static_cast<std::uint16_t>(ContainerType::kData), code, transaction};
}

} // namespace dicot::mtp
