// Whether confidence knows where the errors are.
#pragma once

#include <cstdint>
#include <vector>

namespace dicot::test {

/// A measured pixel: how wrong it is, in any unit, and how sure it claims to be.
struct Judged
{
    float wrong;
    std::uint8_t confidence;
};

/// Pixels are removed, the least certain first; of those that remain the mean of `wrong` is taken. The area under it,
/// over the removed share from 0 to 1, is small where the wrong ones go first.
struct Sparsification
{
    double area = 0;
    double ideal = 0;          ///< the area when the most wrong are removed first
    double blind = 0;          ///< when any are: the mean of all
    std::vector<double> curve; ///< with 0, 10 .. 90 % removed
    std::vector<double> ideal_curve;

    double ratio() const { return area / ideal; }
};

/// Pixels of equal confidence leave together, each a bit.
Sparsification sparsified(std::vector<Judged> pixels);

} // namespace dicot::test
