// SPDX-License-Identifier: Apache-2.0
#include "core/localizer/edge_refinement.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"

namespace boresight {
namespace {

constexpr double kStep_px = 0.5;  ///< between samples of a profile
constexpr int kMaxTaps = 32;      ///< of the derivative kernel, one side
constexpr int kMaxProfile = 512;  ///< samples of one profile
constexpr double kTukey = 4.685;  ///< 95 % efficiency on Gaussian residuals (Huber 1981)
constexpr double kMadToSigma = 1.4826;
constexpr double kMinScale_px = 0.15;
constexpr double kSettled_rad = 2e-6;  ///< a step below these moves nothing that is measured
constexpr double kSettled_m = 1e-6;

/// One side of an antisymmetric derivative-of-Gaussian kernel at kStep_px, scaled so that a unit
/// ramp (1 gray per px) gives 1.
struct DerivativeKernel {
  std::array<double, kMaxTaps> weight{};
  int taps = 0;
};

DerivativeKernel derivativeKernel(double sigma_px) {
  DerivativeKernel kernel;
  kernel.taps = std::min(kMaxTaps, static_cast<int>(3.0 * sigma_px / kStep_px + 0.5));
  kernel.taps = std::max(kernel.taps, 1);
  double ramp = 0.0;
  for (int k = 1; k <= kernel.taps; ++k) {
    const double s_px = k * kStep_px;
    const double weight = s_px * exponential(-0.5 * s_px * s_px / (sigma_px * sigma_px));
    kernel.weight[static_cast<std::size_t>(k - 1)] = weight;
    ramp += 2.0 * s_px * weight;
  }
  for (double& weight : kernel.weight) weight /= ramp;
  return kernel;
}

/// Bilinear gray value; false outside the image or where it is ignored.
bool grayAt(const ImageView& image, double x, double y, double& gray) {
  if (!(x >= 0.0 && y >= 0.0 && x < image.width - 1 && y < image.height - 1)) return false;
  const int ix = static_cast<int>(x);
  const int iy = static_cast<int>(y);
  const double fx = x - ix;
  const double fy = y - iy;
  const std::uint8_t* upper = image.row(iy) + ix;
  const std::uint8_t* lower = image.row(iy + 1) + ix;
  const double top = upper[0] + fx * (upper[1] - upper[0]);
  const double bottom = lower[0] + fx * (lower[1] - lower[0]);
  gray = top + fy * (bottom - top);
  return true;
}

}  // namespace

Status EdgeRefinement::create(const RefinementOptions& options, Arena& arena) {
  options_ = options;
  if (firstInvalidOption(options) != nullptr) return Status::kInvalidOption;
  const DerivativeKernel kernel = derivativeKernel(options.derivative_sigma_px);
  kernel_ = kernel.weight;
  taps_ = kernel.taps;
  absolute_residuals_ = arena.allocate<float>(static_cast<std::size_t>(options.max_samples));
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

Status EdgeRefinement::begin(const ImageView& image, const BitImage* ignore, const Camera& camera,
                             const MeshView& mesh, const EdgeRender& render, double radius_px,
                             const PosePrior* anchor, const PoseEstimate* matched,
                             RefinementResult& result) {
  image_ = image;
  ignore_ = ignore;
  camera_ = camera;
  radius_px_ = radius_px;
  result_ = &result;
  round_ = 0;
  anchored_ = anchor != nullptr;
  if (anchored_) anchor_ = *anchor;
  has_matched_ = matched != nullptr;
  if (has_matched_) matched_ = *matched;
  result.camera_from_station = render.camera_from_station;
  result.covariance = Matrix6d::Zero();
  result.found_count = 0;
  result.used_count = 0;
  result.rms_px = 0.0;
  takeSamples(mesh, render);
  return result.sample_count < options_.min_found ? Status::kTooFewEdges : Status::kOk;
}

void EdgeRefinement::takeSamples(const MeshView& mesh, const EdgeRender& render) {
  // The render's pixels are 2^level pixels of the image long.
  const double scale = static_cast<double>(camera_.width) / std::max(1, render.camera.width);
  const int by_spacing = static_cast<int>(options_.sample_spacing_px / scale + 0.5);
  const int by_capacity = (render.pixel_count + options_.max_samples - 1) / options_.max_samples;
  const int by_need =
      render.pixel_count / options_.min_samples;  // a small object needs every place
  const int stride = std::max({1, std::min(by_spacing, by_need), by_capacity});
  RefinementResult& result = *result_;
  result.sample_count = 0;
  for (std::int32_t i = 0; i < render.pixel_count; i += stride) {
    const EdgePixel& pixel = render.pixels[static_cast<std::size_t>(i)];
    Eigen::Vector2d position_px;
    EdgeSample sample;
    if (!edgeLinePoint(render, mesh, pixel, position_px, sample.point_in_station_m)) continue;
    sample.normal = Eigen::Vector2d(pixel.normal_x, pixel.normal_y) / 127.0;
    sample.kind = pixel.kind;
    result.samples[static_cast<std::size_t>(result.sample_count)] = sample;
    ++result.sample_count;
  }
}

void EdgeRefinement::search(EdgeSample& sample, const Eigen::Vector2d& predicted_px) const {
  sample.gradient = 0.0;
  const int reach =
      std::min((kMaxProfile - 1) / 2, static_cast<int>(radius_px_ / kStep_px) + 1 + taps_);
  std::array<double, kMaxProfile> profile;
  const Eigen::Vector2d tangent(-sample.normal.y(), sample.normal.x());
  for (int i = -reach; i <= reach; ++i) {
    const Eigen::Vector2d at = predicted_px + (i * kStep_px) * sample.normal;
    double sum = 0.0;
    for (int side = -1; side <= 1; ++side) {
      double gray = 0.0;
      const Eigen::Vector2d place = at + side * tangent;
      if (!grayAt(image_, place.x(), place.y(), gray)) return;
      sum += (side == 0 ? 2.0 : 1.0) * gray;
    }
    profile[static_cast<std::size_t>(i + reach)] = 0.25 * sum;
  }
  const auto derivative = [&](int i) {
    double sum = 0.0;
    for (int k = 1; k <= taps_; ++k) {
      sum += kernel_[static_cast<std::size_t>(k - 1)] *
             (profile[static_cast<std::size_t>(i + reach + k)] -
              profile[static_cast<std::size_t>(i + reach - k)]);
    }
    return sum;
  };
  const int inner = reach - taps_;
  double before = derivative(-inner);
  double here = derivative(-inner + 1);
  double best = 0.0;
  for (int i = -inner + 1; i < inner; ++i) {
    const double after = derivative(i + 1);
    const double strength = std::abs(here);
    const bool peak = strength >= std::abs(before) && strength > std::abs(after);
    // A weaker edge nearby is likelier than a strong one at the rim of the search.
    const double away = i / static_cast<double>(inner + 1);
    const double preference = strength * (1.0 - away * away);
    if (peak && preference > best && strength >= options_.min_gradient) {
      best = preference;
      const double bend = std::abs(before) - 2.0 * strength + std::abs(after);
      const double shift = bend < 0.0 ? 0.5 * (std::abs(before) - std::abs(after)) / bend : 0.0;
      sample.residual_px = (i + std::clamp(shift, -0.5, 0.5)) * kStep_px;
      sample.gradient = here;
    }
    before = here;
    here = after;
  }
  if (ignore_ != nullptr && sample.gradient != 0.0) {
    const Eigen::Vector2d found = predicted_px + sample.residual_px * sample.normal;
    if (ignore_->get(static_cast<int>(found.x() + 0.5), static_cast<int>(found.y() + 0.5)))
      sample.gradient = 0.0;
  }
}

double EdgeRefinement::robustScale() {
  const RefinementResult& result = *result_;
  std::size_t count = 0;
  for (std::int32_t i = 0; i < result.sample_count; ++i) {
    const EdgeSample& sample = result.samples[static_cast<std::size_t>(i)];
    if (sample.gradient == 0.0) continue;
    absolute_residuals_[count] = static_cast<float>(std::abs(sample.residual_px));
    ++count;
  }
  const auto middle = absolute_residuals_.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(absolute_residuals_.begin(), middle,
                   absolute_residuals_.begin() + static_cast<std::ptrdiff_t>(count));
  return std::max(kMinScale_px, kMadToSigma * static_cast<double>(*middle));
}

Status EdgeRefinement::step(bool& done) {
  RefinementResult& result = *result_;
  result.found_count = 0;
  for (std::int32_t i = 0; i < result.sample_count; ++i) {
    EdgeSample& sample = result.samples[static_cast<std::size_t>(i)];
    sample.gradient = 0.0;
    sample.weight = 0.0;
    Eigen::Vector2d predicted_px;
    if (project(camera_, result.camera_from_station * sample.point_in_station_m, predicted_px)) {
      search(sample, predicted_px);
    }
    if (sample.gradient != 0.0) ++result.found_count;
  }
  done = true;
  if (result.found_count < options_.min_found) return Status::kTooFewEdges;
  ++round_;
  bool settled = false;
  const Status status = solve(robustScale(), settled);
  done = settled || round_ >= options_.rounds || status != Status::kOk;
  return status;
}

Status EdgeRefinement::solve(double scale_px, bool& settled) {
  RefinementResult& result = *result_;
  NormalEquations equations;
  double weights = 0.0;
  result.used_count = 0;
  const double cut_px = kTukey * scale_px;
  for (std::int32_t i = 0; i < result.sample_count; ++i) {
    EdgeSample& sample = result.samples[static_cast<std::size_t>(i)];
    if (sample.gradient == 0.0 || std::abs(sample.residual_px) >= cut_px) continue;
    const double ratio = sample.residual_px / cut_px;
    const double weight = (1.0 - ratio * ratio) * (1.0 - ratio * ratio);
    if (!addSample(sample, weight, equations)) continue;
    sample.weight = weight;
    weights += weight;
    if (weight > 0.5) ++result.used_count;
  }
  if (result.used_count < options_.min_found) return Status::kTooFewEdges;
  const double variance_px2 = equations.squares / weights;
  result.rms_px = std::sqrt(variance_px2);
  // Neighbouring places share their errors: each counts for less than one measurement.
  const double noise_px2 =
      std::max(variance_px2, kMinScale_px * kMinScale_px) * options_.covariance_inflation;
  equations.information /= noise_px2;
  equations.gradient /= noise_px2;
  if (!invert(equations.information, result.covariance)) return Status::kDegenerate;
  addKnowledge(equations);
  Vector6d xi;
  if (!boresight::solve(equations, 0.0, xi)) return Status::kDegenerate;
  Pose moved = perturbed(xi, result.camera_from_station);
  moved.rotation.normalize();
  if (!moved.isFinite()) return Status::kDegenerate;
  result.camera_from_station = moved;
  settled = xi.head<3>().cwiseAbs().maxCoeff() < kSettled_rad &&
            xi.tail<3>().cwiseAbs().maxCoeff() < kSettled_m;
  return Status::kOk;
}

/// The seed's uncertainty and the matched pose: weak beside thousands of edges, but where the edges
/// are few or ambiguous they keep the pose from drifting.
void EdgeRefinement::addKnowledge(NormalEquations& equations) const {
  const Pose& now = result_->camera_from_station;
  if (anchored_) addPrior(anchor_, now, equations);
  if (!has_matched_) return;
  equations.information += matched_.information;
  equations.gradient +=
      matched_.information * perturbationBetween(now, matched_.camera_from_station);
}

bool EdgeRefinement::addSample(const EdgeSample& sample, double weight,
                               NormalEquations& equations) const {
  const Eigen::Vector3d point_in_camera_m =
      result_->camera_from_station * sample.point_in_station_m;
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> jacobian;
  if (!projectWithJacobian(camera_, point_in_camera_m, pixel, jacobian)) return false;
  const Eigen::Vector3d slope = (sample.normal.transpose() * jacobian).transpose();
  Vector6d row;
  row << point_in_camera_m.cross(slope), slope;  // d(n . pixel)/d xi for p -> p + r x p + t
  for (int a = 0; a < 6; ++a) {
    const double weighted = weight * row[a];
    equations.gradient[a] += weighted * sample.residual_px;
    for (int b = 0; b <= a; ++b) equations.information(a, b) += weighted * row[b];
  }
  equations.squares += weight * sample.residual_px * sample.residual_px;
  ++equations.projected;
  return true;
}

}  // namespace boresight
