// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <Eigen/Cholesky>

#include "core/accept/edge_width.h"
#include "sessions/annotation/annotations_on_image.h"
#include "sessions/checks/checks.h"
#include "sessions/checks/edge_evidence.h"
#include "sessions/decision/check.h"
#include "sessions/session/stated_inputs.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr CheckName kCoverage{"edge_coverage", "Predicted edges that are seen"};
constexpr CheckName kClutter{"edge_clutter", "Edges on the station that are not predicted"};
constexpr CheckName kEvidence{"edge_evidence", "Evidence of the edges beyond chance"};
constexpr CheckName kFallOff{"edge_fall_off", "Edge-coverage sensitivity to displacement"};
constexpr CheckName kWidth{"edge_width", "Sharpness of the image"};
constexpr CheckName kFocal{"camera_focal", "Focal length estimated from the edges"};
constexpr CheckName kCentre{"camera_centre", "Principal point estimated from the edges"};

constexpr const char* kCameraRemedy =
    "Camera, mesh and image contradict each other: check that the calibration is for this camera, "
    "focus and image size, and that the mesh is of this station.";

constexpr const char* kUndecidedRemedy =
    "The image cannot confirm the camera: state its calibration_sigma, or use a nearer image.";

Check coverageCheck(double seen, const CheckLimits& limits) {
  return measuredCheck(
      kCoverage, "%", 100.0 * seen, limits.coverage_percent, LimitSide::kAtLeast,
      "The image shows " + percentText(seen) +
          " of the edges that this pose predicts, in place and direction.",
      "Check the overlay: pose or mesh is wrong, or much of the station is dark or hidden.");
}

Check clutterCheck(const Share& clutter, const CheckLimits& limits) {
  if (clutter.whole == 0.0)
    return notAskedCheck(kClutter, "The image shows no edges on the station.");
  const double share = clutter.value();
  return measuredCheck(
      kClutter, "%", 100.0 * share, limits.clutter_percent, LimitSide::kAtMost,
      percentText(share) + " of the image's edges on the station are not predicted by the pose.",
      "Check these edges: shadows and labels are harmless; another station or a part missing in "
      "the mesh is not.");
}

/// In print and texture the displaced outlines are seen, too: the evidence expected of a right pose
/// is then small, and a right pose still has it.
Check evidenceCheck(const Share& evidence, const CheckLimits& limits) {
  if (evidence.whole <= 0.0)
    return notAskedCheck(kEvidence, "Displaced outlines are seen as often as a right pose's.");
  const double share = evidence.value();
  return measuredCheck(kEvidence, "%", 100.0 * share, limits.evidence_percent, LimitSide::kAtLeast,
                       "Beyond chance, the predicted edges show " +
                           percentText(std::max(0.0, share)) +
                           " of the evidence that those of a right pose would.",
                       "Other poses explain the image about as well: check the overlay.");
}

Check fallOffCheck(double seen, const std::vector<FallOff>& fall_off, bool symmetric,
                   const CheckLimits& limits) {
  const auto least = std::ranges::max_element(fall_off, {}, &FallOff::coverage);
  if (least == fall_off.end() || seen <= 0.0)
    return notAskedCheck(kFallOff, "No predicted edge is seen.");
  const double fall = 1.0 - least->coverage / seen;
  return measuredCheck(kFallOff, "%", 100.0 * fall, limits.fall_off_percent, LimitSide::kAtLeast,
                       "Displaced by " + sentenceNumber(kDisplaced_px) +
                           " px in the image, the pose loses at least " +
                           sentenceNumber(100.0 * fall) + " % of the edges seen, least when " +
                           least->direction + "." +
                           (symmetric ? " Turns about axes of symmetry are left out." : ""),
                       "The image hardly constrains the pose in this direction: use annotations or "
                       "a second camera.");
}

/// Motion and defocus, measured where the pose has its edges.
Check widthCheck(const LoadedCase& loaded, std::span<const EdgePlace> places,
                 const CheckLimits& limits) {
  EdgeWidthMeter meter(loaded.image.view(), loaded.ignore ? &loaded.ignore_bits : nullptr);
  for (const EdgePlace& place : places) meter.add(place.pixel, place.normal);
  const EdgeWidth width = meter.width();
  if (width.widestDirection() < 0)
    return notAskedCheck(kWidth, "Too few of the predicted edges are seen.");
  return measuredCheck(kWidth, "px", width.widest_px(), limits.edge_width_px, LimitSide::kAtMost,
                       "The image's edges are " + sentenceNumber(width.widest_px()) +
                           " px wide in the least sharp direction.",
                       "The image is blurred by motion or focus: use a sharper image.");
}

/// One of the camera's parameters as the edges would have it.
struct AskedChange {
  double change = 0.0;
  double sigma = 0.0;
  double calibrated_sigma = 0.0;
  bool stated = false;  ///< that sigma; else it is assumed
  std::string unit;
};

/// What a right camera exceeds seldom, with Gaussian errors: the focal length in 13 %, the
/// principal point, which has two axes, in up to 32 %. The limit comes on top.
constexpr double kSignificant_sigmas = 1.5;

/// A change of this size may be chance.
double byChance(const AskedChange& asked) {
  return kSignificant_sigmas * std::hypot(asked.sigma, asked.calibrated_sigma);
}

/// An image confirms a camera when this part of its sigma is within the limit: with more, hidden
/// and dark stations do not confirm right cameras; with less, wrong ones pass.
constexpr double kConfirming_sigmas = 0.8;

/// What exceeds chance. Where nothing is stated of the calibration the image must confirm it.
double unexplained(const AskedChange& asked) {
  const double beyond = std::max(0.0, std::abs(asked.change) - byChance(asked));
  return asked.stated ? beyond : std::max(beyond, kConfirming_sigmas * asked.sigma);
}

Check cameraCheck(const CheckName& name, const std::string& what, const AskedChange& asked,
                  double limit) {
  const double figure = unexplained(asked);
  const bool undecided = std::abs(asked.change) <= limit + byChance(asked);
  return measuredCheck(name, asked.unit, figure, limit, LimitSide::kAtMost,
                       "Estimated freely, the " + what + sentenceNumber(asked.change) + " " +
                           asked.unit + " (one sigma " + sentenceNumber(asked.sigma) + " " +
                           asked.unit + "). Errors below " + sentenceNumber(byChance(asked)) + " " +
                           asked.unit + " cannot be seen.",
                       undecided ? kUndecidedRemedy : kCameraRemedy);
}

/// A requirement in pixels does not limit millimetres, and a wrong camera hardly moves the image.
bool asksForMetric(const Requirement& requirement) {
  return requirement.normal_mm || requirement.lateral_mm || requirement.rotation_deg;
}

bool canBeMeasured(const ReviewSubject& subject) {
  if (subject.loaded == nullptr) return false;
  const GrayImage& image = subject.loaded->image;
  const Camera& camera = subject.loaded->source.camera;
  return !image.pixels.empty() && image.width == camera.width && image.height == camera.height;
}

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

constexpr std::size_t kLeastFound = 60;
constexpr int kRounds = 10;
/// Of 85 % efficiency: shadows and bevels next to an edge are many and off to one side, but with a
/// tighter limit the fit finds its own selection again (`resources/evidence/trust.md`).
constexpr double kTukey = 3.44;
/// Farther ones are mostly another edge.
constexpr double kFarthest_px = 2.5;
constexpr double kDeviationOfMedian = 1.4826;
constexpr double kLeastScale_px = 0.05;
/// Tiles along the longer side of what is looked at.
constexpr double kTiles = 12.0;
/// Against a matrix that cannot be inverted: of its diagonal.
constexpr double kLeastPivot = 1e-11;

struct Row {
  Vector9d by;  ///< of the predicted coordinate along the normal
  double residual_px = 0.0;
  std::pair<int, int> tile;
};

std::vector<Row> rowsOf(std::span<const LookedPlace> looked, const Camera& camera,
                        const Pose& camera_from_station) {
  std::vector<Row> rows;
  Eigen::AlignedBox2d box;
  for (const auto& [place, found] : looked) box.extend(place.pixel);
  const double tile_px = std::max(box.sizes().maxCoeff() / kTiles, 1.0);
  for (const auto& [place, found] : looked) {
    const PredictedPlace at = predictPlace(camera, camera_from_station, place.point_in_station_m);
    if (!found || std::abs(found->offset_px) > kFarthest_px || !at.valid) continue;
    Row row;
    row.by.head<6>() = at.pixel_by_xi.transpose() * place.normal;
    row.by.tail<3>() = pixelByCamera(camera, at.pixel).transpose() * place.normal;
    row.residual_px = found->offset_px;
    const Eigen::Vector2d tile = (place.pixel - box.min()) / tile_px;
    row.tile = {static_cast<int>(tile.x()), static_cast<int>(tile.y())};
    rows.push_back(row);
  }
  return rows;
}

double tukeyWeight(double residual_px, double cut_px) {
  const double u = residual_px / cut_px;
  return std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
}

/// Derivative of Tukey's influence, weight times residual: below 0 for residuals far out.
double tukeySlope(double residual_px, double cut_px) {
  const double u = residual_px / cut_px;
  return std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - 5.0 * u * u) : 0.0;
}

double scaleOf(const std::vector<Row>& rows, const Vector9d& solution) {
  std::vector<double> sizes;
  for (const Row& row : rows) sizes.push_back(std::abs(row.residual_px - row.by.dot(solution)));
  return std::max(kDeviationOfMedian * medianOf(sizes), kLeastScale_px);
}

struct Solved {
  Vector9d solution = Vector9d::Zero();
  Matrix9d inverse = Matrix9d::Zero();  ///< of the weighted equations
  double cut_px = 0.0;                  ///< beyond, a residual weighs nothing

  double residual_px(const Row& row) const { return row.residual_px - row.by.dot(solution); }
};

/// Empty where the matrix is not positive definite.
std::optional<Matrix9d> inverseOf(const Matrix9d& information) {
  if (!(information.diagonal().minCoeff() > 0.0)) return {};
  const Vector9d inverse_scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix9d balanced = inverse_scale.asDiagonal() * information * inverse_scale.asDiagonal();
  const Eigen::LDLT<Matrix9d> factors(balanced);
  if (!(factors.vectorD().minCoeff() > kLeastPivot)) return {};
  return inverse_scale.asDiagonal() * factors.solve(Matrix9d(Matrix9d::Identity())) *
         inverse_scale.asDiagonal();
}

/// Information that fixes the pose along motions which the edges cannot show, as much as all rows
/// together give to a motion.
Matrix9d fixing(const PoseMotions& symmetric, const std::vector<Row>& rows) {
  Matrix6d of_rows = Matrix6d::Zero();
  for (const Row& row : rows) of_rows.diagonal() += row.by.head<6>().cwiseAbs2();
  Matrix9d information = Matrix9d::Zero();
  for (const auto& motion : symmetric.colwise()) {
    const Vector6d pull = of_rows * motion;
    const double whole = motion.dot(pull);
    if (whole > 0.0) information.topLeftCorner<6, 6>() += pull * pull.transpose() / whole;
  }
  return information;
}

std::optional<Solved> solveRobustly(const std::vector<Row>& rows, const Matrix9d& fixed) {
  Solved solved;
  for (int round = 0; round < kRounds; ++round) {
    solved.cut_px = kTukey * scaleOf(rows, solved.solution);
    Matrix9d information = fixed;
    Vector9d right = Vector9d::Zero();
    for (const Row& row : rows) {
      const double weight = tukeyWeight(solved.residual_px(row), solved.cut_px);
      information += weight * row.by * row.by.transpose();
      right += weight * row.residual_px * row.by;
    }
    const std::optional<Matrix9d> inverse = inverseOf(information);
    if (!inverse) return {};
    solved.inverse = *inverse;
    solved.solution = solved.inverse * right;
  }
  return solved;
}

/// Sandwich covariance of an M-estimate over tiles, as a jackknife: how far the estimate moves
/// without a tile, summed over the tiles (CR3, Bell and McCaffrey 2002). The equations sum the
/// derivative of the influence: with its weights in their place, sigmas of Gaussian errors are 1.5
/// times too small. Where the derivative leaves a direction open the weights serve: sigmas are
/// large then, and rather too small.
Matrix9d clusteredCovariance(const std::vector<Row>& rows, const Solved& solved,
                             const Matrix9d& fixed) {
  struct Tile {
    Vector9d score = Vector9d::Zero();
    Matrix9d slope = Matrix9d::Zero();
  };
  std::map<std::pair<int, int>, Tile> tiles;
  Matrix9d slope = fixed;
  for (const Row& row : rows) {
    const double residual_px = solved.residual_px(row);
    const Matrix9d of_row = tukeySlope(residual_px, solved.cut_px) * row.by * row.by.transpose();
    Tile& tile = tiles[row.tile];
    tile.score += tukeyWeight(residual_px, solved.cut_px) * residual_px * row.by;
    tile.slope += of_row;
    slope += of_row;
  }
  const Matrix9d of_all = inverseOf(slope).value_or(solved.inverse);
  Matrix9d covariance = Matrix9d::Zero();
  for (const auto& [place, tile] : tiles) {
    const Vector9d moved = inverseOf(slope - tile.slope).value_or(of_all) * tile.score;
    covariance += moved * moved.transpose();
  }
  const double count = static_cast<double>(tiles.size());
  return covariance * ((count - 1.0) / count);
}

}  // namespace

void addCameraChecks(const std::optional<CameraFit>& fit, const SessionCase& session_case,
                     const CheckLimits& limits, std::vector<Check>& checks) {
  const InputSigmas known(session_case);
  if (!fit) {
    for (const auto& [name, stated] : {std::pair(kFocal, known.stated.focal_relative),
                                       std::pair(kCentre, known.stated.principal_point_px)}) {
      const char* why = "The edges do not determine the camera together with the pose.";
      checks.push_back(stated ? notAskedCheck(name, why)
                              : statedCheck(name, false, why, kUndecidedRemedy));
    }
    return;
  }
  const double percent = 100.0 / session_case.camera.fx;
  checks.push_back(cameraCheck(
      kFocal, "focal length changes by ",
      {percent * fit->focal_px, percent * fit->focal_sigma_px,
       100.0 * known.calibration.focal_relative, known.stated.focal_relative.has_value(), "%"},
      limits.focal_percent));
  checks.push_back(cameraCheck(
      kCentre, "principal point moves by ",
      {fit->centre_px.norm(), fit->centreSigma_px(), known.calibration.principal_point_px,
       known.stated.principal_point_px.has_value(), "px"},
      limits.centre_px));
}

void addEdgeChecks(const ReviewSubject& subject, const CheckLimits& limits,
                   const PredictedEdges& edges, std::vector<Check>& checks) {
  const bool measurable = canBeMeasured(subject);
  if (!measurable || edges.places.empty()) {
    const std::string why = measurable ? "The pose shows no edge of the station in the image."
                                       : "The image does not have the camera's size.";
    checks.push_back(statedCheck(
        kCoverage, false, why,
        measurable ? "Check the overlay and the seed." : "Use the image's own camera."));
    return addNotAsked({kClutter, kEvidence, kFallOff, kWidth, kFocal, kCentre}, why, checks);
  }
  const LoadedCase& loaded = *subject.loaded;
  const ImageEdges image(loaded.image.view(), loaded.ignore ? &loaded.ignore_bits : nullptr,
                         regionOf(edges));
  const auto places = thinned(edges.places, kEdgePlaces);
  const auto looked = lookAt(image, places);
  const Camera& camera = loaded.source.camera;
  const double seen = coverageOf(looked).value();
  checks.push_back(coverageCheck(seen, limits));
  checks.push_back(clutterCheck(clutterOf(image, edges, looked), limits));
  checks.push_back(evidenceCheck(evidenceOf(image, looked), limits));
  const PoseMotions symmetric =
      symmetricMotions(subject.camera_from_station, loaded.source.symmetries);
  checks.push_back(
      fallOffCheck(seen, fallOffOf(image, places, camera, subject.camera_from_station, symmetric),
                   symmetric.cols() > 0, limits));
  checks.push_back(widthCheck(loaded, places, limits));
  if (!asksForMetric(subject.requirement))
    return addNotAsked({kFocal, kCentre},
                       "The requirement is in pixels, where a wrong camera has little effect.",
                       checks);
  addCameraChecks(fitCamera(looked, camera, subject.camera_from_station, symmetric), loaded.source,
                  limits, checks);
}

std::optional<CameraFit> fitCamera(std::span<const LookedPlace> looked, const Camera& camera,
                                   const Pose& camera_from_station, const PoseMotions& symmetric) {
  const std::vector<Row> rows = rowsOf(looked, camera, camera_from_station);
  if (rows.size() < kLeastFound) return {};
  const Matrix9d fixed = fixing(symmetric, rows);
  const auto solved = solveRobustly(rows, fixed);
  if (!solved) return {};
  const Matrix9d covariance = clusteredCovariance(rows, *solved, fixed);
  CameraFit fit;
  fit.focal_px = solved->solution(6);
  fit.focal_sigma_px = std::sqrt(covariance(6, 6));
  fit.centre_px = solved->solution.tail<2>();
  fit.centre_covariance_px2 = covariance.bottomRightCorner<2, 2>();
  return fit;
}

double CameraFit::centreSigma_px() const {
  const Eigen::Vector2d along =
      centre_px.norm() > 0.0 ? centre_px.normalized() : Eigen::Vector2d::UnitX();
  return std::sqrt(along.dot(centre_covariance_px2 * along));
}

}  // namespace boresight::sessions
