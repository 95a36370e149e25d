#include "dicot/rig/rig_id.h"

#include "dicot/os/sha256.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string_view>

namespace dicot {
namespace {

constexpr std::string_view kBegin = "rig-";

/// Numbers in the order of rig_id_of(), as bytes that are the same on every CPU.
class GeometryDigest
{
public:
    void whole(std::uint32_t value) { little_endian(value, 4); }

    void numbers(std::span<const double> values)
    {
        for (const double value : values)
            little_endian(std::bit_cast<std::uint64_t>(value + 0.0), 8); // -0 becomes 0
    }

    template <std::size_t Rows, std::size_t Columns>
    void matrix(const std::optional<Matrix<Rows, Columns>>& known)
    {
        whole(known ? Rows * Columns : 0);
        if (known)
            for (const auto& row : *known)
                numbers(row);
    }

    Sha256 finish() { return stream_.finish(); }

private:
    void little_endian(std::uint64_t value, int count)
    {
        std::byte bytes[8];
        for (int i = 0; i < count; ++i)
            bytes[i] = static_cast<std::byte>(value >> (8 * i));
        stream_.update(std::span{bytes}.first(static_cast<std::size_t>(count)));
    }

    Sha256Stream stream_;
};

} // namespace

RigId rig_id_of(const RigFile& rig)
{
    GeometryDigest digest;
    digest.whole(static_cast<std::uint32_t>(rig.width));
    digest.whole(static_cast<std::uint32_t>(rig.height));
    for (const RigCamera* camera : {&rig.left, &rig.right}) {
        digest.matrix(camera->intrinsic);
        digest.numbers(camera->distortion.value_or(Distortion{}).at);
    }
    digest.matrix(rig.rotation);
    digest.whole(rig.translation_mm ? 3 : 0);
    if (rig.translation_mm)
        digest.numbers(*rig.translation_mm);
    if (!rig.left.intrinsic || !rig.right.intrinsic || !rig.rotation || !rig.translation_mm)
        for (const RigCamera* camera : {&rig.left, &rig.right})
            digest.matrix(camera->projection);

    const auto hex = hex_of(digest.finish());
    RigId id{};
    std::copy_n(hex.begin(), id.size() - 1 - kBegin.size(), std::copy(kBegin.begin(), kBegin.end(), id.begin()));
    return id;
}

void set_id(RigFile& rig)
{
    const RigId id = rig_id_of(rig);
    std::fill(std::begin(rig.id), std::end(rig.id), '\0');
    std::copy(id.begin(), id.end(), rig.id);
}

bool id_matches(const RigFile& rig)
{
    const std::string_view id = rig.id;
    const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
    if (id.size() != std::tuple_size_v<RigId> - 1 || !id.starts_with(kBegin) ||
        !std::all_of(id.begin() + kBegin.size(), id.end(), is_digit))
        return true;
    return id == rig_id_of(rig).data();
}

} // namespace dicot
