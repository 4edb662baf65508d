// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/accept/contour_evidence.h"
#include "core/base/arena.h"
#include "core/base/fixed_list.h"
#include "core/refine/outline_refinement.h"
#include "core/render/edge_render.h"
#include "core/search/self_slides.h"
#include "core/search/view_edges.h"

namespace boresight {

/// A pose other than the one found that shows about the same edges, refined on the image.
struct CompetingPose {
  Pose camera_from_station;  ///< refined; for the mirror image, the pose found
  double similarity = 0.0;   ///< share of the rendered edges that both poses have in common
  /// Evidence of the pose found minus that of this pose, over the edges that only one of them
  /// predicts.
  double margin_nats = 0.0;
  bool mirrored = false;  ///< of the mesh's mirror image
};

/// Finds poses that show about the same edges as the pose found: half turns about the principal
/// axes of the matched surface, the tilt of its flattest side reversed about the line of sight (the
/// second pose of a plane: Oberkampf et al. 1996), and slides at which the outline lies near edges
/// of its own render again (repeated features, long handles). Poses that the image supports about
/// as well at a small scale are refined on its edges and compared with the pose found where the
/// renders differ. A pose whose render is the same within some pixels of a small view does not
/// compete: in the image the mesh is symmetric.
class CompetingPoseTest {
 public:
  static constexpr int kTurned = 4;                               ///< turned poses that are tested
  static constexpr int kMostPoses = kTurned + SelfSlides::kMost;  ///< poses that are tested
  static constexpr int kLongestView_px = 312;                     ///< of views
  static constexpr int kMaxEdgePixels = 12000;                    ///< of renders

  /// Takes the memory from `arena`, for images of up to `channels` channels. kArenaTooSmall.
  Status create(int channels, Arena& arena);
  /// The data of the problem and the renderer (for images of kLongestView_px) must outlive the
  /// steps. False when the scene is outside the image.
  [[nodiscard]] bool begin(const SearchProblem& problem, const Pose& camera_from_station,
                           EdgeRenderer& renderer);
  /// One bounded slice; true when poses() is complete.
  [[nodiscard]] bool step();

  /// The competing poses whose renders differ visibly.
  std::span<const CompetingPose> poses() const { return competing_.items(); }
  /// Adds a pose found by a separate search.
  void add(const CompetingPose& pose) { competing_.add(pose); }

 private:
  enum class Phase : std::uint8_t { kView = 0, kSlides, kRender, kCompare, kDone };
  /// Processing of a completed render.
  enum class Purpose : std::uint8_t { kFound = 0, kScreen, kRefine, kCompeting, kFoundAgain };

  /// Edge places that a pose predicts, and the image's evidence for those that only this pose
  /// predicts.
  struct Prediction {
    DirectedEdges marks;     ///< places of the render, by direction
    std::int32_t all = 0;    ///< places that the image shows
    std::int32_t alone = 0;  ///< of these, not predicted by the other pose
    double nats = 0.0;       ///< evidence of the places predicted alone
    double share() const { return all > 0 ? static_cast<double>(alone) / all : 0.0; }
  };

  using PoseList = FixedList<Pose, kMostPoses>;

  void beginView(double span_px, Purpose purpose);
  void beginRender(const Pose& view_from_station, Purpose purpose);
  void stepRender();
  void takeRender();
  void takeFound();
  void stepSlides();
  void nextHypothesis();
  void nextPromising();
  void refine();
  double rankOfRender();
  void markRender(DirectedEdges& marks) const;
  void addAlone(const DirectedEdges& others, Prediction& prediction);
  void compareDirection();
  void conclude();
  double slid_px(const Pose& camera_from_station) const;
  PosePrior priorOf(const Pose& view_from_station) const;

  SearchProblem problem_;
  EdgeRenderer* renderer_ = nullptr;
  Pose found_;  ///< camera_from_station
  ViewEdges view_edges_;
  EdgeRender render_;
  OutlineRefinement refinement_;
  ContourEvidenceMeter meter_;
  SelfSlides slides_;
  Prediction own_, other_;            ///< of the pose found, of the competing one
  std::span<std::uint8_t> distance_;  ///< to the image's edges
  std::span<std::uint8_t> apart_;     ///< to the other pose's places

  Phase phase_ = Phase::kDone;
  Purpose purpose_ = Purpose::kFound;
  bool rendering_ = false;
  int scale_ = 0;
  int direction_ = 0;  ///< compared next
  double found_rank_nats_ = 0.0;
  PoseList poses_;  ///< hypotheses, in the view
  int hypothesis_ = 0;
  bool refined_ = false;  ///< the hypothesis, at the first scale
  Pose current_;          ///< view_from_station of the current hypothesis
  PoseList promising_;    ///< hypotheses that the image supports, in the view
  int competitor_ = 0;    ///< of the promising ones

  FixedList<CompetingPose, kMostPoses + 2> competing_;
};

}  // namespace boresight
