// SPDX-License-Identifier: Apache-2.0
#include "core/pnp/epnp.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/base/symmetric_eigen.h"

namespace boresight {
namespace {

constexpr int kMostGuessed = 3;  ///< factors that are guessed at a time
constexpr int kGaussNewtonSteps = 8;
/// Points whose least extent is below this share of the next one lie in a plane.
constexpr double kPlanarShare = 1e-4;
/// The same of the second extent: points on a line.
constexpr double kLinearShare = 1e-5;
constexpr double kSmallestZ = 0.05;  ///< of a unit bearing

/// Centroid and principal axes of the points.
struct Spread {
  Eigen::Vector3d centroid_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes;      ///< columns, the longest first
  Eigen::Vector3d extent_m;  ///< standard deviations
  bool isPlanar() const { return extent_m[2] < kPlanarShare * extent_m[1]; }
};

bool measureSpread(std::span<const Eigen::Vector3d> points, Spread& spread) {
  const double count = static_cast<double>(points.size());
  for (const Eigen::Vector3d& point : points) spread.centroid_m += point / count;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d d = point - spread.centroid_m;
    scatter += d * d.transpose() / count;
  }
  if (!scatter.allFinite()) return false;
  const SymmetricEigen<3> eigen(scatter);
  for (int i = 0; i < 3; ++i) {
    spread.axes.col(i) = eigen.vectors.col(2 - i);
    spread.extent_m[i] = std::sqrt(std::max(eigen.values[2 - i], 0.0));
  }
  return spread.extent_m[1] > kLinearShare * spread.extent_m[0];
}

/// Solves symmetric positive definite equations; false when they are singular.
template <int kSize>
bool solveNormal(Eigen::Matrix<double, kSize, kSize> a, Eigen::Matrix<double, kSize, 1> b, int size,
                 Eigen::Matrix<double, kSize, 1>& x) {
  double largest = 0.0;
  for (int i = 0; i < size; ++i) largest = std::max(largest, a(i, i));
  for (int i = 0; i < size; ++i) {
    if (!(a(i, i) > 1e-14 * largest)) return false;
    for (int j = i + 1; j < size; ++j) {
      const double factor = a(j, i) / a(i, i);
      for (int k = i; k < size; ++k) a(j, k) -= factor * a(i, k);
      b[j] -= factor * b[i];
    }
  }
  for (int i = size - 1; i >= 0; --i) {
    for (int k = i + 1; k < size; ++k) b[i] -= a(i, k) * x[k];
    x[i] = b[i] / a(i, i);
  }
  return true;
}

/// The problem with kControls control points: 4, or 3 of a plane. The numbers of null vectors and
/// factors equal the number of control points.
template <int kControls>
class Epnp {
 public:
  Epnp(std::span<const Eigen::Vector3d> bearing, std::span<const Eigen::Vector3d> points,
       const Spread& spread)
      : bearing_(bearing), points_(points), spread_(spread) {
    findNullSpace();
    for (int pair = 0; pair < kPairs; ++pair) {
      // Control points lie at the centroid and one extent along each axis.
      const auto [a, b] = pairOf(pair);
      const double first = a == 0 ? 0.0 : spread.extent_m[a - 1];
      const double second = spread.extent_m[b - 1];
      squared_m2_[pair] = first * first + second * second;
    }
  }

  /// The best of the solutions that start with one to three factors.
  bool solve(Pose& camera_from_station) const {
    double least = 1e300;
    for (int factors = 1; factors <= std::min(kMostGuessed, kControls - 1); ++factors) {
      Factors beta = Factors::Zero();
      if (!guess(factors, beta)) continue;
      refine(beta);
      Pose pose;
      double squares = 0.0;
      if (!poseOf(beta, pose) || !measure(pose, squares) || !(squares < least)) continue;
      least = squares;
      camera_from_station = pose;
    }
    return least < 1e300;
  }

 private:
  static constexpr int kPairs = kControls * (kControls - 1) / 2;
  static constexpr int kUnknowns = 3 * kControls;
  static constexpr int kProducts = kMostGuessed * (kMostGuessed + 1) / 2;
  using Factors = Eigen::Matrix<double, kControls, 1>;
  using Shares = Eigen::Matrix<double, kControls, 1>;
  using Squares = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  struct Pair {
    int first = 0, second = 0;
  };

  static Pair pairOf(int pair) {
    int a = 0;
    int left = pair;
    for (; left >= kControls - 1 - a; ++a) left -= kControls - 1 - a;
    return {a, a + 1 + left};
  }

  /// Barycentric coordinates with respect to the control points.
  Shares sharesOf(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d along = spread_.axes.transpose() * (point - spread_.centroid_m);
    Shares shares;
    shares[0] = 1.0;
    for (int j = 1; j < kControls; ++j) {
      shares[j] = along[j - 1] / spread_.extent_m[j - 1];
      shares[0] -= shares[j];
    }
    return shares;
  }

  /// Adds the square of the row: component `axis` of the point less `slope` times its depth, 0
  /// where the point is seen. Element by element: Eigen allocates in products of this size.
  static void addRow(const Shares& shares, int axis, double slope, Squares& sum) {
    Eigen::Matrix<double, kUnknowns, 1> row;
    row.setZero();
    for (int j = 0; j < kControls; ++j) {
      row[3 * j + axis] = shares[j];
      row[3 * j + 2] = -slope * shares[j];
    }
    for (int i = 0; i < kUnknowns; ++i)
      for (int k = 0; k < kUnknowns; ++k) sum(i, k) += row[i] * row[k];
  }

  /// x z_i - z x_i = 0 and y z_i - z y_i = 0 of every point, summed as M'M.
  void findNullSpace() {
    Squares sum;
    sum.setZero();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Shares shares = sharesOf(points_[i]);
      const double u = bearing_[i].x() / bearing_[i].z();
      const double v = bearing_[i].y() / bearing_[i].z();
      addRow(shares, 0, u, sum);
      addRow(shares, 1, v, sum);
    }
    const SymmetricEigen<kUnknowns> eigen(sum);
    null_space_ = eigen.vectors.template leftCols<kControls>();
  }

  /// Difference between two control points in null vector k.
  Eigen::Vector3d difference(int k, const Pair& pair) const {
    return null_space_.template block<3, 1>(3 * pair.first, k) -
           null_space_.template block<3, 1>(3 * pair.second, k);
  }

  /// Products of factors, as independent unknowns of linear equations (the paper's
  /// linearization), give the first guess.
  bool guess(int factors, Factors& beta) const {
    const int products = factors * (factors + 1) / 2;
    Eigen::Matrix<double, kProducts, kProducts> a;
    Eigen::Matrix<double, kProducts, 1> b;
    Eigen::Matrix<double, kProducts, 1> x;
    a.setZero();
    b.setZero();
    x.setZero();
    for (int pair = 0; pair < kPairs; ++pair) {
      Eigen::Matrix<double, kProducts, 1> row;
      row.setZero();
      int at = 0;
      for (int k = 0; k < factors; ++k)
        for (int l = k; l < factors; ++l)
          row[at++] =
              (k == l ? 1.0 : 2.0) * difference(k, pairOf(pair)).dot(difference(l, pairOf(pair)));
      a += row * row.transpose();
      b += row * squared_m2_[pair];
    }
    if (!solveNormal(a, b, products, x)) return false;
    // x[0] = beta_0^2; x[l] = beta_0 beta_l. Where beta_0 vanishes the others are small too.
    const double first = std::sqrt(std::abs(x[0]));
    if (!(first > 0.0)) return false;
    beta[0] = first;
    for (int l = 1; l < factors; ++l) beta[l] = (x[0] < 0.0 ? -x[l] : x[l]) / first;
    return true;
  }

  /// Gauss-Newton on the distances between control points, over all factors.
  void refine(Factors& beta) const {
    for (int step = 0; step < kGaussNewtonSteps; ++step) {
      Eigen::Matrix<double, kControls, kControls> a;
      Factors b = Factors::Zero();
      Factors change = Factors::Zero();
      a.setZero();
      for (int pair = 0; pair < kPairs; ++pair) {
        Eigen::Vector3d d = Eigen::Vector3d::Zero();
        for (int k = 0; k < kControls; ++k) d += beta[k] * difference(k, pairOf(pair));
        Factors row = Factors::Zero();
        for (int k = 0; k < kControls; ++k) row[k] = 2.0 * d.dot(difference(k, pairOf(pair)));
        a += row * row.transpose();
        b += row * (squared_m2_[pair] - d.squaredNorm());
      }
      if (!solveNormal(a, b, kControls, change)) return;
      beta += change;
    }
  }

  /// Absolute orientation of the points placed by the factors (Horn, "Closed-form solution of
  /// absolute orientation using unit quaternions", JOSA A 1987).
  bool poseOf(const Factors& beta, Pose& camera_from_station) const {
    const Eigen::Matrix<double, kUnknowns, 1> controls = null_space_ * beta;
    if (!controls.allFinite()) return false;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    const double count = static_cast<double>(points_.size());
    for (const Eigen::Vector3d& point : points_) middle += placeOf(controls, point) / count;
    const double sign = middle.z() < 0.0 ? -1.0 : 1.0;
    Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
    for (const Eigen::Vector3d& point : points_)
      cross +=
          (point - spread_.centroid_m) * (sign * (placeOf(controls, point) - middle)).transpose();
    Eigen::Matrix4d horn;
    const Eigen::Vector3d skew(cross(1, 2) - cross(2, 1), cross(2, 0) - cross(0, 2),
                               cross(0, 1) - cross(1, 0));
    horn(0, 0) = cross.trace();
    horn.block<3, 1>(1, 0) = skew;
    horn.block<1, 3>(0, 1) = skew.transpose();
    horn.block<3, 3>(1, 1) =
        cross + cross.transpose() - cross.trace() * Eigen::Matrix3d::Identity();
    const SymmetricEigen<4> eigen(horn);
    const Eigen::Vector4d q = eigen.vectors.col(3);
    camera_from_station.rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
    camera_from_station.translation_m =
        sign * middle - camera_from_station.matrix() * spread_.centroid_m;
    return camera_from_station.isFinite();
  }

  Eigen::Vector3d placeOf(const Eigen::Matrix<double, kUnknowns, 1>& controls,
                          const Eigen::Vector3d& point) const {
    const Shares shares = sharesOf(point);
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (int j = 0; j < kControls; ++j) place += shares[j] * controls.template segment<3>(3 * j);
    return place;
  }

  /// Sum of squared residuals in the plane z = 1; false when a point is behind the camera.
  bool measure(const Pose& camera_from_station, double& squares) const {
    const PoseMatrix to_camera(camera_from_station);
    squares = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector3d p = to_camera * points_[i];
      if (!(p.z() > 0.0)) return false;
      const Eigen::Vector3d& b = bearing_[i];
      const double dx = p.x() / p.z() - b.x() / b.z();
      const double dy = p.y() / p.z() - b.y() / b.z();
      squares += dx * dx + dy * dy;
    }
    return isFinite(squares);
  }

  std::span<const Eigen::Vector3d> bearing_;
  std::span<const Eigen::Vector3d> points_;
  const Spread& spread_;
  Eigen::Matrix<double, kUnknowns, kControls> null_space_;
  Eigen::Matrix<double, kPairs, 1> squared_m2_;  ///< between control points, by pair
};

}  // namespace

bool solveEpnp(std::span<const Eigen::Vector3d> bearing,
               std::span<const Eigen::Vector3d> point_in_station_m, Pose& camera_from_station) {
  constexpr std::size_t kFewest = 4;
  if (bearing.size() < kFewest || bearing.size() != point_in_station_m.size()) return false;
  for (const Eigen::Vector3d& direction : bearing)
    if (!(direction.z() > kSmallestZ * direction.norm())) return false;
  Spread spread;
  if (!measureSpread(point_in_station_m, spread)) return false;
  if (spread.isPlanar())
    return Epnp<3>(bearing, point_in_station_m, spread).solve(camera_from_station);
  return Epnp<4>(bearing, point_in_station_m, spread).solve(camera_from_station);
}

}  // namespace boresight
