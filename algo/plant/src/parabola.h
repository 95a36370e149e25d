// A parabola through samples of unequal weight.
#pragma once

#include <span>

namespace dicot {

struct Sample
{
    double at = 0, value = 0, weight = 0;
};

/// value = constant + slope t + bend t^2
struct Parabola
{
    double constant = 0, slope = 0, bend = 0;

    double operator()(double t) const { return constant + t * (slope + t * bend); }
};

/// By least squares; a line, or a constant, where the samples tell no more.
Parabola fit_parabola(std::span<const Sample> samples);

} // namespace dicot
