// Surfaces of second degree over the picture, by sums that add up.
#pragma once

#include <cstddef>
#include <span>

namespace dicot {

/// constant + x + y + x x + x y + y y, each with its factor.
struct Quadric
{
    double factor[6] = {};

    double operator()(double x, double y) const
    {
        return factor[0] + x * (factor[1] + x * factor[3] + y * factor[4]) + y * (factor[2] + y * factor[5]);
    }
};

/// Sums of a patch's points, from which the least squares of 1, x, y, x x, x y, y y follow; those of two patches
/// together are their sum.
class QuadricSums
{
public:
    void add(double x, double y, double value);
    void add(const QuadricSums& other);

    double count() const { return products_[0]; }
    /// What the best surface of second degree leaves: the sum of squares.
    double leftover() const;
    /// That surface.
    Quadric surface() const;

private:
    static constexpr std::size_t kTerms = 6, kProducts = kTerms * (kTerms + 1) / 2;

    /// Cholesky: lower lower^T = products, lower solved = right.
    struct Factors
    {
        double lower[kTerms][kTerms] = {};
        double solved[kTerms] = {};
    };
    Factors factors() const;

    double products_[kProducts] = {}; ///< of the terms, row by row of the lower triangle
    double right_[kTerms] = {};
    double squares_ = 0;
};

/// How far the smaller of two patches lies off one surface for both, beyond what each lies off its own: root mean
/// square.
double misfit(const QuadricSums& a, const QuadricSums& b);

/// How far both lie off their own surfaces: root mean square.
double own_roughness(const QuadricSums& a, const QuadricSums& b);

} // namespace dicot
