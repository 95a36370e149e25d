#include "dicot/base/exact_math.h"

namespace dicot {

double exact_exp(double x) noexcept
{
    // Halve until the Taylor series converges at once, then square back: 2^-10 * 700 < 0.7.
    constexpr int kHalvings = 10;
    const double small = x / (1 << kHalvings);
    double term = 1.0;
    double sum = 0.0; // e^small - 1, to keep the digits that adding 1 would drop
    for (int k = 1; k <= 24; ++k) {
        term = term * small / k;
        sum += term;
    }
    for (int i = 0; i < kHalvings; ++i)
        sum = sum * (sum + 2.0); // (1 + s)^2 - 1
    return 1.0 + sum;
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
