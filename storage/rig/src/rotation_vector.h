// A rotation as an axis times an angle, which Bouguet's toolbox calls om.
#pragma once

#include "dicot/rig/rig_file.h"

namespace dicot {

/// Longer vectors turn by more than half a circle: then another, shorter one was meant.
inline constexpr double kLongestTurn = 3.15;

/// Rodrigues' formula for a vector in radians, kLongestTurn at most. Only + - * /: the same bits on every CPU.
Matrix<3, 3> matrix_of_rotation(const std::array<double, 3>& vector);

} // namespace dicot
