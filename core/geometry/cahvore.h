// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "core/geometry/camera.h"

namespace boresight {

/// Lenses of the CAHV family: a point has the distorted direction q = d'_xy / d'_z, and q the pixel
/// (fx q_x + cx, skew q_x + fy q_y + cy). Gennery, "Generalized Camera Calibration Including
/// Fish-Eye Lenses", IJCV 2006. A point d is split by the optical axis
/// O into d = w O + lam.
///   CAHV:    d' = d
///   CAHVOR:  d' = d + mu lam,               mu = r0 + r1 tau + r2 tau^2, tau = |lam|^2 / w^2
///   CAHVORE: d' = |lam| / chi O + (1 + mu) lam, mu = r0 + r1 chi^2 + r2 chi^4, where
///            chi = tan(L theta) / L for L > 0, theta for L = 0, sin(L theta) / L for L < 0, and
///            w sin theta - |lam| cos theta = (theta - sin theta) (e0 + e1 theta^2 + e2 theta^4).
/// A camera must have been prepared; `false` means outside its valid field (or not finite), and
/// then the outputs are unspecified.

/// Returns the end of the valid field (see Camera::valid_radius), 0 when there is none; sets the
/// range of the pupil.
double prepareCahvLens(Camera& camera);

bool projectCahv(const Camera& camera, const Eigen::Vector3d& point, Eigen::Vector2d& pixel);
/// Also d pixel / d point.
bool projectCahv(const Camera& camera, const Eigen::Vector3d& point, Eigen::Vector2d& pixel,
                 Eigen::Matrix<double, 2, 3>& jacobian);
/// Pixel of a point infinitely far off, of CAHVORE.
bool projectCahvoreDirection(const Camera& camera, const Eigen::Vector3d& direction,
                             Eigen::Vector2d& pixel);
bool unprojectCahv(const Camera& camera, const Eigen::Vector2d& pixel, Ray& ray);

/// Position of the pupil along O, m, for the ray through a point, within the image's range.
double pupilOf(const Camera& camera, const Eigen::Vector3d& point);

}  // namespace boresight
