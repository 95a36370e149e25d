#include "dicot/rectification/remap_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dicot {
namespace {

constexpr int kLargestCellLog2 = 3;
constexpr int kSmallestCellLog2 = 2;
// Corners that far outside are pulled nearer, so that positions with 16 fraction bits fit an int32.
constexpr double kLeastPx = -8192;
constexpr double kMostPx = 24576;
static_assert((kMostPx + 1) * (1 << kRemapFraction) < std::numeric_limits<std::int32_t>::max());

/// With kRemapWeightBits fraction bits, as the kernels round.
int weight_steps(std::int32_t position)
{
    return (position + (1 << 8)) >> 9;
}
static_assert(kRemapFraction - kRemapWeightBits == 9);

struct Steps
{
    int x, y;
};

Steps steps_at(std::span<const RemapSpan> spans, int cell_log2, int x)
{
    const RemapSpan& span = spans[static_cast<std::size_t>(x >> cell_log2)];
    const int u = x & ((1 << cell_log2) - 1);
    return {weight_steps(span.x + u * span.dx), weight_steps(span.y + u * span.dy)};
}

bool inside(Steps at, int width, int height)
{
    return at.x >= 0 && at.y >= 0 && at.x <= 128 * (width - 1) && at.y <= 128 * (height - 1);
}

std::int32_t corner_of(double position)
{
    const double scaled = std::clamp(position, kLeastPx, kMostPx) * (1 << RemapTable::kCornerFraction);
    return static_cast<std::int32_t>(std::floor(scaled + 0.5));
}

} // namespace

RemapTable RemapTable::finest(int width, int height)
{
    RemapTable table;
    table.width_ = width;
    table.height_ = height;
    table.cell_log2_ = kSmallestCellLog2;
    return table;
}

std::size_t RemapTable::most_bytes(int width, int height)
{
    Arena arena;
    finest(width, height).take(arena);
    return arena.peak();
}

std::size_t RemapTable::most_serial_bytes(int width, int height)
{
    return finest(width, height).serial_bytes();
}

void RemapTable::take(Arena& arena)
{
    corners_ = arena.take<Corner>(corner_count());
    row_ranges_ = arena.take<RowRange>(static_cast<std::size_t>(height_));
    scratch_ = arena.take<RemapSpan>(static_cast<std::size_t>(columns()));
}

std::size_t RemapTable::table_bytes() const
{
    return corners_.size_bytes() + row_ranges_.size_bytes();
}

Result<RemapTable> RemapTable::build(const LensMap& map, int width, int height, Arena& arena, const char* name)
{
    const std::size_t mark = arena.used();
    RemapTable table;
    table.width_ = width;
    table.height_ = height;
    for (table.cell_log2_ = kLargestCellLog2; table.cell_log2_ >= kSmallestCellLog2; --table.cell_log2_) {
        arena.rewind(mark);
        table.take(arena);
        if (arena.overrun())
            return failure(Fault::kSoftware, "%s: the arena is too small for its rectification table", name);
        table.fill_corners(map);
        const double worst_px = table.measure_error(map, table.scratch_);
        if (worst_px > kMostErrorPx)
            continue;
        table.worst_error_steps_ = static_cast<int>(std::ceil(worst_px * kErrorSteps));
        table.find_row_ranges(table.scratch_);
        if (table.pixels_with_source_ == 0)
            return failure(Fault::kBadData,
                           "%s: no pixel of the rectified picture lies in the camera's picture: calibrate again", name);
        return table;
    }
    return failure(Fault::kBadData,
                   "%s: the lens bends the picture so much that no table is exact to 1/64 px: calibrate again, or "
                   "crop more",
                   name);
}

// A bilinear patch with its corners on a bent surface lies on one side of it. Half the sag is taken off each corner, so
// that the error is as large at the corners as in the middle, and half as large.
void RemapTable::fill_corners(const LensMap& map)
{
    const int cell = cell_px();
    const double half = cell / 2.0;
    std::size_t i = 0;
    for (int row = 0; row <= cell_rows(); ++row) {
        for (int column = 0; column <= columns(); ++column) {
            const double x = column * cell;
            const double y = row * cell;
            const Point2 at = map.source_of(x, y);
            const Point2 around[] = {map.source_of(x - half, y), map.source_of(x + half, y), map.source_of(x, y - half),
                                     map.source_of(x, y + half)};
            const double bend_x = ((around[0].x + around[1].x) + (around[2].x + around[3].x)) - 4 * at.x;
            const double bend_y = ((around[0].y + around[1].y) + (around[2].y + around[3].y)) - 4 * at.y;
            corners_[i++] = {corner_of(at.x - bend_x / 4), corner_of(at.y - bend_y / 4)};
        }
    }
}

void RemapTable::row_spans(int y, std::span<RemapSpan> spans) const
{
    const int v = y & (cell_px() - 1);
    const int rest = cell_px() - v;
    const Corner* above =
        &corners_[static_cast<std::size_t>(y >> cell_log2_) * static_cast<std::size_t>(columns() + 1)];
    const Corner* below = above + columns() + 1;
    // A corner has 10 bits, each of the two weights adds cell_log2 bits, and the rest to 16 is a shift.
    const int step_scale = 1 << (kRemapFraction - kCornerFraction - 2 * cell_log2_);
    const int start_scale = step_scale << cell_log2_;
    Corner left{above[0].x * rest + below[0].x * v, above[0].y * rest + below[0].y * v};
    for (int i = 0; i < columns(); ++i) {
        const Corner right{above[i + 1].x * rest + below[i + 1].x * v, above[i + 1].y * rest + below[i + 1].y * v};
        spans[static_cast<std::size_t>(i)] = {left.x * start_scale, left.y * start_scale,
                                              (right.x - left.x) * step_scale, (right.y - left.y) * step_scale};
        left = right;
    }
}

void RemapTable::row_mask(std::span<const RemapSpan> spans, std::span<std::uint8_t> mask) const
{
    for (int x = 0; x < width_; ++x)
        mask[static_cast<std::size_t>(x)] = inside(steps_at(spans, cell_log2_, x), width_, height_) ? 255 : 0;
}

double RemapTable::measure_error(const LensMap& map, std::span<RemapSpan> spans) const
{
    double worst = 0;
    for (int y = 0; y < height_; ++y) {
        row_spans(y, spans);
        for (int x = 0; x < width_; ++x) {
            const Point2 exact = map.source_of(x, y);
            const Steps steps = steps_at(spans, cell_log2_, x);
            const double error = std::max(std::fabs(steps.x / 128.0 - exact.x), std::fabs(steps.y / 128.0 - exact.y));
            const bool has_source = exact.x >= 0 && exact.y >= 0 && exact.x <= width_ - 1 && exact.y <= height_ - 1;
            if (has_source || inside(steps, width_, height_))
                worst = std::max(worst, error);
        }
    }
    return worst;
}

void RemapTable::find_row_ranges(std::span<RemapSpan> spans)
{
    pixels_with_source_ = 0;
    for (int y = 0; y < height_; ++y) {
        row_spans(y, spans);
        const auto has_source = [&](int x) { return inside(steps_at(spans, cell_log2_, x), width_, height_); };
        RowRange range{0, 0};
        const auto add = [&](int x, int end) {
            if (range.end == 0)
                range.first = static_cast<std::uint16_t>(x);
            range.end = static_cast<std::uint16_t>(end);
            pixels_with_source_ += end - x;
        };
        for (int first = 0; first < width_; first += cell_px()) {
            const int end = std::min(first + cell_px(), width_);
            // Positions of a cell lie on a line, so what is between two inside is inside.
            if (has_source(first) && has_source(end - 1)) {
                add(first, end);
                continue;
            }
            for (int x = first; x < end; ++x)
                if (has_source(x))
                    add(x, x + 1);
        }
        row_ranges_[static_cast<std::size_t>(y)] = range;
    }
}

void remap(const RemapTable& table, const Kernels& kernels, ImageView<const Rgb8> source, ImageView<Rgb8> rectified,
           std::span<RemapSpan> spans)
{
    const int cell_log2 = table.cell_px() == 8 ? 3 : 2;
    const RemapSource from{&source.data->r, static_cast<std::int32_t>(3 * source.stride), source.width, source.height};
    for (int y = 0; y < table.height(); ++y) {
        table.row_spans(y, spans);
        kernels.remap_row(&rectified.row(y)->r, table.width(), spans.data(), cell_log2, from);
    }
}

void remap(const RemapTable& table, ImageView<const std::uint8_t> source, ImageView<std::uint8_t> rectified,
           std::span<RemapSpan> spans)
{
    const int cell_log2 = table.cell_px() == 8 ? 3 : 2;
    for (int y = 0; y < table.height(); ++y) {
        table.row_spans(y, spans);
        for (int x = 0; x < table.width(); ++x) {
            const Steps at = steps_at(spans, cell_log2, x);
            int value = 0;
            if (inside(at, source.width, source.height)) {
                const int left = std::min(at.x >> kRemapWeightBits, source.width - 2), a = at.x - 128 * left;
                const int above = std::min(at.y >> kRemapWeightBits, source.height - 2), b = at.y - 128 * above;
                const std::uint8_t* top = source.row(above) + left;
                const std::uint8_t* bottom = source.row(above + 1) + left;
                value = ((128 - b) * ((128 - a) * top[0] + a * top[1]) + b * ((128 - a) * bottom[0] + a * bottom[1]) +
                         (1 << 13)) >>
                        14;
            }
            rectified.at(x, y) = static_cast<std::uint8_t>(value);
        }
    }
}

} // namespace dicot
