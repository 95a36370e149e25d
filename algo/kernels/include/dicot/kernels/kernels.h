// The contract of every kernel. scalar/ is the law; avx2/ and neon/ give the same bytes.
//
// Notation: p is the pixel being matched, q a pixel of its window, p_d and q_d their partners in the right picture.
// A window row has a *slot*: row y of the picture lives in slot y mod (2 * groups), so tables need not move when the
// window moves down. Two neighbouring slots form a *group*; the values of a group lie side by side in one 32-bit word
// (even slot in the low half). Sums over the window do not depend on the order of its rows.
//
// Right positions run upwards: index r of a disparity axis means d = disparities - 1 - r, so that r and the column of
// the right picture grow together.
//
// Vector files include this header and the intrinsics header and nothing else: code from a template or an inline
// function compiled with -mavx2 could be the copy that the linker keeps for the whole program.
#pragma once

#include <cstdint>

namespace dicot {

/// One pixel's CIELAB colour, as the two 32-bit words that the kernels load: in units of 1/16 (L in 0 .. 100).
/// A pixel outside the picture has L = kLabOutside, so far from every colour that its support weight is 0.
inline constexpr int kLabScale = 16;
inline constexpr std::int16_t kLabOutside = 30000;

/// Two int16 in one word, low half first.
struct PairS16
{
    std::int16_t low, high;
};
/// Two uint16 in one word, low half first.
struct PairU16
{
    std::uint16_t low, high;
};
static_assert(sizeof(PairS16) == 4 && sizeof(PairU16) == 4);

/// One row of a picture in CIELAB: la[i] = (L, a), b[i] = (b, 0).
struct LabRow
{
    const PairS16* la;
    const PairS16* b;
};

/// Squared colour distance -> position in the table of colour weights: 64 steps an octave, 0 for distance 0.
/// It is the exponent and the upper 6 bits of the fraction of the distance as an IEEE 754 single.
inline constexpr int kColourSteps = 64;
inline constexpr int kColourTableSize = 32 * kColourSteps + 2;
/// One more entry, so that a 32-bit load of the last 16-bit entry stays inside the table.
inline constexpr int kColourTableAllocation = kColourTableSize + 1;

/// The largest weight of the left table (Q15), of the right table and of their product (Q14).
inline constexpr int kLeftWeightOne = 32767;
inline constexpr int kRightWeightOne = 16383;
/// The largest matching cost.
inline constexpr int kCostMax = 200;
/// The widest window: its sums must stay below 2^32 (and its weights alone below 2^31).
inline constexpr int kMaxWindow = 35;
static_assert(std::uint64_t{kMaxWindow + 1} * kMaxWindow * kRightWeightOne * kCostMax < (std::uint64_t{1} << 32));

/// Positions computed together: disparity axes are padded to a multiple of this.
inline constexpr int kLanes = 8;

/// Cost of a pixel pair for eq. 10 to 12 (or eq. 9, with a zero census table).
struct CostTables
{
    /// By the sum of the three absolute channel differences, 0 .. 765; 3 bytes more, for 32-bit loads.
    std::uint8_t difference[766 + 3];
    /// By the Hamming distance of two 3 x 3 censuses, 0 .. 8. difference + census <= kCostMax for all arguments.
    std::uint8_t census[16];
};

/// A row of a picture as the cost kernel reads it: channel planes and the 3 x 3 census.
struct CostRow
{
    const std::uint8_t* red;
    const std::uint8_t* green;
    const std::uint8_t* blue;
    const std::uint8_t* census;
};

/// Marks a disparity whose partner lies outside the right picture, among aggregated costs.
inline constexpr std::uint16_t kNoCandidate = 0xFFFF;
/// The largest aggregated cost.
inline constexpr int kWorstCost = 256 * kCostMax;
/// A path may cost one large step more than a cost, and stays below kNoCandidate.
inline constexpr int kMaxPathStep = kNoCandidate - 1 - kWorstCost;

/// What a path pays when the disparity changes between neighbours.
struct PathPenalty
{
    std::uint16_t small; ///< by one, at most `large`
    std::uint16_t large; ///< by more, at most kMaxPathStep
};

/// The best of one pixel's costs.
struct Winner
{
    std::uint16_t position;  ///< the largest that has the least cost
    std::uint16_t cost;      ///< kNoCandidate: no candidate at all
    std::uint16_t runner_up; ///< the least cost that is neither at `position` nor beside it; kNoCandidate without one
};

/// One group of two window rows, for a strip of pixels.
struct AggregateStrip
{
    const PairU16* left_weights;  ///< [columns][left_stride]: weight of window column c for pixel i, Q15
    const PairU16* right_weights; ///< [columns][right_stride]: the same for position i + r, Q14
    const PairU16* costs;     ///< [pixels + columns - 1][disparities]: cost at window column c of pixel i is row i + c
    std::uint32_t* numerator; ///< [pixels][disparities], added to
    std::uint32_t* denominator; ///< [pixels][disparities], added to
    int left_stride;            ///< words
    int right_stride;           ///< words, at least pixels + disparities - 1
    int columns;                ///< 1 .. kMaxWindow
    int pixels;                 ///< any number, 0 too
    int disparities;            ///< a multiple of kLanes
};

/// Where one cell of a row of a rectified picture comes from: pixel u of the cell from (x + u dx, y + u dy), in px of
/// the source picture with kRemapFraction fraction bits.
struct RemapSpan
{
    std::int32_t x, y, dx, dy;
};
inline constexpr int kRemapFraction = 16;
/// The fraction bits that interpolation uses.
inline constexpr int kRemapWeightBits = 7;

/// A colour picture: 3 bytes a pixel, at least 3 x 2 px, (height - 1) * stride_bytes + 3 * width < 2^31.
struct RemapSource
{
    const std::uint8_t* rgb;
    std::int32_t stride_bytes;
    std::int32_t width, height;
};

/// The table of function pointers. Pointers may be unaligned to more than their type unless said otherwise; input and
/// output of one call never overlap; nothing outside the stated ranges is read or written.
struct Kernels
{
    const char* name;

    /// Support weights (eq. 6 to 8) of one window column for `n` pixels and the two rows of a group:
    ///   out[i].low  = round_q15(colour[index(|p[i] - q_low[i]|^2)] * spatial.low)
    ///   out[i].high = the same with q_high and spatial.high
    /// where |.|^2 sums the three squared channel differences (int16 differences must not overflow: L in 0 .. 30000,
    /// a and b within +-3000), index() is the single-precision prefix described at kColourSteps, and
    /// round_q15(x) = (x + 2^14) >> 15. `colour` has kColourTableAllocation entries, each <= kLeftWeightOne, as are
    /// the two of `spatial`.
    void (*support_weights)(PairU16* out, int n, LabRow p, LabRow q_low, LabRow q_high, const std::uint16_t* colour,
                            PairU16 spatial);

    /// Matching costs of `n` left pixels against `disparities` right positions each:
    ///   out[(i * disparities + r) * 2] = difference[|dR| + |dG| + |dB|] + census[popcount(left ^ right)]
    /// with left pixel i and right pixel i + r. Every second uint16 is left alone (the other row of the group).
    /// `disparities` is a multiple of kLanes.
    void (*match_cost)(std::uint16_t* out, int n, int disparities, CostRow left, CostRow right,
                       const CostTables& tables);

    /// Eq. 13 without the division, for one group of window rows: for pixel i, position r and every window column c
    ///   w = round_q15(left_weights[c][i] * right_weights[c][i + r])       (both halves; w <= kRightWeightOne)
    ///   numerator[i][r]   += w.low * cost.low + w.high * cost.high        (cost = costs[i + c][r])
    ///   denominator[i][r] += w.low + w.high
    /// Domain: left weights <= kLeftWeightOne, right ones <= kRightWeightOne, costs <= kCostMax.
    void (*aggregate)(const AggregateStrip& strip);

    /// Eq. 13's division: out[i] = floor(numerator[i] * 256 / denominator[i]). Domain: 0 < denominator[i] < 2^31,
    /// numerator[i] <= kCostMax * denominator[i], so out[i] <= 256 * kCostMax.
    void (*normalise)(std::uint16_t* out, const std::uint32_t* numerator, const std::uint32_t* denominator, int n);

    /// One step of a path over aggregated costs (Hirschmueller 2008, eq. 13), from a pixel to its neighbour. For
    /// position r of `first` .. axis - 1
    ///   own      = min(costs[r], the largest of costs[first ..] that is not kNoCandidate, or 0 where all are)
    ///   ahead[r] = own + min(behind[r], behind[r - 1] + small, behind[r + 1] + small, least + large) - least
    /// where nothing lies before `first` and after axis - 1, and ahead[r] = kNoCandidate for r below `first`. Returns
    /// the least of `ahead`. Domain: costs at most kWorstCost, or kNoCandidate; behind[r] = kNoCandidate for r below
    /// `first`, which is 0 .. kLanes - 1; `least`, at most kWorstCost, is the least of `behind`; `axis` is a multiple
    /// of kLanes.
    std::uint16_t (*path_step)(std::uint16_t* ahead, const std::uint16_t* costs, const std::uint16_t* behind,
                               std::uint16_t least, PathPenalty penalty, int first, int axis);

    /// Eq. 14 for `n` pixels of `axis` costs each, a multiple of kLanes.
    void (*winners)(Winner* out, const std::uint16_t* costs, int n, int axis);

    /// Eq. 14 seen from the right picture: for entry j of n + axis - 1
    ///   cost[j]     = the least of costs[i * axis + r] with i + r = j, i of 0 .. n - 1, r of 0 .. axis - 1
    ///   position[j] = the largest such r, or 0 where cost[j] = kNoCandidate
    /// `axis` is a multiple of kLanes; n may be 0, and then nothing is written.
    void (*right_winners)(std::uint16_t* cost, std::uint16_t* position, const std::uint16_t* costs, int n, int axis);

    /// One row of a rectified colour picture: `n` pixels, 3 bytes each, in cells of 2^cell_log2 px (cell_log2 is 2 or
    /// 3). With (x, y) as RemapSpan says (|x|, |y| < 2^31 - 2^8 for every pixel of a cell that is begun),
    ///   X = (x + 2^8) >> 9, Y alike: px with kRemapWeightBits fraction bits
    /// and a = X mod 128, b = Y mod 128, each channel is
    ///   ((128 - b) ((128 - a) p[0][0] + a p[0][1]) + b ((128 - a) p[1][0] + a p[1][1]) + 2^13) >> 14
    /// of the four source pixels around; it is 0 where X or Y is below 0 or above 128 (side - 1).
    void (*remap_row)(std::uint8_t* rgb, int n, const RemapSpan* spans, int cell_log2, const RemapSource& source);
};
static_assert(kMaxPathStep > 0, "0xFFFF is free to mean: no candidate");

/// The instruction sets that there are kernels for.
enum class CpuLevel
{
    kScalar,
    kAvx2,
    kNeon
};

extern const Kernels kScalarKernels;

/// The kernels of a level, or nullptr when this program was built without them. The caller asks the CPU first.
const Kernels* kernels_for(CpuLevel level);

} // namespace dicot
