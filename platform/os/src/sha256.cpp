#include "dicot/os/sha256.h"

#include <new>
#include <type_traits>

#include <sha2.h>

namespace dicot {
namespace {

static_assert(SHA256_DIGEST_LENGTH == std::tuple_size_v<Sha256>);
static_assert(std::is_trivially_copyable_v<SHA2_CTX> && alignof(SHA2_CTX) <= 8);

SHA2_CTX* context_in(std::byte* state) noexcept
{
    return std::launder(static_cast<SHA2_CTX*>(static_cast<void*>(state)));
}

} // namespace

Sha256Stream::Sha256Stream() noexcept
{
    static_assert(sizeof(SHA2_CTX) <= kStateBytes);
    SHA256Init(::new (static_cast<void*>(state_)) SHA2_CTX{});
}

void Sha256Stream::update(std::span<const std::byte> bytes) noexcept
{
    SHA256Update(context_in(state_), reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

Sha256 Sha256Stream::finish() noexcept
{
    Sha256 digest{};
    SHA256Final(digest.data(), context_in(state_));
    SHA256Init(context_in(state_));
    return digest;
}

Sha256 sha256_of(std::span<const std::byte> bytes) noexcept
{
    Sha256Stream stream;
    stream.update(bytes);
    return stream.finish();
}

std::array<char, 65> hex_of(const Sha256& digest) noexcept
{
    constexpr char kDigits[] = "0123456789abcdef";
    std::array<char, 65> hex{};
    for (std::size_t i = 0; i < digest.size(); ++i) {
        hex[2 * i] = kDigits[digest[i] >> 4U];
        hex[2 * i + 1] = kDigits[digest[i] & 15U];
    }
    return hex;
}

} // namespace dicot
