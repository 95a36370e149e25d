// Elementary functions whose last bit is the same on every CPU and with every C library.
//
// They are made of + - * / only (IEEE 754, no contraction), so tables built with them are byte-identical everywhere.
// libm's own differ in the last place between CPUs with and without fused multiply-add. Relative error below 1e-14.
#pragma once

namespace dicot {

/// e^x for |x| <= 700.
double exact_exp(double x) noexcept;
/// The natural logarithm of a normal x > 0; absolute error below 1e-14 near 1.
double exact_log(double x) noexcept;
/// The n-th root of x >= 0, n in 2..5.
double exact_root(double x, int n) noexcept;

} // namespace dicot
