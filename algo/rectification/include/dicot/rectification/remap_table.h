// Where every pixel of a rectified picture comes from, as a small table of integers.
#pragma once

#include "dicot/base/arena.h"
#include "dicot/base/image.h"
#include "dicot/base/status.h"
#include "dicot/kernels/kernels.h"
#include "dicot/rectification/lens_map.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace dicot {

/// The corners of square cells of 8 (or, where the lens bends too much, 4) pixels hold source positions with
/// kCornerFraction fraction bits; within a cell the position is bilinear in exact integers (kRemapFraction bits),
/// rounded once to kRemapWeightBits bits for interpolation. A table exists only when the position so rounded is within
/// kMostErrorPx of the double map, in x and in y, at every pixel whose source lies in the picture, and no other pixel
/// has a source. Two cameras of 1280 x 720 take 0.24 MB with cells of 8.
class RemapTable
{
public:
    static constexpr int kCornerFraction = 10;
    static constexpr double kMostErrorPx = 1.0 / 64;
    static constexpr int kErrorSteps = 1 << 20; ///< of worst_error_px() in a px

    /// Pixels first .. end - 1 of a row: no pixel outside has a source.
    struct RowRange
    {
        std::uint16_t first, end;
    };

    RemapTable() = default;

    /// Bytes of an arena that build() and read() never exceed.
    static std::size_t most_bytes(int width, int height);
    /// Bytes that serial_bytes() never exceeds.
    static std::size_t most_serial_bytes(int width, int height);

    /// A table for pictures of the same size before and after, 8 to 16384 px on a side, in memory of `arena`.
    /// The same map gives the same bytes on every CPU. `name` stands for the rig in sentences.
    /// Fault::kBadData: the lens bends so much that no cell size is exact enough, or no pixel has a source.
    static Result<RemapTable> build(const LensMap& map, int width, int height, Arena& arena, const char* name);

    int width() const { return width_; }
    int height() const { return height_; }
    int cell_px() const { return 1 << cell_log2_; }
    /// Cells of a row, the last one perhaps beyond the picture.
    int columns() const { return (width_ + cell_px() - 1) / cell_px(); }
    int cell_rows() const { return (height_ + cell_px() - 1) / cell_px(); }
    /// As build() measured it, rounded up to a step.
    double worst_error_px() const { return static_cast<double>(worst_error_steps_) / kErrorSteps; }
    std::int64_t pixels_with_source() const { return pixels_with_source_; }
    std::size_t table_bytes() const;
    std::span<const RowRange> row_ranges() const { return row_ranges_; }

    /// Row y as the kernels take it; `spans` has columns() elements.
    void row_spans(int y, std::span<RemapSpan> spans) const;
    /// mask[x] = 255 where pixel (x, y) has a source, else 0. `spans` as row_spans() filled it for this row.
    void row_mask(std::span<const RemapSpan> spans, std::span<std::uint8_t> mask) const;

    /// The table as bytes (README.md), the last 4 being the CRC-32 (IEEE 802.3) of the others; the same everywhere.
    /// serial_bytes() of them. Returns the CRC-32.
    std::size_t serial_bytes() const;
    std::uint32_t write(std::span<std::byte> into) const;
    /// A table out of bytes that may come from anywhere. Fault::kBadData: cut short, damaged, not a table.
    static Result<RemapTable> read(std::span<const std::byte> bytes, Arena& arena, const char* name);

private:
    struct Corner
    {
        std::int32_t x, y;
    };

    /// Without memory: the largest table for this size.
    static RemapTable finest(int width, int height);
    std::size_t corner_count() const
    {
        return static_cast<std::size_t>(columns() + 1) * static_cast<std::size_t>(cell_rows() + 1);
    }
    void take(Arena& arena);
    void fill_corners(const LensMap& map);
    /// Largest error, or infinity where the table gives a source to a pixel that has none.
    double measure_error(const LensMap& map, std::span<RemapSpan> spans) const;
    void find_row_ranges(std::span<RemapSpan> spans);
    void serialise(std::span<std::byte> into) const;

    int width_ = 0;
    int height_ = 0;
    int cell_log2_ = 3;
    std::span<Corner> corners_;
    std::span<RowRange> row_ranges_;
    std::span<RemapSpan> scratch_;
    int worst_error_steps_ = 0;
    std::int64_t pixels_with_source_ = 0;
};

/// Writes the rectified picture, both of the table's size; pixels without a source become 0. Bilinear with 7-bit
/// fractions, rounding as Kernels::remap_row says. `spans` has table.columns() elements of scratch.
void remap(const RemapTable& table, const Kernels& kernels, ImageView<const Rgb8> source, ImageView<Rgb8> rectified,
           std::span<RemapSpan> spans);
/// The same of one channel, with the same rounding.
void remap(const RemapTable& table, ImageView<const std::uint8_t> source, ImageView<std::uint8_t> rectified,
           std::span<RemapSpan> spans);

} // namespace dicot
