#include "parabola.h"

#include <algorithm>
#include <cmath>

namespace dicot {

Parabola fit_parabola(std::span<const Sample> samples)
{
    double weight = 0, mean = 0, value = 0;
    for (const Sample& s : samples) {
        weight += s.weight;
        mean += s.weight * s.at;
        value += s.weight * s.value;
    }
    if (weight <= 0)
        return {};
    mean /= weight;
    value /= weight;
    // About the mean, with the basis 1, t, t^2 - <t^2> - t <t^3> / <t^2>, which is orthogonal: no system to solve.
    double t2 = 0, t3 = 0, tv = 0;
    for (const Sample& s : samples) {
        const double t = s.at - mean;
        t2 += s.weight * t * t;
        t3 += s.weight * t * t * t;
        tv += s.weight * t * s.value;
    }
    if (t2 <= 1e-12 * weight)
        return {value, 0, 0};
    const double tilt = t3 / t2, level = t2 / weight;
    double square = 0, product = 0;
    for (const Sample& s : samples) {
        const double t = s.at - mean, basis = t * t - tilt * t - level;
        square += s.weight * basis * basis;
        product += s.weight * basis * s.value;
    }
    const double slope = tv / t2;
    const double bend = square > 1e-9 * t2 * level ? product / square : 0;
    // In t: value + slope t + bend (t^2 - tilt t - level), t = at - mean.
    const double linear = slope - bend * tilt;
    return {value - bend * level - linear * mean + bend * mean * mean, linear - 2 * bend * mean, bend};
}

} // namespace dicot
