#include "dicot/kernels/kernels.h"

#include <immintrin.h>

// Everything here has internal linkage: see the note on vector files in kernels.h.
namespace dicot {
namespace {

using Vec = __m256i;

#define DICOT_LOAD(pointer) _mm256_loadu_si256(reinterpret_cast<const __m256i*>(pointer))
#define DICOT_STORE(pointer, value) _mm256_storeu_si256(reinterpret_cast<__m256i*>(pointer), value)

int scalar_index(int squared_distance)
{
    const __m128i bits = _mm_castps_si128(_mm_cvtepi32_ps(_mm_cvtsi32_si128(squared_distance)));
    const int index = _mm_cvtsi128_si32(_mm_srli_epi32(bits, 17)) - (127 * kColourSteps - 1);
    return index < 0 ? 0 : index;
}

std::uint16_t scalar_weight(LabRow p, LabRow q, int i, const std::uint16_t* colour, std::uint16_t spatial)
{
    const int l = p.la[i].low - q.la[i].low;
    const int a = p.la[i].high - q.la[i].high;
    const int b = p.b[i].low - q.b[i].low;
    const unsigned weight = colour[scalar_index(l * l + a * a + b * b)];
    return static_cast<std::uint16_t>((weight * spatial + (1u << 14)) >> 15);
}

// Colour weights of 8 pixels, one in each 32-bit lane. The table is read 32 bits at a time and masked.
Vec colour_weights(Vec p_la, Vec p_b, LabRow q, int i, const std::uint16_t* colour)
{
    const Vec la = _mm256_sub_epi16(p_la, DICOT_LOAD(q.la + i));
    const Vec b = _mm256_sub_epi16(p_b, DICOT_LOAD(q.b + i));
    const Vec squared = _mm256_add_epi32(_mm256_madd_epi16(la, la), _mm256_madd_epi16(b, b));
    const Vec bits = _mm256_castps_si256(_mm256_cvtepi32_ps(squared));
    const Vec index = _mm256_sub_epi32(_mm256_srli_epi32(bits, 17), _mm256_set1_epi32(127 * kColourSteps - 1));
    const Vec safe = _mm256_max_epi32(index, _mm256_setzero_si256());
    return _mm256_i32gather_epi32(reinterpret_cast<const int*>(colour), safe, 2);
}

void support_weights(PairU16* out, int n, LabRow p, LabRow q_low, LabRow q_high, const std::uint16_t* colour,
                     PairU16 spatial)
{
    const Vec space = _mm256_set1_epi32(spatial.low | (spatial.high << 16));
    int i = 0;
    for (; i + 8 <= n; i += 8) {
        const Vec la = DICOT_LOAD(p.la + i);
        const Vec b = DICOT_LOAD(p.b + i);
        const Vec low = colour_weights(la, b, q_low, i, colour);
        const Vec high = colour_weights(la, b, q_high, i, colour);
        const Vec pair = _mm256_blend_epi16(low, _mm256_slli_epi32(high, 16), 0xAA);
        DICOT_STORE(out + i, _mm256_mulhrs_epi16(pair, space));
    }
    for (; i < n; ++i) {
        out[i].low = scalar_weight(p, q_low, i, colour, spatial.low);
        out[i].high = scalar_weight(p, q_high, i, colour, spatial.high);
    }
}

// |left - right| of 8 pixels in 16-bit lanes.
__m128i distance8(__m128i left, const std::uint8_t* right)
{
    const __m128i wide = _mm_cvtepu8_epi16(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(right)));
    return _mm_abs_epi16(_mm_sub_epi16(left, wide));
}

void match_cost(std::uint16_t* out, int n, int disparities, CostRow left, CostRow right, const CostTables& tables)
{
    const __m128i nibble_count = _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
    const __m128i nibble = _mm_set1_epi8(15);
    const __m128i census_cost = _mm_loadu_si128(reinterpret_cast<const __m128i*>(tables.census));
    const Vec byte_mask = _mm256_set1_epi32(0xFF);
    const int* difference_cost = reinterpret_cast<const int*>(tables.difference);
    for (int i = 0; i < n; ++i) {
        const __m128i red = _mm_set1_epi16(left.red[i]);
        const __m128i green = _mm_set1_epi16(left.green[i]);
        const __m128i blue = _mm_set1_epi16(left.blue[i]);
        const __m128i census = _mm_set1_epi8(static_cast<char>(left.census[i]));
        for (int r = 0; r < disparities; r += 8) {
            const int j = i + r;
            const __m128i difference =
                _mm_add_epi16(_mm_add_epi16(distance8(red, right.red + j), distance8(green, right.green + j)),
                              distance8(blue, right.blue + j));
            const __m128i bits =
                _mm_xor_si128(census, _mm_loadl_epi64(reinterpret_cast<const __m128i*>(right.census + j)));
            const __m128i hamming =
                _mm_add_epi8(_mm_shuffle_epi8(nibble_count, _mm_and_si128(bits, nibble)),
                             _mm_shuffle_epi8(nibble_count, _mm_and_si128(_mm_srli_epi16(bits, 4), nibble)));
            const Vec by_census = _mm256_cvtepu8_epi32(_mm_shuffle_epi8(census_cost, hamming));
            const Vec by_difference = _mm256_and_si256(
                _mm256_i32gather_epi32(difference_cost, _mm256_cvtepu16_epi32(difference), 1), byte_mask);
            const Vec cost = _mm256_add_epi32(by_census, by_difference);
            // The 16-bit half beside each result belongs to the other row of the group and is kept.
            std::uint16_t* to = out + (i * disparities + r) * 2;
            alignas(32) std::uint32_t lanes[8];
            _mm256_store_si256(reinterpret_cast<__m256i*>(lanes), cost);
            for (int k = 0; k < 8; ++k)
                to[2 * k] = static_cast<std::uint16_t>(lanes[k]);
        }
    }
}

// `kVectors` * 8 disparities of one pixel over all columns.
// Two columns' weights are added in 16 bits before they are widened: 2 * kRightWeightOne < 2^15.
template <unsigned kVectors>
void aggregate_pixel(const AggregateStrip& s, int i, int r)
{
    const Vec ones = _mm256_set1_epi16(1);
    Vec numerator[kVectors];
    Vec denominator[kVectors];
    for (unsigned v = 0; v < kVectors; ++v)
        numerator[v] = denominator[v] = _mm256_setzero_si256();

    const PairU16* left = s.left_weights + i;
    const PairU16* right = s.right_weights + i + r;
    const PairU16* cost = s.costs + i * s.disparities + r;
    int c = 0;
    for (; c + 2 <= s.columns; c += 2) {
        const Vec left0 = _mm256_set1_epi32(left[0].low | (left[0].high << 16));
        const Vec left1 = _mm256_set1_epi32(left[s.left_stride].low | (left[s.left_stride].high << 16));
        for (unsigned v = 0; v < kVectors; ++v) {
            const Vec w0 = _mm256_mulhrs_epi16(left0, DICOT_LOAD(right + 8 * v));
            const Vec w1 = _mm256_mulhrs_epi16(left1, DICOT_LOAD(right + s.right_stride + 8 * v));
            numerator[v] = _mm256_add_epi32(numerator[v], _mm256_madd_epi16(w0, DICOT_LOAD(cost + 8 * v)));
            numerator[v] =
                _mm256_add_epi32(numerator[v], _mm256_madd_epi16(w1, DICOT_LOAD(cost + s.disparities + 8 * v)));
            denominator[v] = _mm256_add_epi32(denominator[v], _mm256_madd_epi16(_mm256_add_epi16(w0, w1), ones));
            // One vector after the other: interleaved by the compiler, they need more registers than there are.
            asm volatile("" : "+x"(numerator[v]), "+x"(denominator[v]));
        }
        left += 2 * s.left_stride;
        right += 2 * s.right_stride;
        cost += 2 * s.disparities;
    }
    if (c < s.columns) {
        const Vec left0 = _mm256_set1_epi32(left[0].low | (left[0].high << 16));
        for (unsigned v = 0; v < kVectors; ++v) {
            const Vec w0 = _mm256_mulhrs_epi16(left0, DICOT_LOAD(right + 8 * v));
            numerator[v] = _mm256_add_epi32(numerator[v], _mm256_madd_epi16(w0, DICOT_LOAD(cost + 8 * v)));
            denominator[v] = _mm256_add_epi32(denominator[v], _mm256_madd_epi16(w0, ones));
        }
    }
    std::uint32_t* to_numerator = s.numerator + i * s.disparities + r;
    std::uint32_t* to_denominator = s.denominator + i * s.disparities + r;
    for (unsigned v = 0; v < kVectors; ++v) {
        DICOT_STORE(to_numerator + 8 * v, _mm256_add_epi32(DICOT_LOAD(to_numerator + 8 * v), numerator[v]));
        DICOT_STORE(to_denominator + 8 * v, _mm256_add_epi32(DICOT_LOAD(to_denominator + 8 * v), denominator[v]));
    }
}

void aggregate(const AggregateStrip& s)
{
    for (int i = 0; i < s.pixels; ++i) {
        int r = 0;
        for (; r + 32 <= s.disparities; r += 32)
            aggregate_pixel<4>(s, i, r);
        for (; r + 16 <= s.disparities; r += 16)
            aggregate_pixel<2>(s, i, r);
        for (; r < s.disparities; r += 8)
            aggregate_pixel<1>(s, i, r);
    }
}

// Exact. In single precision the quotient is off by less than 2^-22 of it, 2^-6 of one; less 2^-5, cut off, it is the
// right one or one too small. The remainder, below 2^32 modulo 2^32, tells which.
void normalise(std::uint16_t* out, const std::uint32_t* numerator, const std::uint32_t* denominator, int n)
{
    const __m256 two32 = _mm256_set1_ps(4294967296.0f);
    int i = 0;
    for (; i + 8 <= n; i += 8) {
        const Vec num = DICOT_LOAD(numerator + i);
        const Vec den = DICOT_LOAD(denominator + i);
        // The numerator has 32 bits and the conversion is signed: a negative one is 2^32 too small.
        const __m256 raw = _mm256_cvtepi32_ps(num);
        const __m256 whole = _mm256_blendv_ps(raw, _mm256_add_ps(raw, two32), raw);
        const __m256 quotient = _mm256_div_ps(_mm256_mul_ps(whole, _mm256_set1_ps(256.0f)), _mm256_cvtepi32_ps(den));
        const Vec low = _mm256_cvttps_epi32(_mm256_sub_ps(quotient, _mm256_set1_ps(0.03125f)));
        const Vec rest = _mm256_sub_epi32(_mm256_slli_epi32(num, 8), _mm256_mullo_epi32(low, den));
        const Vec goes_once_more = _mm256_cmpeq_epi32(_mm256_max_epu32(rest, den), rest); // -1
        const Vec exact = _mm256_sub_epi32(low, goes_once_more);
        _mm_storeu_si128(reinterpret_cast<__m128i*>(out + i),
                         _mm_packus_epi32(_mm256_castsi256_si128(exact), _mm256_extracti128_si256(exact, 1)));
    }
    for (; i < n; ++i)
        out[i] = static_cast<std::uint16_t>(std::uint64_t{numerator[i]} * 256 / denominator[i]);
}

// Four pixels: x in the lower half of the position vectors, y in the upper.
struct Remap
{
    __m256i ramp;      // 0 1 2 3 0 1 2 3
    __m256i last;      // 128 (side - 1)
    __m256i last_left; // side - 2: the second pixel of an interpolated pair is inside too
    __m128i stride;
    __m128i last_load; // of the 8 bytes that hold two pixels
    long long next_row;
    const std::uint8_t* rgb;

    explicit Remap(const RemapSource& source)
        : ramp(_mm256_setr_epi32(0, 1, 2, 3, 0, 1, 2, 3)),
          last(_mm256_set_m128i(_mm_set1_epi32(128 * (source.height - 1)), _mm_set1_epi32(128 * (source.width - 1)))),
          last_left(_mm256_set_m128i(_mm_set1_epi32(source.height - 2), _mm_set1_epi32(source.width - 2))),
          stride(_mm_set1_epi32(source.stride_bytes)), last_load(_mm_set1_epi32(3 * source.width - 8)),
          next_row(source.stride_bytes), rgb(source.rgb)
    {
    }

    static __m128i two_loads(const std::uint8_t* low, const std::uint8_t* high)
    {
        return _mm_unpacklo_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(low)),
                                  _mm_loadl_epi64(reinterpret_cast<const __m128i*>(high)));
    }

    // 2 x 3 bytes of each of four pixels, red, green and blue beside their right neighbours' and less 128, times the
    // weights of the columns: maddubs takes one signed factor, and a weight may be 128.
    static Vec columns(const std::uint8_t* const (&from)[4], long long row, Vec surplus_bits, Vec weights)
    {
        const Vec pairs = _mm256_setr_epi8(0, 3, 1, 4, 2, 5, -1, -1, 8, 11, 9, 12, 10, 13, -1, -1, 0, 3, 1, 4, 2, 5, -1,
                                           -1, 8, 11, 9, 12, 10, 13, -1, -1);
        // Four loads: a gather takes longer, several times so on cores with mended microcode.
        const Vec bytes =
            _mm256_set_m128i(two_loads(from[2] + row, from[3] + row), two_loads(from[0] + row, from[1] + row));
        const Vec pixels = _mm256_shuffle_epi8(_mm256_srlv_epi64(bytes, surplus_bits), pairs);
        return _mm256_maddubs_epi16(weights, _mm256_xor_si256(pixels, _mm256_set1_epi8(-128)));
    }

    // 12 bytes.
    __m128i quad(const RemapSpan& span, int first) const
    {
        const __m128i whole = _mm_loadu_si128(reinterpret_cast<const __m128i*>(&span));
        const Vec both = _mm256_broadcastsi128_si256(whole);
        const Vec start = _mm256_permutevar8x32_epi32(both, _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1));
        const Vec step = _mm256_permutevar8x32_epi32(both, _mm256_setr_epi32(2, 2, 2, 2, 3, 3, 3, 3));
        const Vec way = _mm256_mullo_epi32(step, _mm256_add_epi32(ramp, _mm256_set1_epi32(first)));
        const Vec fine =
            _mm256_srai_epi32(_mm256_add_epi32(_mm256_add_epi32(start, way), _mm256_set1_epi32(1 << 8)), 9);
        const Vec held = _mm256_max_epi32(_mm256_min_epi32(fine, last), _mm256_setzero_si256());
        const Vec same = _mm256_cmpeq_epi32(fine, held);
        const __m128i inside = _mm_and_si128(_mm256_castsi256_si128(same), _mm256_extracti128_si256(same, 1));

        const Vec corner = _mm256_min_epi32(_mm256_srli_epi32(held, 7), last_left);
        const Vec second = _mm256_sub_epi32(held, _mm256_slli_epi32(corner, 7)); // 0 .. 128
        const Vec one = _mm256_sub_epi32(_mm256_set1_epi32(128), second);
        const __m128i x = _mm256_castsi256_si128(corner);
        const __m128i at = _mm_add_epi32(x, _mm_add_epi32(x, x));
        const __m128i load = _mm_min_epi32(at, last_load);
        const Vec surplus = _mm256_slli_epi64(_mm256_cvtepu32_epi64(_mm_sub_epi32(at, load)), 3);
        const __m128i row = _mm_mullo_epi32(_mm256_extracti128_si256(corner, 1), stride);

        // Weights of the columns as bytes (one, second) four times a pixel, of the rows as words twice a pixel.
        const __m128i a = _mm_or_si128(_mm256_castsi256_si128(one), _mm_slli_epi32(_mm256_castsi256_si128(second), 8));
        const Vec by_column = _mm256_shuffle_epi8(_mm256_cvtepu32_epi64(a),
                                                  _mm256_setr_epi8(0, 1, 0, 1, 0, 1, 0, 1, 8, 9, 8, 9, 8, 9, 8, 9, 0, 1,
                                                                   0, 1, 0, 1, 0, 1, 8, 9, 8, 9, 8, 9, 8, 9));
        const __m128i b =
            _mm_or_si128(_mm256_extracti128_si256(one, 1), _mm_slli_epi32(_mm256_extracti128_si256(second, 1), 16));
        const Vec by_row = _mm256_cvtepu32_epi64(b);

        const __m128i offset = _mm_add_epi32(row, load);
        const std::uint8_t* const from[4] = {rgb + _mm_extract_epi32(offset, 0), rgb + _mm_extract_epi32(offset, 1),
                                             rgb + _mm_extract_epi32(offset, 2), rgb + _mm_extract_epi32(offset, 3)};
        const Vec above = columns(from, 0, surplus, by_column);
        const Vec below = columns(from, next_row, surplus, by_column);
        // The first and third pixel, and the second and fourth.
        const Vec even = _mm256_madd_epi16(_mm256_unpacklo_epi16(above, below), _mm256_shuffle_epi32(by_row, 0x00));
        const Vec odd = _mm256_madd_epi16(_mm256_unpackhi_epi16(above, below), _mm256_shuffle_epi32(by_row, 0xAA));
        const Vec round = _mm256_set1_epi32((128 << 14) + (1 << 13)); // gives back the 128, too
        const Vec words = _mm256_packs_epi32(_mm256_srai_epi32(_mm256_add_epi32(even, round), 14),
                                             _mm256_srai_epi32(_mm256_add_epi32(odd, round), 14));
        const __m128i bytes = _mm_packus_epi16(_mm256_castsi256_si128(words), _mm256_extracti128_si256(words, 1));
        return _mm_shuffle_epi8(_mm_and_si128(bytes, inside),
                                _mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1));
    }
};

// Eight pixels whose neighbours all lie inside, so that nothing must be held, masked or shifted back. Pixels k and k +
// 4 share a vector, one in each half: every value is then where a shuffle within the halves can reach it.
struct InnerRemap
{
    Vec ramp;   // pixel u of its cell, in cells of 8 or 4
    Vec last_x; // the largest positions of the kind
    Vec last_y;
    Vec stride;
    const std::uint8_t* rgb;
    long long next_row;

    InnerRemap(const RemapSource& source, int cell_log2)
        : ramp(cell_log2 == 3 ? _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7) : _mm256_setr_epi32(0, 1, 2, 3, 0, 1, 2, 3)),
          last_x(_mm256_set1_epi32(128 * (source.width - 2) - 1)), // 8 bytes from there end inside the row
          last_y(_mm256_set1_epi32(128 * (source.height - 1) - 1)), stride(_mm256_set1_epi32(source.stride_bytes)),
          rgb(source.rgb), next_row(source.stride_bytes)
    {
    }

    // start + u step of the first four pixels' cell and of the last four's.
    Vec positions(const std::int32_t (&start)[2], const std::int32_t (&step)[2]) const
    {
        const Vec from = _mm256_blend_epi32(_mm256_set1_epi32(start[0]), _mm256_set1_epi32(start[1]), 0xF0);
        const Vec by = _mm256_blend_epi32(_mm256_set1_epi32(step[0]), _mm256_set1_epi32(step[1]), 0xF0);
        const Vec fine = _mm256_add_epi32(from, _mm256_mullo_epi32(by, ramp));
        return _mm256_srai_epi32(_mm256_add_epi32(fine, _mm256_set1_epi32(1 << 8)), 9);
    }

    static Vec everywhere(const std::uint8_t* from)
    {
        // A broadcast from memory costs a load alone, and the blends that follow may run on any port.
        return _mm256_broadcastq_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(from)));
    }

    // Red, green and blue of pixel kFirst in the lower half and of pixel kFirst + 4 in the upper, 32 bits each.
    template <int kFirst>
    Vec two_pixels(const std::int32_t* offsets, Vec by_column, Vec by_row) const
    {
        const std::uint8_t* const low = rgb + offsets[kFirst];
        const std::uint8_t* const high = rgb + offsets[kFirst + 4];
        const Vec bytes =
            _mm256_blend_epi32(_mm256_blend_epi32(everywhere(low), everywhere(low + next_row), 0x0C),
                               _mm256_blend_epi32(everywhere(high), everywhere(high + next_row), 0xC0), 0xF0);
        const Vec fours = _mm256_setr_epi8(0, 3, 8, 11, 1, 4, 9, 12, 2, 5, 10, 13, -1, -1, -1, -1, //
                                           0, 3, 8, 11, 1, 4, 9, 12, 2, 5, 10, 13, -1, -1, -1, -1);
        // Less 128, because maddubs takes one signed factor, and a weight may be 128.
        const Vec pixels = _mm256_xor_si256(_mm256_shuffle_epi8(bytes, fours), _mm256_set1_epi8(-128));
        const Vec rows = _mm256_maddubs_epi16(_mm256_shuffle_epi32(by_column, kFirst * 0x55), pixels);
        const Vec sums = _mm256_madd_epi16(rows, _mm256_shuffle_epi32(by_row, kFirst * 0x55));
        const Vec round = _mm256_set1_epi32((128 << 14) + (1 << 13)); // gives back the 128, too
        return _mm256_srai_epi32(_mm256_add_epi32(sums, round), 14);
    }

    // 24 bytes; false, and nothing written, where a pixel is not of the kind.
    bool eight(std::uint8_t* to, const RemapSpan& first, const RemapSpan& last) const
    {
        const Vec x = positions({first.x, last.x}, {first.dx, last.dx});
        const Vec y = positions({first.y, last.y}, {first.dy, last.dy});
        // Below 0 is very large without a sign.
        const Vec inner = _mm256_and_si256(_mm256_cmpeq_epi32(_mm256_min_epu32(x, last_x), x),
                                           _mm256_cmpeq_epi32(_mm256_min_epu32(y, last_y), y));
        if (_mm256_movemask_epi8(inner) != -1)
            return false;
        const Vec fraction = _mm256_set1_epi32(127);
        const Vec one = _mm256_set1_epi32(128);
        const Vec a = _mm256_and_si256(x, fraction);
        const Vec b = _mm256_and_si256(y, fraction);
        const Vec bytes = _mm256_or_si256(_mm256_sub_epi32(one, a), _mm256_slli_epi32(a, 8)); // 128 - a, a
        const Vec by_column = _mm256_or_si256(bytes, _mm256_slli_epi32(bytes, 16));
        const Vec by_row = _mm256_or_si256(_mm256_sub_epi32(one, b), _mm256_slli_epi32(b, 16));

        const Vec left = _mm256_srli_epi32(x, 7);
        const Vec row = _mm256_mullo_epi32(_mm256_srli_epi32(y, 7), stride);
        alignas(32) std::int32_t offsets[8];
        _mm256_store_si256(reinterpret_cast<__m256i*>(offsets),
                           _mm256_add_epi32(row, _mm256_add_epi32(left, _mm256_add_epi32(left, left))));
        // Through memory: gcc would take the lanes apart by shuffles, which share one port with all others here.
        asm("" : "+m"(offsets));
        const Vec words_01 =
            _mm256_packs_epi32(two_pixels<0>(offsets, by_column, by_row), two_pixels<1>(offsets, by_column, by_row));
        const Vec words_23 =
            _mm256_packs_epi32(two_pixels<2>(offsets, by_column, by_row), two_pixels<3>(offsets, by_column, by_row));
        const Vec three_of_four = _mm256_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1, //
                                                   0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1);
        const Vec packed =
            _mm256_permutevar8x32_epi32(_mm256_shuffle_epi8(_mm256_packus_epi16(words_01, words_23), three_of_four),
                                        _mm256_setr_epi32(0, 1, 2, 4, 5, 6, 3, 7));
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm256_castsi256_si128(packed));
        _mm_storel_epi64(reinterpret_cast<__m128i*>(to + 16), _mm256_extracti128_si256(packed, 1));
        return true;
    }
};

// Eights from pixel i on; returns where it stopped: before one that is not of the kind, or at n. No call stands in the
// loop, so its constants stay in registers.
int remap_inner(std::uint8_t* rgb, int i, int n, const RemapSpan* spans, int cell_log2, const RemapSource& source)
{
    const InnerRemap inner(source, cell_log2);
    while (i + 8 <= n && inner.eight(rgb + 3 * i, spans[i >> cell_log2], spans[(i + 4) >> cell_log2]))
        i += 8;
    return i;
}

// Pixels i .. end - 1, i being a multiple of 4.
void remap_any(std::uint8_t* rgb, int i, int end, const RemapSpan* spans, int cell_log2, const RemapSource& source)
{
    const Remap remap(source);
    const int in_cell = (1 << cell_log2) - 1;
    for (; i + 4 <= end; i += 4) {
        const __m128i quad = remap.quad(spans[i >> cell_log2], i & in_cell);
        _mm_storel_epi64(reinterpret_cast<__m128i*>(rgb + 3 * i), quad);
        _mm_storeu_si32(rgb + 3 * i + 8, _mm_srli_si128(quad, 8));
    }
    if (i < end) {
        alignas(16) std::uint8_t rest[16];
        _mm_store_si128(reinterpret_cast<__m128i*>(rest), remap.quad(spans[i >> cell_log2], i & in_cell));
        for (int k = 0; k < 3 * (end - i); ++k)
            rgb[3 * i + k] = rest[k];
    }
}

void remap_row(std::uint8_t* rgb, int n, const RemapSpan* spans, int cell_log2, const RemapSource& source)
{
    int i = 0;
    while ((i = remap_inner(rgb, i, n, spans, cell_log2, source)) < n) {
        const int end = i + 8 <= n ? i + 8 : n;
        remap_any(rgb, i, end, spans, cell_log2, source);
        i = end;
    }
}

#undef DICOT_LOAD
#undef DICOT_STORE

} // namespace

// In avx2_paths.cpp.
std::uint16_t avx2_path_step(std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                             std::uint16_t least, PathPenalty penalty, int first, int axis);
void avx2_winners(Winner* out, const std::uint16_t* costs, int n, int axis);
void avx2_right_winners(std::uint16_t* cost, std::uint16_t* position, const std::uint16_t* costs, int n, int axis);

extern const Kernels kAvx2Kernels;
const Kernels kAvx2Kernels = {"avx2",         support_weights, match_cost,         aggregate, normalise,
                              avx2_path_step, avx2_winners,    avx2_right_winners, remap_row};

} // namespace dicot
