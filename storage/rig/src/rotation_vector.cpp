#include "rotation_vector.h"

namespace dicot {
namespace {

/// 1 - x / (n (n + 1)) + x^2 / (n ... (n + 3)) - ...: with x the squared angle, sin(angle) / angle for n = 2.
double alternating_series(double x, int n)
{
    constexpr int kTerms = 16; // at the longest turn, the next one is below 1e-18
    double sum = 1;
    for (int term = kTerms; term >= 1; --term) {
        const double below = n + 2 * (term - 1);
        sum = 1 - sum * x / (below * (below + 1));
    }
    return sum;
}

} // namespace

Matrix<3, 3> matrix_of_rotation(const std::array<double, 3>& vector)
{
    const auto& [x, y, z] = vector;
    const double squared = x * x + y * y + z * z;
    const double a = alternating_series(squared, 2);     // sin(angle) / angle
    const double b = alternating_series(squared, 3) / 2; // (1 - cos(angle)) / angle^2
    return {{{1 - b * (y * y + z * z), b * x * y - a * z, b * x * z + a * y},
             {b * x * y + a * z, 1 - b * (x * x + z * z), b * y * z - a * x},
             {b * x * z - a * y, b * y * z + a * x, 1 - b * (x * x + y * y)}}};
}

} // namespace dicot
