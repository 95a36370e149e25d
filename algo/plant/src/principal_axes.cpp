#include "principal_axes.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace dicot {

PrincipalAxes principal_axes(const Moments& moments)
{
    double c[6];
    moments.covariance(c);
    double a[3][3] = {{c[0], c[1], c[2]}, {c[1], c[3], c[4]}, {c[2], c[4], c[5]}};
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; // columns: axes
    constexpr int kSweeps = 12;                         // converges in 6 from anything
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) {
                if (std::fabs(a[p][q]) <= 1e-15 * (std::fabs(a[p][p]) + std::fabs(a[q][q])))
                    continue;
                const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                const double t = (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
                const double cosine = 1 / std::sqrt(t * t + 1), sine = t * cosine;
                for (auto& row : a) {
                    const double kp = row[p], kq = row[q];
                    row[p] = cosine * kp - sine * kq;
                    row[q] = sine * kp + cosine * kq;
                }
                for (int k = 0; k < 3; ++k) {
                    const double pk = a[p][k], qk = a[q][k];
                    a[p][k] = cosine * pk - sine * qk;
                    a[q][k] = sine * pk + cosine * qk;
                }
                for (auto& row : v) {
                    const double kp = row[p], kq = row[q];
                    row[p] = cosine * kp - sine * kq;
                    row[q] = sine * kp + cosine * kq;
                }
            }
    std::array<int, 3> order{0, 1, 2};
    // Not std::stable_sort(), which takes memory from the heap.
    std::sort(order.begin(), order.end(),
              [&](int i, int j) { return a[i][i] > a[j][j] || (a[i][i] == a[j][j] && i < j); });
    PrincipalAxes axes{};
    for (std::size_t i = 0; i < 3; ++i) {
        const int k = order[i];
        axes.axis[i] = {v[0][k], v[1][k], v[2][k]};
        axes.variance[i] = std::max(0.0, a[k][k]);
    }
    axes.axis[2] = cross(axes.axis[0], axes.axis[1]);
    return axes;
}

} // namespace dicot
