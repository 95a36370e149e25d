#include "lab.h"

#include "dicot/base/exact_math.h"

namespace dicot::matching {
namespace {

// IEC 61966-2-1 (sRGB) to XYZ, each row divided by the D65 white, in Q16: every row sums to 65536 exactly.
constexpr int kToXyz[3][3] = {{28440, 24653, 12443}, {13933, 46871, 4732}, {1164, 7174, 57198}};
static_assert(28440 + 24653 + 12443 == 65536 && 13933 + 46871 + 4732 == 65536);
static_assert(1164 + 7174 + 57198 == 65536);

constexpr int kFOne = 1 << 14;

double linear_light(double c)
{
    if (c <= 0.04045)
        return c / 12.92;
    const double x = (c + 0.055) / 1.055;
    return x * x * exact_root(x * x, 5); // x^2.4
}

double cie_f(double t)
{
    return t > 216.0 / 24389.0 ? exact_root(t, 3) : (24389.0 / 27.0 * t + 16.0) / 116.0;
}

int f_of(std::uint32_t t_q16, const LabTables& tables)
{
    // 65535 stands for 1.0; stretched by one part in 65536 so that white is exactly white.
    const std::uint32_t t = t_q16 + (t_q16 >> 15);
    const std::uint32_t i = t >> 4;
    const int part = static_cast<int>(t & 15);
    const int low = tables.f[i];
    return low + ((tables.f[i + 1] - low) * part + 8) / 16;
}

std::int16_t scaled(int f_difference, int factor)
{
    // factor * difference in Q14 -> units of 1 / kLabScale, rounded half up.
    const int value = f_difference * factor * kLabScale;
    return static_cast<std::int16_t>((value + kFOne / 2) >> 14);
}

} // namespace

void fill(LabTables& tables)
{
    for (int i = 0; i < 256; ++i)
        tables.linear[i] = static_cast<std::uint16_t>(linear_light(i / 255.0) * 65535.0 + 0.5);
    for (int i = 0; i <= LabTables::kSteps + 1; ++i)
        tables.f[i] = static_cast<std::uint16_t>(cie_f(i / double{LabTables::kSteps}) * kFOne + 0.5);
}

LabPixel lab_of(Rgb8 colour, const LabTables& tables)
{
    const std::uint32_t r = tables.linear[colour.r];
    const std::uint32_t g = tables.linear[colour.g];
    const std::uint32_t b = tables.linear[colour.b];
    int f[3];
    for (int k = 0; k < 3; ++k) {
        const std::uint64_t sum = std::uint64_t{static_cast<std::uint32_t>(kToXyz[k][0])} * r +
                                  std::uint64_t{static_cast<std::uint32_t>(kToXyz[k][1])} * g +
                                  std::uint64_t{static_cast<std::uint32_t>(kToXyz[k][2])} * b;
        f[k] = f_of(static_cast<std::uint32_t>((sum + 32768) >> 16), tables);
    }
    const int l = f[1] * 116 - 16 * kFOne;
    return {static_cast<std::int16_t>((l * kLabScale + kFOne / 2) >> 14), scaled(f[0] - f[1], 500),
            scaled(f[1] - f[2], 200)};
}

} // namespace dicot::matching
