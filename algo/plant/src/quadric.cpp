#include "quadric.h"

#include <algorithm>
#include <cmath>

namespace dicot {

void QuadricSums::add(double x, double y, double value)
{
    const double terms[kTerms] = {1, x, y, x * x, x * y, y * y};
    double* product = products_;
    for (std::size_t i = 0; i < kTerms; ++i) {
        for (std::size_t j = 0; j <= i; ++j)
            *product++ += terms[i] * terms[j];
        right_[i] += terms[i] * value;
    }
    squares_ += value * value;
}

void QuadricSums::add(const QuadricSums& other)
{
    for (std::size_t i = 0; i < kProducts; ++i)
        products_[i] += other.products_[i];
    for (std::size_t i = 0; i < kTerms; ++i)
        right_[i] += other.right_[i];
    squares_ += other.squares_;
}

QuadricSums::Factors QuadricSums::factors() const
{
    // A little weight on the diagonal keeps a patch on a line solvable.
    const double ridge = 1e-6 * std::max(products_[0], 1.0);
    Factors f;
    const double* product = products_;
    for (std::size_t i = 0; i < kTerms; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double left = *product++ + (i == j ? ridge : 0);
            for (std::size_t k = 0; k < j; ++k)
                left -= f.lower[i][k] * f.lower[j][k];
            f.lower[i][j] = i == j ? std::sqrt(std::max(left, ridge)) : left / f.lower[j][j];
        }
        double left = right_[i];
        for (std::size_t k = 0; k < i; ++k)
            left -= f.lower[i][k] * f.solved[k];
        f.solved[i] = left / f.lower[i][i];
    }
    return f;
}

double QuadricSums::leftover() const
{
    double explained = 0;
    for (const double part : factors().solved)
        explained += part * part;
    return std::max(squares_ - explained, 0.0);
}

Quadric QuadricSums::surface() const
{
    const Factors f = factors();
    Quadric found;
    for (std::size_t i = kTerms; i-- > 0;) {
        double left = f.solved[i];
        for (std::size_t k = i + 1; k < kTerms; ++k)
            left -= f.lower[k][i] * found.factor[k];
        found.factor[i] = left / f.lower[i][i];
    }
    return found;
}

double misfit(const QuadricSums& a, const QuadricSums& b)
{
    QuadricSums both = a;
    both.add(b);
    const double more = both.leftover() - a.leftover() - b.leftover();
    return std::sqrt(std::max(more, 0.0) / std::min(a.count(), b.count()));
}

double own_roughness(const QuadricSums& a, const QuadricSums& b)
{
    return std::sqrt((a.leftover() + b.leftover()) / (a.count() + b.count()));
}

} // namespace dicot
