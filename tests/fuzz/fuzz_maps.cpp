// Any bytes at all through the reader of stored rectification tables, as they are and with checksums that agree.
#include "dicot/base/crc32.h"
#include "dicot/rectification/rig_maps.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

namespace {

using namespace dicot;

constexpr int kWidth = 64;
constexpr int kHeight = 40;
constexpr double kKeep = 0.25;

void require(bool promise)
{
    if (!promise)
        std::abort();
}

/// The rig of the corpus.
StereoRig small_rig()
{
    StereoRig rig;
    rig.width = kWidth;
    rig.height = kHeight;
    rig.left = {60, 61, 31, 20, {-0.1, 0.02, 0.001, -0.001}};
    rig.right = {62, 61, 32, 19, {-0.12, 0.03, -0.001, 0.002}};
    rig.shift_mm = {-60, 0.5, 0.25};
    return rig;
}

void sign(std::vector<std::byte>& bytes, std::size_t begin, std::size_t count)
{
    if (count < 4 || begin > bytes.size() || count > bytes.size() - begin)
        return;
    const std::uint32_t crc = crc32(std::span{bytes}.subspan(begin, count - 4));
    for (std::size_t i = 0; i < 4; ++i)
        bytes[begin + count - 4 + i] = static_cast<std::byte>(crc >> (8 * i));
}

std::size_t length_at(const std::vector<std::byte>& bytes, std::size_t at)
{
    std::size_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= static_cast<std::size_t>(bytes[at + i]) << (8 * i);
    return value;
}

void feed(const std::vector<std::byte>& bytes)
{
    const std::size_t room = 2 * RemapTable::most_bytes(kWidth, kHeight);
    struct Block
    {
        alignas(Arena::kAlignment) std::byte bytes[Arena::kAlignment];
    };
    // Exactly as much as the program gives, so that a byte beyond it is seen.
    const auto blocks = std::make_unique<Block[]>(room / sizeof(Block));
    Arena arena{{blocks[0].bytes, room}};
    const Result<RigMaps> maps = read_maps(bytes, small_rig(), kKeep, arena, "fuzz");
    if (!maps.ok()) {
        require(maps.status().fault() == Fault::kBadData || maps.status().fault() == Fault::kConfig);
        require(std::strncmp(maps.status().message(), "fuzz: ", 6) == 0);
        return;
    }
    const auto from = std::make_unique<Rgb8[]>(kWidth * kHeight);
    const auto into = std::make_unique<Rgb8[]>(kWidth * kHeight);
    for (const RemapTable* table : {&maps.value().left, &maps.value().right}) {
        require(table->width() == kWidth && table->height() == kHeight);
        const auto spans = std::make_unique<RemapSpan[]>(static_cast<std::size_t>(table->columns()));
        remap(*table, kScalarKernels, ImageView<const Rgb8>{from.get(), kWidth, kHeight},
              ImageView<Rgb8>{into.get(), kWidth, kHeight},
              std::span{spans.get(), static_cast<std::size_t>(table->columns())});
        std::int64_t with_source = 0;
        std::array<std::uint8_t, kWidth> mask{};
        for (int y = 0; y < kHeight; ++y) {
            table->row_spans(y, std::span{spans.get(), static_cast<std::size_t>(table->columns())});
            table->row_mask(std::span{spans.get(), static_cast<std::size_t>(table->columns())}, mask);
            for (const std::uint8_t value : mask)
                with_source += value != 0 ? 1 : 0;
        }
        require(with_source == table->pixels_with_source());
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    std::vector<std::byte> bytes(size);
    if (size > 0)
        std::memcpy(bytes.data(), data, size);
    feed(bytes);
    const std::size_t head = most_map_bytes(kWidth, kHeight) - 2 * RemapTable::most_serial_bytes(kWidth, kHeight) - 4;
    if (size < head + 4)
        return 0;
    const std::size_t left = length_at(bytes, head - 8), right = length_at(bytes, head - 4);
    sign(bytes, head, left);
    sign(bytes, head + left, right);
    if (left < 4 || right < 4 || left + right != size - head - 4)
        return 0;
    std::vector<std::byte> covered(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(head));
    for (const std::size_t end : {head + left, head + left + right})
        covered.insert(covered.end(), bytes.begin() + static_cast<std::ptrdiff_t>(end - 4),
                       bytes.begin() + static_cast<std::ptrdiff_t>(end));
    covered.resize(covered.size() + 4);
    sign(covered, 0, covered.size());
    std::ranges::copy(std::span{covered}.last(4), bytes.end() - 4);
    feed(bytes);
    return 0;
}
