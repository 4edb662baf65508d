// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/base/options.h"
#include "core/base/status.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/pnp/normal_equations.h"
#include "core/pnp/pnp_ransac.h"
#include "core/pnp/refine_pose.h"
#include "core/refine/edge_search.h"
#include "core/refine/error_groups.h"
#include "core/render/edge_render.h"

namespace boresight {

/// Options of the last step, the refinement on the image's edges.
struct RefinementOptions {
  bool enabled = true;
  std::int32_t max_samples = 12000;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"refinement.enabled", "", 0, 1,
                     "Refine the matched pose on the raw image's edges."},
          self.enabled);
    visit(OptionInfo{"refinement.max_samples", "", 100, 100000, "Edge places used, at most."},
          self.max_samples);
  }
};

/// Prior knowledge of a pose: cost xi' information xi with xi the perturbation from it.
struct PoseEstimate {
  Pose camera_from_station;                 ///< the estimate
  Matrix6d information = Matrix6d::Zero();  ///< inverse of its covariance, over xi
};

/// One place on a rendered edge and its measurement in the image.
struct EdgeSample {
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();  ///< on the model's edge
  double residual_px = 0.0;  ///< along the normal, found minus predicted
  double gradient = 0.0;     ///< signed, gray/px along the normal; 0 where no edge was found
  double weight = 0.0;       ///< robust, of the last round
  std::int8_t normal_x = 0;  ///< as of the edge pixel: times 127
  std::int8_t normal_y = 0;  ///< likewise
  std::uint8_t kind = 0;     ///< EdgeKind bits

  /// Normal in the image, from the nearer surface outwards.
  Eigen::Vector2d normal() const { return Eigen::Vector2d(normal_x, normal_y) / 127.0; }
};

/// The error of a sample whose edge is seen at `pixel`, for ErrorGroups. `box_px`: box of all edge
/// places.
inline GroupedError groupedError(const EdgeSample& sample, const Eigen::Vector2d& pixel,
                                 const Eigen::AlignedBox2d& box_px) {
  const Eigen::Vector2d sizes_px = box_px.sizes().cwiseMax(1.0);
  return {(pixel - box_px.min()).cwiseQuotient(sizes_px), sample.normal(), sample.gradient > 0.0,
          sample.kind};
}

/// Equations of an image's edges for a pose in a round.
struct EdgeEquations {
  NormalEquations step;  ///< H and g, in px / px of noise
  ErrorSums errors;      ///< for the covariance
};

/// Result of the refinement of a pose.
struct RefinementResult {
  Pose camera_from_station;  ///< the refined pose; before the first round the start pose
  /// As in PnpSolution: of the edges alone; of edges, anchor and matched pose together where the
  /// edges alone leave a direction open.
  Matrix6d covariance = Matrix6d::Zero();
  std::span<EdgeSample> samples;  ///< capacity; the first `sample_count` are valid
  std::int32_t sample_count = 0;  ///< places searched
  std::int32_t found_count = 0;   ///< samples with an edge within the radius
  std::int32_t used_count = 0;    ///< samples with a weight above one half
  double rms_px = 0.0;            ///< weighted residual
};

/// Moves the pose so that the rendered edges meet the image's own (RAPID, Harris and Stennett 1990,
/// with robust weights, Drummond and Cipolla 2002): places along the salient edges, searched along
/// the line's normal for the largest derivative of the raw image, Tukey's weights, Gauss-Newton.
/// Edges found are reused until the pose has moved by kSearchAgain_px; the pose returned is at most
/// that far from the pose of the last search.
class EdgeRefinement {
 public:
  /// With fewer samples than this the spacing is reduced: a small object needs all its edge pixels.
  static constexpr int kMinSamples = 4000;
  static constexpr double kSampleSpacing_px = 2.0;  ///< nearer places share their errors
  static constexpr int kMinFound = 60;              ///< ten per unknown; fewer edges give no pose
  static constexpr int kRounds = 10;                ///< of a refinement, at most
  /// Edges are searched again once the rendered edges have moved by this along their normals (root
  /// mean square): a smaller motion does not change the result.
  static constexpr double kSearchAgain_px = 0.1;
  static constexpr double kDerivativeSigma_px = 1.0;  ///< the blur of a sharp image
  static constexpr double kMinGradient = 2.0;         ///< gray/px; weaker ones are noise
  /// Weight of edges whose far side is brighter than the nearer surface (other edges: 1): these
  /// come from a lit background behind a shaded face, and lie 0.1 to 0.3 px inside.
  static constexpr double kRisingWeight = 0.4;

  /// Weight of an edge by its side, multiplied with the robust weight.
  static double shareOf(const EdgeSample& sample) {
    return sample.gradient > 0.0 ? kRisingWeight : 1.0;
  }

  /// Takes the memory of a localization from `arena`. kArenaTooSmall, kInvalidOption.
  Status create(const RefinementOptions& options, Arena& arena);
  /// Sets the options from the next begin() on, except max_samples, which sizes the memory.
  void setOptions(const RefinementOptions& options) { options_ = options; }
  /// Takes the samples from a render of the same pose; `image` is raw, at full resolution, `camera`
  /// its camera; `ignore` may be nullptr. `anchor` and `matched` (each may be nullptr) are prior
  /// knowledge of the pose: they hold directions that the edges do not determine. At most
  /// `most_samples` are taken; 0: as many as the options allow.
  Status begin(const ImageView& image, const BitImage* ignore, const Camera& camera,
               const MeshView& mesh, const EdgeRender& render, double radius_px,
               const PosePrior* anchor, const PoseEstimate* matched, RefinementResult& result,
               std::int32_t most_samples = 0);
  /// Sets a start pose other than the render's; call after begin().
  void startFrom(const Pose& camera_from_station) {
    result_->camera_from_station = camera_from_station;
  }
  /// Number of chunks of a round. Chunks of samples are independent: different chunks may be
  /// searched at the same time. 0 when the edges found are reused.
  int chunks() const { return searches() ? (result_->sample_count + kChunk - 1) / kChunk : 0; }
  /// Largest number of chunks of a round.
  static int chunksOf(const RefinementOptions& options) {
    return (options.max_samples + kChunk - 1) / kChunk;
  }
  void searchChunk(int chunk);  ///< Searches the image's edges at the samples of one chunk
  /// Ends the round when all chunks have been searched; kTooFewEdges when too few edges are found,
  /// kDegenerate when edges and prior knowledge do not determine the pose.
  Status finishRound(bool& done);
  /// Runs a whole round.
  Status step(bool& done);

  // The parts of finishRound(), for a joint refinement of several views (core/views). A round is
  // then: searchChunk() of every chunk, gather(), and either advance() by the sum of all views'
  // equations, or moveTo() the pose from that step.

  /// Ends the search and returns the equations of the edges found. kTooFewEdges when too few are
  /// found.
  Status gather(EdgeEquations& found);
  /// Moves the pose to the solution of the equations with anchor and matched pose, and computes its
  /// covariance. kDegenerate when they do not determine the pose.
  Status advance(EdgeEquations found, bool& settled);
  /// Sets a pose from outside; returns whether the image motion is below the limit.
  bool moveTo(const Pose& camera_from_station);
  /// Whether this was the last round.
  bool roundsAreOver() const { return round_ >= kRounds; }

 private:
  static constexpr std::int32_t kChunk = 256;
  void takeSamples(const MeshView& mesh, const EdgeRender& render, std::int32_t most);
  bool searches() const { return round_ == 0 || moved_px_ > kSearchAgain_px; }
  double robustScale();
  void addKnowledge(NormalEquations& equations) const;
  bool noteMove(const Vector6d& xi);
  EdgeEquations weightedEquations(double& weights);
  void noteGroups(const EdgeSample& sample, const Eigen::Vector2d& pixel, const Vector6d& row,
                  double ratio, double blur_px, Matrix6d& curvature);

  RefinementOptions options_;
  ImageView image_;
  const BitImage* ignore_ = nullptr;
  Camera camera_;
  double radius_px_ = 0.0;
  bool anchored_ = false;
  PosePrior anchor_;
  bool has_matched_ = false;
  PoseEstimate matched_;
  RefinementResult* result_ = nullptr;
  EdgeSearch fine_search_{kDerivativeSigma_px};
  EdgeSearch wide_search_{kDerivativeSigma_px, EdgeSearch::kWideStep_px};
  ErrorGroups groups_;
  Matrix6d motion_ = Matrix6d::Zero();  ///< xi' motion xi: mean square along the normals, px^2
  Eigen::AlignedBox2d box_px_;          ///< of the edge places where they begin
  std::span<float> absolute_residuals_;
  /// The edge found at a sample.
  struct Found {
    double at_px = 0.0;    ///< the image's coordinate along the sample's normal
    double blur_px = 0.0;  ///< EdgePeak::blur_px
  };
  std::span<Found> found_;  ///< per sample
  std::int32_t round_ = 0;
  double moved_px_ = 0.0;  ///< since the last search of the edges
  double scale_px_ = 0.0;  ///< of the residuals then
};

}  // namespace boresight
