#include "digest.h"

#include <algorithm>
#include <bit>

namespace dicot {
namespace {

unsigned digit(char c)
{
    return static_cast<unsigned>(c >= 'a' ? c - 'a' + 10 : c - '0') & 15U;
}

} // namespace

ShortText<64> digest_text(const DigestBytes& digest)
{
    return hex_of(std::bit_cast<Sha256>(digest)).data();
}

DigestBytes digest_bytes(const ShortText<64>& text)
{
    DigestBytes digest{};
    for (std::size_t k = 0; k < std::min(digest.size(), text.view().size() / 2); ++k)
        digest[k] = static_cast<std::byte>(digit(text.view()[2 * k]) << 4U | digit(text.view()[2 * k + 1]));
    return digest;
}

} // namespace dicot
