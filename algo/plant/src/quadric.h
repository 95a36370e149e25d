// Surfaces of second degree over the picture, by sums that add up.
#pragma once

#include <cstddef>
#include <span>

namespace dicot {

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

private:
    static constexpr std::size_t kTerms = 6, kProducts = kTerms * (kTerms + 1) / 2;

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
