#include "dicot/base/exact_math.h"

namespace dicot {

double exact_exp(double x) noexcept
{
    // x = k ln 2 + r with |r| < 0.35; ln 2 in two parts, of which k times the first is exact.
    constexpr double kLn2High = 0x1.62e42feep-1;
    constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
    const int k = static_cast<int>(x / (kLn2High + kLn2Low) + (x < 0 ? -0.5 : 0.5));
    const double r = (x - k * kLn2High) - k * kLn2Low;
    double sum = 0.0;
    for (int i = 18; i >= 1; --i)
        sum = (sum + 1.0) * r / i;
    double value = 1.0 + sum;
    for (int i = 0; i < k; ++i)
        value *= 2.0;
    for (int i = 0; i > k; --i)
        value *= 0.5;
    return value;
}

double exact_root(double x, int n) noexcept
{
    if (!(x > 0.0))
        return 0.0;
    // Newton from above falls monotonically: y' = ((n - 1) y + x / y^(n - 1)) / n.
    double y = x > 1.0 ? x : 1.0;
    for (int i = 0; i < 4000; ++i) {
        double power = 1.0;
        for (int k = 1; k < n; ++k)
            power *= y;
        const double next = ((n - 1) * y + x / power) / n;
        if (!(next < y))
            break;
        y = next;
    }
    return y;
}

} // namespace dicot
