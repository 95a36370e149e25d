#include "cloud_cases.h"

#include "dicot/codec/decode_cloud.h"
#include "dicot/codec/encode_cloud.h"
#include "dicot/os/heap_gate.h"
#include "dicot/os/memory_block.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>
#include <vector>

namespace dicot {
namespace {

/// A wall with a slight, even noise: neighbours resemble each other, as in real clouds.
std::vector<CloudPoint> smooth_points(std::size_t count)
{
    std::vector<CloudPoint> points(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto wave = static_cast<std::int32_t>(i * 2654435761U >> 16 & 15U);
        const auto column = static_cast<std::int32_t>(i % 640);
        const auto row = static_cast<std::int32_t>(i / 640);
        points[i] = {column * 4 + wave / 4,
                     row * 4 + wave / 4,
                     8000 + column + wave,
                     {static_cast<std::uint8_t>(80 + wave), static_cast<std::uint8_t>(140 - wave), 60},
                     static_cast<std::uint8_t>(200 + wave)};
    }
    return points;
}

/// The smooth wall on which a few points leap by half of what z spans. Differences are wrapped into that span, so these
/// are the largest; here they just fit the largest table of single differences, 2^18.
std::vector<CloudPoint> leaping_points(std::size_t count)
{
    std::vector<CloudPoint> points = smooth_points(count);
    points[count / 2].z = 261000;
    for (std::size_t i = 5000; i < count; i += 10000)
        points[i].z += 130000 - static_cast<std::int32_t>(i / 10000 % 7);
    return points;
}

struct Case
{
    const char* name;
    std::vector<CloudPoint> points;
    CloudGrid grid;
    std::vector<std::uint16_t> leaf = {};
};

std::vector<std::uint16_t> random_leaves(std::size_t count)
{
    std::mt19937 random{8};
    std::vector<std::uint16_t> leaf(count);
    for (std::uint16_t& number : leaf)
        number = static_cast<std::uint16_t>(random());
    return leaf;
}

std::vector<Case> cases()
{
    std::vector<Case> all;
    for (const int bits : {14, 18, 20})
        for (const std::size_t count : {1U, 1000U, 16385U, 32769U, 65537U, 131073U, 262145U,
                                        921600U}) { // just above the doublings of growing buffers
            const CloudGrid grid{100, bits, {0, 0, 0}};
            all.push_back({"random", test::random_points(grid, count, 1), grid});
        }
    all.push_back({"smooth", smooth_points(307200), {100, 14, {0, 0, 0}}});
    for (const std::size_t count : {10001U, 30000U, 307200U, 921600U})
        all.push_back({"leaping", leaping_points(count), {100, 20, {0, 0, 0}}});
    return all;
}

TEST(CodecMemory, StaysWithinTheStatedHeapAndTouchesNoOther)
{
    if (!heap_gate::replaces_operator_new()) {
        std::printf("NOT RUN: sanitizers bring their own operator new, so no heap can be lent\n");
        return;
    }
    std::vector<Case> all = cases();
    for (const std::size_t count : {1U, 1000U, 65537U, 262145U, 921600U}) {
        const CloudGrid grid{100, 20, {0, 0, 0}};
        all.push_back({"random with leaves", test::random_points(grid, count, 1), grid, random_leaves(count)});
    }
    for (const Case& one : all) {
        const std::size_t count = one.points.size(),
                          bytes = encode_heap_bytes(count) + one.leaf.size() * kLeafHeapBytes;
        const MemoryBlock block = MemoryBlock::map(bytes).value();
        const MemoryBlock decode_block = MemoryBlock::map(decode_heap_bytes(count)).value();
        std::vector<CloudPoint> back(count);
        std::printf("%s, %zu points, %d bits: ", one.name, count, one.grid.bits);

        heap_gate::seal(heap_gate::Breach::kCount);
        const Result<EncodedCloud> encoded = encode_cloud({one.points, one.grid}, {}, block.bytes(), one.leaf);
        Status decoded;
        if (encoded.ok()) {
            const Result<CloudOutline> outline = outline_of(encoded.value().bytes, "cloud.drc");
            decoded = outline.ok() ? decode_cloud(encoded.value().bytes, outline.value(), "cloud.drc",
                                                  decode_block.bytes(), back)
                                   : outline.status();
        }
        const std::uint64_t breaches = heap_gate::breaches();
        heap_gate::unseal();

        ASSERT_TRUE(encoded.ok()) << encoded.status().message();
        ASSERT_TRUE(decoded.ok()) << decoded.message();
        EXPECT_EQ(breaches, 0U);
        EXPECT_GT(encoded.value().heap_peak_bytes, 0U);
        EXPECT_LE(encoded.value().heap_peak_bytes, bytes);
        std::printf("%.2f bits/point, heap %.1f of %.1f bytes/point\n",
                    8.0 * static_cast<double>(encoded.value().bytes.size()) / static_cast<double>(count),
                    static_cast<double>(encoded.value().heap_peak_bytes) / static_cast<double>(count),
                    static_cast<double>(bytes) / static_cast<double>(count));
    }
}

TEST(CodecMemory, ASmallHeapIsARefusalNotACrash)
{
    if (!heap_gate::replaces_operator_new()) {
        std::printf("NOT RUN: sanitizers bring their own operator new, so no heap can be lent\n");
        return;
    }
    const CloudGrid grid{100, 14, {0, 0, 0}};
    const auto points = test::random_points(grid, 20000, 2);
    const MemoryBlock block = MemoryBlock::map(encode_heap_bytes(points.size())).value();
    const std::size_t file_bytes = encode_cloud({points, grid}, {}, block.bytes()).value().bytes.size();
    const std::vector<std::byte> file(block.bytes().begin(),
                                      block.bytes().begin() + static_cast<std::ptrdiff_t>(file_bytes));
    const CloudOutline outline = outline_of(file, "cloud.drc").value();
    std::vector<CloudPoint> back(points.size());
    int refused = 0;
    for (std::size_t bytes = 4096; bytes < block.bytes().size(); bytes += bytes / 5) {
        const Result<EncodedCloud> encoded = encode_cloud({points, grid}, {}, block.bytes().first(bytes));
        const Status decoded = decode_cloud(file, outline, "cloud.drc", block.bytes().first(bytes), back);
        EXPECT_TRUE(encoded.ok() || encoded.status().fault() == Fault::kConfig) << encoded.status().message();
        EXPECT_TRUE(decoded.ok() || decoded.fault() == Fault::kBadData) << decoded.message();
        refused += encoded.ok() ? 0 : 1;
    }
    EXPECT_GT(refused, 10);
}

} // namespace
} // namespace dicot
