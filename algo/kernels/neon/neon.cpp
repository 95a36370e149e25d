#include "dicot/kernels/kernels.h"

#include <arm_neon.h>

// For aarch64 and armhf: the differences are the four small functions under the #if.
// Everything here has internal linkage: see the note on vector files in kernels.h.
namespace dicot {
namespace {

// Two rows' values side by side: 4 words are 8 lanes.
uint16x8_t load_pairs(const PairU16* from)
{
    return vld1q_u16(&from->low);
}
int16x8_t load_signed(const PairU16* from)
{
    return vreinterpretq_s16_u16(load_pairs(from));
}

// One pair in all words. This load needs no alignment on either architecture.
int16x8_t broadcast(const PairU16* from)
{
    const void* word = from;
    return vreinterpretq_s16_u32(vld1q_dup_u32(static_cast<const std::uint32_t*>(word)));
}

#if defined(__aarch64__)
int32x4_t add_product_low(int32x4_t sum, int16x8_t a, int16x8_t b)
{
    return vmlal_s16(sum, vget_low_s16(a), vget_low_s16(b));
}
int32x4_t add_product_high(int32x4_t sum, int16x8_t a, int16x8_t b)
{
    return vmlal_high_s16(sum, a, b);
}
int32x4_t add_neighbours(int32x4_t low, int32x4_t high)
{
    return vpaddq_s32(low, high);
}
// A table of 16 bytes, looked up by 8 bytes below 16.
uint8x8_t look_up(uint8x16_t table, uint8x8_t index)
{
    return vqtbl1_u8(table, index);
}
// 2 pixels * 4 vectors * 3 sums leave 8 of the 32 registers.
constexpr bool kPixelsInPairs = true;
#else
int32x4_t add_product_low(int32x4_t sum, int16x8_t a, int16x8_t b)
{
    return vmlal_s16(sum, vget_low_s16(a), vget_low_s16(b));
}
int32x4_t add_product_high(int32x4_t sum, int16x8_t a, int16x8_t b)
{
    return vmlal_s16(sum, vget_high_s16(a), vget_high_s16(b));
}
int32x4_t add_neighbours(int32x4_t low, int32x4_t high)
{
    return vcombine_s32(vpadd_s32(vget_low_s32(low), vget_high_s32(low)),
                        vpadd_s32(vget_low_s32(high), vget_high_s32(high)));
}
uint8x8_t look_up(uint8x16_t table, uint8x8_t index)
{
    return vtbl2_u8({{vget_low_u8(table), vget_high_u8(table)}}, index);
}
constexpr bool kPixelsInPairs = false; // 4 vectors * 3 sums leave 4 of the 16 registers
#endif

// ---- support weights ------------------------------------------------------------------------------------------------

// Positions in the table of colour weights. The conversion rounds to nearest on both architectures.
uint32x4_t colour_index(int32x4_t squared_distance)
{
    const uint32x4_t bits = vreinterpretq_u32_f32(vcvtq_f32_s32(squared_distance));
    return vqsubq_u32(vshrq_n_u32(bits, 17), vdupq_n_u32(127 * kColourSteps - 1));
}

struct LabVectors
{
    int16x8_t l, a, b; // 8 pixels
};

LabVectors load_lab(LabRow row, int i)
{
    const int16x8x2_t la = vld2q_s16(&row.la[i].low);
    const int16x8x2_t b = vld2q_s16(&row.b[i].low);
    return {la.val[0], la.val[1], b.val[0]};
}

struct IndexVectors
{
    uint32x4_t first, second; // pixels 0 .. 3 and 4 .. 7
};

IndexVectors colour_indices(LabVectors p, LabVectors q)
{
    const int16x8_t l = vsubq_s16(p.l, q.l);
    const int16x8_t a = vsubq_s16(p.a, q.a);
    const int16x8_t b = vsubq_s16(p.b, q.b);
    const int32x4_t zero = vdupq_n_s32(0);
    const int32x4_t first = add_product_low(add_product_low(add_product_low(zero, l, l), a, a), b, b);
    const int32x4_t second = add_product_high(add_product_high(add_product_high(zero, l, l), a, a), b, b);
    return {colour_index(first), colour_index(second)};
}

// The table's entries for 4 pixels, low and high row by turns.
uint16x8_t gather(const std::uint16_t* colour, uint32x4_t low, uint32x4_t high)
{
    uint16x8_t pair = vdupq_n_u16(0);
    pair = vld1q_lane_u16(colour + vgetq_lane_u32(low, 0), pair, 0);
    pair = vld1q_lane_u16(colour + vgetq_lane_u32(high, 0), pair, 1);
    pair = vld1q_lane_u16(colour + vgetq_lane_u32(low, 1), pair, 2);
    pair = vld1q_lane_u16(colour + vgetq_lane_u32(high, 1), pair, 3);
    pair = vld1q_lane_u16(colour + vgetq_lane_u32(low, 2), pair, 4);
    pair = vld1q_lane_u16(colour + vgetq_lane_u32(high, 2), pair, 5);
    pair = vld1q_lane_u16(colour + vgetq_lane_u32(low, 3), pair, 6);
    return vld1q_lane_u16(colour + vgetq_lane_u32(high, 3), pair, 7);
}

void store_weights(PairU16* out, uint16x8_t colour_weights, int16x8_t space)
{
    const int16x8_t weights = vqrdmulhq_s16(vreinterpretq_s16_u16(colour_weights), space);
    vst1q_u16(&out->low, vreinterpretq_u16_s16(weights));
}

std::uint16_t single_weight(LabRow p, LabRow q, int i, const std::uint16_t* colour, std::uint16_t spatial)
{
    const int l = p.la[i].low - q.la[i].low;
    const int a = p.la[i].high - q.la[i].high;
    const int b = p.b[i].low - q.b[i].low;
    const unsigned weight = colour[vgetq_lane_u32(colour_index(vdupq_n_s32(l * l + a * a + b * b)), 0)];
    return static_cast<std::uint16_t>((weight * spatial + (1u << 14)) >> 15);
}

void support_weights(PairU16* out, int n, LabRow p, LabRow q_low, LabRow q_high, const std::uint16_t* colour,
                     PairU16 spatial)
{
    const int16x8_t space = broadcast(&spatial);
    int i = 0;
    for (; i + 8 <= n; i += 8) {
        const LabVectors centre = load_lab(p, i);
        const IndexVectors low = colour_indices(centre, load_lab(q_low, i));
        const IndexVectors high = colour_indices(centre, load_lab(q_high, i));
        store_weights(out + i, gather(colour, low.first, high.first), space);
        store_weights(out + i + 4, gather(colour, low.second, high.second), space);
    }
    for (; i < n; ++i) {
        out[i].low = single_weight(p, q_low, i, colour, spatial.low);
        out[i].high = single_weight(p, q_high, i, colour, spatial.high);
    }
}

// ---- matching cost --------------------------------------------------------------------------------------------------

// Stores the 8 lanes of `cost` into every second uint16 and leaves those between alone.
void store_alternate(std::uint16_t* to, uint16x8_t cost)
{
    vst1q_lane_u16(to, cost, 0);
    vst1q_lane_u16(to + 2, cost, 1);
    vst1q_lane_u16(to + 4, cost, 2);
    vst1q_lane_u16(to + 6, cost, 3);
    vst1q_lane_u16(to + 8, cost, 4);
    vst1q_lane_u16(to + 10, cost, 5);
    vst1q_lane_u16(to + 12, cost, 6);
    vst1q_lane_u16(to + 14, cost, 7);
}

uint8x8_t gather(const std::uint8_t* table, uint16x8_t index)
{
    uint8x8_t found = vdup_n_u8(0);
    found = vld1_lane_u8(table + vgetq_lane_u16(index, 0), found, 0);
    found = vld1_lane_u8(table + vgetq_lane_u16(index, 1), found, 1);
    found = vld1_lane_u8(table + vgetq_lane_u16(index, 2), found, 2);
    found = vld1_lane_u8(table + vgetq_lane_u16(index, 3), found, 3);
    found = vld1_lane_u8(table + vgetq_lane_u16(index, 4), found, 4);
    found = vld1_lane_u8(table + vgetq_lane_u16(index, 5), found, 5);
    found = vld1_lane_u8(table + vgetq_lane_u16(index, 6), found, 6);
    return vld1_lane_u8(table + vgetq_lane_u16(index, 7), found, 7);
}

void match_cost(std::uint16_t* out, int n, int disparities, CostRow left, CostRow right, const CostTables& tables)
{
    const uint8x16_t census_cost = vld1q_u8(tables.census);
    for (int i = 0; i < n; ++i) {
        const uint8x8_t red = vdup_n_u8(left.red[i]);
        const uint8x8_t green = vdup_n_u8(left.green[i]);
        const uint8x8_t blue = vdup_n_u8(left.blue[i]);
        const uint8x8_t census = vdup_n_u8(left.census[i]);
        for (int r = 0; r < disparities; r += 8) {
            const int j = i + r;
            uint16x8_t difference = vabdl_u8(red, vld1_u8(right.red + j));
            difference = vabal_u8(difference, green, vld1_u8(right.green + j));
            difference = vabal_u8(difference, blue, vld1_u8(right.blue + j));
            const uint8x8_t hamming = vcnt_u8(veor_u8(census, vld1_u8(right.census + j)));
            const uint16x8_t cost = vaddl_u8(gather(tables.difference, difference), look_up(census_cost, hamming));
            store_alternate(out + (i * disparities + r) * 2, cost);
        }
    }
}

// ---- aggregation ----------------------------------------------------------------------------------------------------

int16x8_t term_weights(int16x8_t left, const PairU16* right)
{
    return vqrdmulhq_s16(load_signed(right), left);
}

// The sums of one pixel over kVectors * 4 positions. Lanes of the numerators are even and odd row by turns until
// the end. Widening addition costs as much as adding in 16 bits first, so each column is widened at once.
// Nested, not an array: gcc 12 keeps arrays of vectors in memory.
template <unsigned kVectors>
struct PixelSums
{
    int32x4_t numerator_low = vdupq_n_s32(0);
    int32x4_t numerator_high = vdupq_n_s32(0);
    uint32x4_t denominator = vdupq_n_u32(0);
    PixelSums<kVectors - 1> others;

    void add(int16x8_t weights, int16x8_t cost)
    {
        numerator_low = add_product_low(numerator_low, weights, cost);
        numerator_high = add_product_high(numerator_high, weights, cost);
        denominator = vpadalq_u16(denominator, vreinterpretq_u16_s16(weights));
    }

    void store(std::uint32_t* to_numerator, std::uint32_t* to_denominator) const
    {
        const uint32x4_t sum = vreinterpretq_u32_s32(add_neighbours(numerator_low, numerator_high));
        vst1q_u32(to_numerator, vaddq_u32(vld1q_u32(to_numerator), sum));
        vst1q_u32(to_denominator, vaddq_u32(vld1q_u32(to_denominator), denominator));
        if constexpr (kVectors > 1)
            others.store(to_numerator + 4, to_denominator + 4);
    }
};
template <>
struct PixelSums<0>
{
};

// Adds one window column of one pixel; `weights` are those of the first vector. The weights of the next vector are
// asked for before these are used: a core that runs in order would wait for the multiplication.
template <unsigned kVectors>
void add_column(PixelSums<kVectors>& sums, int16x8_t weights, int16x8_t left, const PairU16* right, const PairU16* cost)
{
    if constexpr (kVectors > 1) {
        const int16x8_t next = term_weights(left, right + 4);
        sums.add(weights, load_signed(cost));
        add_column(sums.others, next, left, right + 4, cost + 4);
    } else {
        sums.add(weights, load_signed(cost));
    }
}

template <unsigned kVectors>
void add_column(PixelSums<kVectors>& sums, const PairU16* left, const PairU16* right, const PairU16* cost)
{
    const int16x8_t weight = broadcast(left);
    add_column(sums, term_weights(weight, right), weight, right, cost);
}

struct Two
{
    int16x8_t first, second;
};
struct TwoRights
{
    const PairU16* first;
    const PairU16* second;
};

Two term_weights(Two left, TwoRights right)
{
    return {term_weights(left.first, right.first), term_weights(left.second, right.second)};
}

// The same for two pixels which share the costs.
template <unsigned kVectors>
void add_columns(PixelSums<kVectors>& first, PixelSums<kVectors>& second, Two weights, Two left, TwoRights right,
                 const PairU16* cost)
{
    const int16x8_t shared = load_signed(cost);
    if constexpr (kVectors > 1) {
        const TwoRights next_right = {right.first + 4, right.second + 4};
        const Two next = term_weights(left, next_right);
        first.add(weights.first, shared);
        second.add(weights.second, shared);
        add_columns(first.others, second.others, next, left, next_right, cost + 4);
    } else {
        first.add(weights.first, shared);
        second.add(weights.second, shared);
    }
}

// Pixels i and i + 1. Column c of the first and column c - 1 of the second meet the same row of costs, which is loaded
// once for both.
template <unsigned kVectors>
void aggregate_two(const AggregateStrip& s, int i, int r)
{
    PixelSums<kVectors> first;
    PixelSums<kVectors> second;
    const PairU16* left = s.left_weights + i;
    const PairU16* right = s.right_weights + i + r;
    const PairU16* cost = s.costs + i * s.disparities + r;

    add_column(first, left, right, cost);
    for (int c = 1; c < s.columns; ++c) {
        const Two lefts = {broadcast(left + s.left_stride), broadcast(left + 1)};
        const TwoRights rights = {right + s.right_stride, right + 1};
        left += s.left_stride;
        right += s.right_stride;
        cost += s.disparities;
        add_columns(first, second, term_weights(lefts, rights), lefts, rights, cost);
    }
    add_column(second, left + 1, right + 1, cost + s.disparities);

    const int at = i * s.disparities + r;
    first.store(s.numerator + at, s.denominator + at);
    second.store(s.numerator + at + s.disparities, s.denominator + at + s.disparities);
}

template <unsigned kVectors>
void aggregate_one(const AggregateStrip& s, int i, int r)
{
    PixelSums<kVectors> sums;
    const PairU16* left = s.left_weights + i;
    const PairU16* right = s.right_weights + i + r;
    const PairU16* cost = s.costs + i * s.disparities + r;
    for (int c = 0; c < s.columns; ++c) {
        add_column(sums, left, right, cost);
        left += s.left_stride;
        right += s.right_stride;
        cost += s.disparities;
    }
    sums.store(s.numerator + i * s.disparities + r, s.denominator + i * s.disparities + r);
}

void aggregate(const AggregateStrip& s)
{
    int i = 0;
    if constexpr (kPixelsInPairs) {
        for (; i + 2 <= s.pixels; i += 2) {
            int r = 0;
            for (; r + 16 <= s.disparities; r += 16)
                aggregate_two<4>(s, i, r);
            for (; r < s.disparities; r += 8)
                aggregate_two<2>(s, i, r);
        }
    }
    for (; i < s.pixels; ++i) {
        int r = 0;
        for (; r + 16 <= s.disparities; r += 16)
            aggregate_one<4>(s, i, r);
        for (; r < s.disparities; r += 8)
            aggregate_one<2>(s, i, r);
    }
}

// ---- division -------------------------------------------------------------------------------------------------------

// floor(256 n / d) without a division, which armhf has for no vector. Two Newton steps make the estimate of 1/d good to
// better than 2^-20, so the estimate of the quotient (at most 51200) is off by less than 0.2 and, less 0.25, never too
// large and never 1 too small: truncated, it is the answer or 1 less. The remainder is then below 2 d < 2^32, so the
// lower 32 bits of it are all of it.
uint32x4_t quotient(uint32x4_t numerator, uint32x4_t denominator)
{
    const float32x4_t divisor = vcvtq_f32_u32(denominator);
    float32x4_t inverse = vrecpeq_f32(divisor);
    inverse = vmulq_f32(inverse, vrecpsq_f32(divisor, inverse));
    inverse = vmulq_f32(inverse, vrecpsq_f32(divisor, inverse));
    const float32x4_t scaled = vmulq_f32(vcvtq_f32_u32(numerator), vdupq_n_f32(256.0F));
    const float32x4_t estimate = vsubq_f32(vmulq_f32(scaled, inverse), vdupq_n_f32(0.25F));
    const uint32x4_t guess = vcvtq_u32_f32(estimate); // towards zero; a negative one becomes 0
    const uint32x4_t remainder = vmlsq_u32(vshlq_n_u32(numerator, 8), guess, denominator);
    return vsubq_u32(guess, vcgeq_u32(remainder, denominator)); // a true comparison is -1
}

void normalise(std::uint16_t* out, const std::uint32_t* numerator, const std::uint32_t* denominator, int n)
{
    int i = 0;
    for (; i + 4 <= n; i += 4)
        vst1_u16(out + i, vmovn_u32(quotient(vld1q_u32(numerator + i), vld1q_u32(denominator + i))));
    for (; i < n; ++i)
        out[i] = static_cast<std::uint16_t>(std::uint64_t{numerator[i]} * 256 / denominator[i]);
}

// ---- remap ----------------------------------------------------------------------------------------------------------

// Two neighbouring pixels in the lower 6 bytes. The 8 bytes end at the row's end at the latest.
uint8x8_t pixel_pair(const std::uint8_t* from, int64x1_t shift)
{
    return vreinterpret_u8_u64(vshl_u64(vreinterpret_u64_u8(vld1_u8(from)), shift)); // a negative shift goes right
}

// (128 - a) of the left pixel and a of the right one; three lanes count.
uint16x4_t blend_columns(uint8x8_t pair, uint8x8_t one, uint8x8_t second)
{
    return vget_low_u16(vmlal_u8(vmull_u8(pair, one), vext_u8(pair, pair, 3), second));
}

struct RemapQuad
{
    std::int32_t x[4], y[4]; // held inside, with 7 fraction bits
    std::uint32_t inside[4];
};

RemapQuad positions(const RemapSpan& span, int first, const RemapSource& source)
{
    static const std::int32_t kRamp[4] = {0, 1, 2, 3};
    const int32x4_t u = vaddq_s32(vld1q_s32(kRamp), vdupq_n_s32(first));
    const int32x4_t x = vrshrq_n_s32(vmlaq_n_s32(vdupq_n_s32(span.x), u, span.dx), 9);
    const int32x4_t y = vrshrq_n_s32(vmlaq_n_s32(vdupq_n_s32(span.y), u, span.dy), 9);
    const int32x4_t zero = vdupq_n_s32(0);
    const int32x4_t held_x = vmaxq_s32(vminq_s32(x, vdupq_n_s32(128 * (source.width - 1))), zero);
    const int32x4_t held_y = vmaxq_s32(vminq_s32(y, vdupq_n_s32(128 * (source.height - 1))), zero);
    RemapQuad quad;
    vst1q_s32(quad.x, held_x);
    vst1q_s32(quad.y, held_y);
    vst1q_u32(quad.inside, vandq_u32(vceqq_s32(x, held_x), vceqq_s32(y, held_y)));
    return quad;
}

uint16x4_t remap_pixel(int x, int y, const RemapSource& source)
{
    const int left = x >> 7 < source.width - 2 ? x >> 7 : source.width - 2;
    const int above = y >> 7 < source.height - 2 ? y >> 7 : source.height - 2;
    const int a = x - (left << 7); // 0 .. 128
    const int b = y - (above << 7);
    const int last_load = 3 * source.width - 8;
    const int load = 3 * left < last_load ? 3 * left : last_load;
    const int64x1_t surplus = vdup_n_s64(-8 * (3 * left - load));
    const uint8x8_t one = vdup_n_u8(static_cast<std::uint8_t>(128 - a));
    const uint8x8_t second = vdup_n_u8(static_cast<std::uint8_t>(a));
    const std::uint8_t* from = source.rgb + above * source.stride_bytes + load;
    const uint16x4_t top = blend_columns(pixel_pair(from, surplus), one, second);
    const uint16x4_t bottom = blend_columns(pixel_pair(from + source.stride_bytes, surplus), one, second);
    const uint32x4_t sum =
        vmlal_n_u16(vmull_n_u16(top, static_cast<std::uint16_t>(128 - b)), bottom, static_cast<std::uint16_t>(b));
    return vrshrn_n_u32(sum, 14);
}

void remap_row(std::uint8_t* rgb, int n, const RemapSpan* spans, int cell_log2, const RemapSource& source)
{
    const int in_cell = (1 << cell_log2) - 1;
    for (int i = 0; i < n; i += 4) {
        const RemapQuad quad = positions(spans[i >> cell_log2], i & in_cell, source);
        const int count = n - i < 4 ? n - i : 4;
        for (int k = 0; k < count; ++k) {
            const uint16x4_t pixel = vand_u16(remap_pixel(quad.x[k], quad.y[k], source),
                                              vdup_n_u16(static_cast<std::uint16_t>(quad.inside[k])));
            const uint8x8_t bytes = vmovn_u16(vcombine_u16(pixel, pixel));
            std::uint8_t* const to = rgb + 3 * (i + k);
            vst1_lane_u8(to, bytes, 0);
            vst1_lane_u8(to + 1, bytes, 1);
            vst1_lane_u8(to + 2, bytes, 2);
        }
    }
}

} // namespace

// In neon_paths.cpp.
std::uint16_t neon_path_step(std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                             std::uint16_t least, PathPenalty penalty, int first, int axis);
void neon_winners(Winner* out, const std::uint16_t* costs, int n, int axis);
void neon_right_winners(std::uint16_t* cost, std::uint16_t* position, const std::uint16_t* costs, int n, int axis);

extern const Kernels kNeonKernels;
const Kernels kNeonKernels = {"neon",         support_weights, match_cost,         aggregate, normalise,
                              neon_path_step, neon_winners,    neon_right_winners, remap_row};

} // namespace dicot
