// Bytes of the protocol as the standards lay them out, put together by hand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace dicot::test {

class Wire
{
public:
    Wire& u8(std::uint64_t value) { return little(value, 1); }
    Wire& u16(std::uint64_t value) { return little(value, 2); }
    Wire& u32(std::uint64_t value) { return little(value, 4); }
    Wire& u64(std::uint64_t value) { return little(value, 8); }
    /// A string of ASCII: count with the end mark, 16 bits a character; the empty one is a count of 0.
    Wire& text(std::string_view ascii)
    {
        if (ascii.empty())
            return u8(0);
        u8(ascii.size() + 1);
        for (const char c : ascii)
            u16(static_cast<unsigned char>(c));
        return u16(0);
    }
    Wire& zeros(std::size_t count)
    {
        bytes_.insert(bytes_.end(), count, std::byte{0});
        return *this;
    }
    Wire& add(const std::vector<std::byte>& more)
    {
        bytes_.insert(bytes_.end(), more.begin(), more.end());
        return *this;
    }
    const std::vector<std::byte>& bytes() const { return bytes_; }

    static std::vector<std::byte> container(std::uint16_t type, std::uint16_t code, std::uint32_t transaction,
                                            const std::vector<std::byte>& payload)
    {
        return Wire().u32(12 + payload.size()).u16(type).u16(code).u32(transaction).add(payload).bytes();
    }
    static std::vector<std::byte> block(std::uint16_t type, std::uint16_t code, std::uint32_t transaction,
                                        const std::vector<std::uint32_t>& parameters)
    {
        Wire payload;
        for (const std::uint32_t one : parameters)
            payload.u32(one);
        return container(type, code, transaction, payload.bytes());
    }

private:
    Wire& little(std::uint64_t value, int size)
    {
        for (int i = 0; i < size; ++i)
            bytes_.push_back(static_cast<std::byte>(value >> (8 * i)));
        return *this;
    }
    std::vector<std::byte> bytes_;
};

} // namespace dicot::test
