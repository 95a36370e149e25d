// SHA256SUMS, as sha256sum(1) writes and checks it.
#pragma once

#include "dicot/base/short_text.h"
#include "dicot/base/status.h"
#include "dicot/store/store.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace dicot {

inline constexpr int kMaxSums = Store::kMaxFiles; ///< files in a snapshot, SHA256SUMS not counted
inline constexpr std::size_t kMaxSumsBytes = kMaxSums * (64 + 2 + 31 + 1);

struct Sum
{
    ShortText<31> name;
    ShortText<64> sha256; ///< 64 lower-case hexadecimal digits
};

struct Sums
{
    std::array<Sum, kMaxSums> files;
    int count = 0;

    std::span<const Sum> all() const { return {files.data(), static_cast<std::size_t>(count)}; }
    const Sum* find(std::string_view name) const;
    bool add(std::string_view name, std::string_view sha256); ///< false: full, or it is there
};

/// Lines of `<64 hexadecimal digits>  <name>`, each name once, record.json among them. Fault::kBadData with the line.
Result<Sums> parse_sums(std::string_view text);

/// How many bytes of `into` (kMaxSumsBytes suffice).
std::size_t print_sums(const Sums& sums, std::span<char> into);

} // namespace dicot
