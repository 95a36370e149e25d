#include "drawn_snapshot.h"

#include <algorithm>
#include <array>
#include <span>

namespace dicot {
namespace {

constexpr std::int64_t kFirstSlot_us = 1'780'300'800'000'000; // 2026-06-01T08:00:00Z
constexpr std::int64_t kSlot_us = 600'000'000;

// splitmix64
std::uint64_t next(std::uint64_t& state)
{
    state += 0x9e3779b97f4a7c15;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
}

} // namespace

DrawnSnapshot draw_snapshot(std::uint64_t seed, int number)
{
    std::uint64_t state = seed * 1'000'003 + static_cast<std::uint64_t>(number);
    DrawnSnapshot drawn{};
    drawn.missed = next(state) % 6 == 0;
    drawn.began_us = next(state) % 12 == 0 ? number * kSlot_us : kFirstSlot_us + number * kSlot_us;
    // Few bytes, whole pages and odd ends; most clouds are of the size that fills some of the journal's transactions.
    const auto bytes_below = [&state](std::size_t most) {
        const std::size_t drawn_bytes = next(state) % most;
        return next(state) % 4 == 0 ? drawn_bytes / 4096 * 4096 : drawn_bytes;
    };
    drawn.files[0] = {"cloud.drc", bytes_below(160'000)};
    drawn.files[1] = {"left.jpg", bytes_below(40'000)};
    drawn.files[2] = {"right.jpg", bytes_below(300)};
    drawn.file_count = drawn.missed ? 0 : 2 + static_cast<int>(next(state) % 2);
    drawn.root = next(state);
    return drawn;
}

Status write_drawn(const DrawnSnapshot& snapshot, int index, ByteSink& sink)
{
    std::uint64_t state = snapshot.root + static_cast<std::uint64_t>(index);
    std::array<std::uint64_t, 512> block;
    for (std::size_t left = snapshot.files[index].bytes; left > 0;) {
        for (std::uint64_t& word : block)
            word = next(state);
        const std::size_t part = std::min(left, sizeof block);
        TRY(sink.write(std::as_bytes(std::span{block}).first(part)));
        left -= part;
    }
    return {};
}

} // namespace dicot
