// Projection with its derivatives.
#pragma once

#include "dicot/base/stereo_rig.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace dicot::calibration {

/// fx fy cx cy k1 k2 p1 p2 k3
using LensVector = Eigen::Matrix<double, 9, 1>;

struct Projection
{
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> by_point;
    Eigen::Matrix<double, 2, 9> by_lens;
};

/// `point` lies in the camera's frame; its z must not be 0.
Projection project_with_derivatives(const LensVector& lens, const Eigen::Vector3d& point);

/// A rigid motion x -> turn x + shift.
struct Pose
{
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();

    Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return turn * x + shift; }
    /// Turned by `step`'s first three numbers (small rotation vector, after `turn`), shifted by the last three.
    Pose moved(const Eigen::Matrix<double, 6, 1>& step) const;
};

Eigen::Matrix3d skew(const Eigen::Vector3d& v);
LensVector lens_vector(const Lens& lens);
Lens lens_of(const LensVector& v);
Turn turn_of(const Eigen::Quaterniond& q);
Eigen::Quaterniond quaternion_of(const Turn& turn);

} // namespace dicot::calibration
