#include "dicot/base/exact_math.h"

#include <cmath>

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

double exact_log(double x) noexcept
{
    // x = 2^k m with m around 1; ln m = 2 artanh u, u = (m - 1) / (m + 1), |u| < 0.172.
    constexpr double kLn2 = 0x1.62e42fefa39efp-1;
    constexpr double kRootOfHalf = 0x1.6a09e667f3bcdp-1;
    int k = 0;
    double m = std::frexp(x, &k);
    if (m < kRootOfHalf) {
        m *= 2.0;
        --k;
    }
    const double u = (m - 1.0) / (m + 1.0);
    double sum = 0.0;
    for (int i = 23; i >= 1; i -= 2)
        sum = sum * (u * u) + 1.0 / i;
    return k * kLn2 + 2.0 * u * sum;
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
