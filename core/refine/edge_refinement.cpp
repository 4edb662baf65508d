// SPDX-License-Identifier: Apache-2.0
#include "core/refine/edge_refinement.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/base/nth.h"

namespace boresight {
namespace {

/// Searches as far as this take wide steps: a narrower one follows.
constexpr double kWideSearch_px = 2.0;
constexpr double kSettled_px = 0.003;  ///< a step below this does not change the measurements

/// Neighbouring places share their errors and weigh less than independent measurements.
constexpr double kSharedNoise = 4.0;
/// The lower triangle of a symmetric matrix is filled.
double quadraticForm(const Matrix6d& lower, const Vector6d& x) {
  double sum = 0.0;
  for (int a = 0; a < 6; ++a) {
    for (int b = 0; b <= a; ++b) sum += (a == b ? 1.0 : 2.0) * lower(a, b) * x[a] * x[b];
  }
  return sum;
}

}  // namespace

Status EdgeRefinement::create(const RefinementOptions& options, Arena& arena) {
  if (firstInvalidOption(options) != nullptr) return Status::kInvalidOption;
  setOptions(options);
  absolute_residuals_ = arena.allocate<float>(options.max_samples);
  found_ = arena.allocate<Found>(options.max_samples);
  if (groups_.create(arena) != Status::kOk) return Status::kArenaTooSmall;
  return arena.exhausted() ? Status::kArenaTooSmall : Status::kOk;
}

Status EdgeRefinement::begin(const ImageView& image, const BitImage* ignore, const Camera& camera,
                             const MeshView& mesh, const EdgeRender& render, double radius_px,
                             const PosePrior* anchor, const PoseEstimate* matched,
                             RefinementResult& result, std::int32_t most_samples) {
  image_ = image;
  ignore_ = ignore;
  camera_ = camera;
  radius_px_ = radius_px;
  result_ = &result;
  round_ = 0;
  moved_px_ = 0.0;
  anchored_ = anchor != nullptr;
  if (anchored_) anchor_ = *anchor;
  has_matched_ = matched != nullptr;
  if (has_matched_) matched_ = *matched;
  result.camera_from_station = render.camera_from_station;
  result.covariance = Matrix6d::Zero();
  result.found_count = 0;
  result.used_count = 0;
  result.rms_px = 0.0;
  const bool limited = most_samples > 0 && most_samples < options_.max_samples;
  takeSamples(mesh, render, limited ? most_samples : options_.max_samples);
  return result.sample_count < kMinFound ? Status::kTooFewEdges : Status::kOk;
}

void EdgeRefinement::takeSamples(const MeshView& mesh, const EdgeRender& render,
                                 std::int32_t most) {
  // The render's pixels are 2^level pixels of the image long.
  const double scale = static_cast<double>(camera_.width) / std::max(1, render.camera.width);
  const int by_spacing = static_cast<int>(kSampleSpacing_px / scale + 0.5);
  const int by_need = render.pixel_count / kMinSamples;
  const int stride = std::max(std::min(by_spacing, by_need), render.strideFor(most));
  RefinementResult& result = *result_;
  result.sample_count = 0;
  box_px_.setEmpty();
  for (const EdgePixel& pixel : render.eachPixel(stride)) {
    Eigen::Vector2d position_px;
    EdgeSample sample;
    if (!edgeLinePoint(render, mesh, pixel, position_px, sample.point_in_station_m)) continue;
    sample.normal_x = pixel.normal_x;
    sample.normal_y = pixel.normal_y;
    sample.kind = pixel.kind;
    box_px_.extend(scale * position_px);
    nth(result.samples, result.sample_count) = sample;
    ++result.sample_count;
  }
}

double EdgeRefinement::robustScale() {
  const RefinementResult& result = *result_;
  std::size_t count = 0;
  for (std::int32_t i = 0; i < result.sample_count; ++i) {
    const EdgeSample& sample = nth(result.samples, i);
    if (sample.gradient == 0.0) continue;
    absolute_residuals_[count++] = static_cast<float>(std::abs(sample.residual_px));
  }
  return robustScale_px(absolute_residuals_.first(count));
}

Status EdgeRefinement::step(bool& done) {
  for (int chunk = 0; chunk < chunks(); ++chunk) searchChunk(chunk);
  return finishRound(done);
}

Status EdgeRefinement::finishRound(bool& done) {
  EdgeEquations found;
  bool settled = false;
  done = true;
  Status status = gather(found);
  if (status == Status::kOk) status = advance(found, settled);
  done = settled || roundsAreOver() || status != Status::kOk;
  return status;
}

Status EdgeRefinement::gather(EdgeEquations& found) {
  RefinementResult& result = *result_;
  const bool search = searches();
  ++round_;
  motion_ = Matrix6d::Zero();
  if (search) {
    moved_px_ = 0.0;
    result.found_count = 0;
    for (std::int32_t i = 0; i < result.sample_count; ++i) {
      if (nth(result.samples, i).gradient != 0.0) ++result.found_count;
    }
  }
  if (result.found_count < kMinFound) return Status::kTooFewEdges;
  if (search) scale_px_ = robustScale();
  double weights = 0.0;
  found = weightedEquations(weights);
  NormalEquations& equations = found.step;
  if (result.used_count < kMinFound) return Status::kTooFewEdges;
  const double variance_px2 = equations.squares / weights;
  result.rms_px = std::sqrt(variance_px2);
  motion_ = equations.information / weights;
  const double noise_px2 = std::max(variance_px2, kMinScale_px * kMinScale_px) * kSharedNoise;
  equations.information /= noise_px2;
  equations.gradient /= noise_px2;
  // Scaled by noise, so that views of different noise can be added.
  found.errors.curvature /= noise_px2;
  found.errors.squares /= noise_px2 * noise_px2;
  return Status::kOk;
}

void EdgeRefinement::searchChunk(int chunk) {
  RefinementResult& result = *result_;
  const PoseMatrix camera_from_station(result.camera_from_station);
  const EdgeSearch& search = radius_px_ >= kWideSearch_px ? wide_search_ : fine_search_;
  const std::int32_t end = std::min(result.sample_count, (chunk + 1) * kChunk);
  for (std::int32_t i = chunk * kChunk; i < end; ++i) {
    EdgeSample& sample = nth(result.samples, i);
    sample.gradient = 0.0;
    Eigen::Vector2d predicted_px;
    if (!project(camera_, camera_from_station * sample.point_in_station_m, predicted_px)) continue;
    const Eigen::Vector2d normal = sample.normal();
    const EdgePeak peak =
        search.find(image_, ignore_, predicted_px, normal, radius_px_, kMinGradient);
    sample.residual_px = peak.offset_px;
    sample.gradient = peak.gradient;
    nth(found_, i) = {normal.dot(predicted_px) + peak.offset_px, peak.blur_px};
  }
}

Status EdgeRefinement::advance(EdgeEquations found, bool& settled) {
  RefinementResult& result = *result_;
  NormalEquations& equations = found.step;
  const bool determined = invert(equations.information, result.covariance);
  Matrix6d measured;  // without groups, errors count as independent
  if (determined && found.errors.covariance(measured)) result.covariance = measured;
  addKnowledge(equations);
  // A direction that the edges do not determine keeps its prior uncertainty.
  if (!determined && !invert(equations.information, result.covariance)) return Status::kDegenerate;
  Vector6d xi;
  if (!solve(equations, 0.0, xi)) return Status::kDegenerate;
  Pose moved = perturbed(xi, result.camera_from_station);
  moved.rotation.normalize();
  if (!moved.isFinite()) return Status::kDegenerate;
  result.camera_from_station = moved;
  settled = noteMove(xi);
  return Status::kOk;
}

bool EdgeRefinement::moveTo(const Pose& camera_from_station) {
  const Vector6d xi = perturbationBetween(result_->camera_from_station, camera_from_station);
  result_->camera_from_station = camera_from_station;
  return noteMove(xi);
}

bool EdgeRefinement::noteMove(const Vector6d& xi) {
  const double step_px = std::sqrt(std::max(0.0, quadraticForm(motion_, xi)));
  moved_px_ += step_px;
  return step_px < kSettled_px;
}

/// Adds the seed's uncertainty and the matched pose: weak against thousands of edges, but where the
/// edges are few or ambiguous they prevent drift.
void EdgeRefinement::addKnowledge(NormalEquations& equations) const {
  const Pose& camera_from_station = result_->camera_from_station;
  if (anchored_) addPrior(anchor_, camera_from_station, equations);
  if (!has_matched_) return;
  equations.information += matched_.information;
  equations.gradient +=
      matched_.information * perturbationBetween(camera_from_station, matched_.camera_from_station);
}

/// Equations of the edges found, at the current pose, with Tukey's weights; counts the used edges.
EdgeEquations EdgeRefinement::weightedEquations(double& weights) {
  RefinementResult& result = *result_;
  const PoseMatrix camera_from_station(result.camera_from_station);
  const double cut_px = kTukey * scale_px_;
  EdgeEquations equations;
  groups_.clear();
  result.used_count = 0;
  for (std::int32_t i = 0; i < result.sample_count; ++i) {
    EdgeSample& sample = nth(result.samples, i);
    sample.weight = 0.0;
    if (sample.gradient == 0.0) continue;
    const Eigen::Vector3d point_in_camera_m = camera_from_station * sample.point_in_station_m;
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> jacobian;
    if (!projectWithJacobian(camera_, point_in_camera_m, pixel, jacobian)) continue;
    const Eigen::Vector2d normal = sample.normal();
    sample.residual_px = nth(found_, i).at_px - normal.dot(pixel);
    if (std::abs(sample.residual_px) >= cut_px) continue;
    const double ratio = sample.residual_px / cut_px;
    sample.weight = (1.0 - ratio * ratio) * (1.0 - ratio * ratio);
    const Vector6d row = lineRow(point_in_camera_m, normal, jacobian);
    const double weight = shareOf(sample) * sample.weight;
    addRow(row, weight, sample.residual_px, equations.step);
    noteGroups(sample, pixel, row, ratio, nth(found_, i).blur_px, equations.errors.curvature);
    weights += weight;
    if (sample.weight > 0.5) ++result.used_count;
  }
  groups_.sum(equations.errors);
  return equations;
}

/// Adds a sample to the sums of the covariance; `ratio`: residual over the cut-off of the weights.
void EdgeRefinement::noteGroups(const EdgeSample& sample, const Eigen::Vector2d& pixel,
                                const Vector6d& row, double ratio, double blur_px,
                                Matrix6d& curvature) {
  const double squared = ratio * ratio;
  const double share = shareOf(sample);
  const double bend = share * (1.0 - squared) * (1.0 - 5.0 * squared);  // of Tukey's influence
  for (int a = 0; a < 6; ++a)
    for (int b = 0; b <= a; ++b) curvature(a, b) += bend * row[a] * row[b];
  GroupedError error = groupedError(sample, pixel, box_px_);
  error.blur_px = blur_px;
  groups_.add(error, sample.residual_px, share * sample.weight * row);
}

}  // namespace boresight
