// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <QObject>
#include <QString>
#include <QTimer>

#include "sessions/annotation/annotation_round.h"
#include "sessions/annotation/landmarks.h"
#include "sessions/review/annotation_concern.h"
#include "sessions/session/case_annotations.h"
#include "sessions/session/case_run.h"
#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

class Document;

/// What a click on the image or the station does.
enum class PlaceMode : std::uint8_t {
  kOff,    ///< annotating is off: clicks belong to the views
  kPoint,  ///< one side of a pair of points
  kLine,   ///< one side of a pair of lines: two clicks on the image, one on an edge of the station
};

/// What the solver of annotations is asked.
struct AnnotationQuestion {
  sessions::CaseAnnotations annotations;
  std::shared_ptr<const sessions::LoadedCase> one;
  Pose camera_from_station_guess;
  std::vector<sessions::Landmark> landmarks;
  sessions::AnnotationRounds rounds;
  bool robust = false;
  double sigmas = 3.0;  ///< that must fit into the requirement
  bool blind = false;   ///< nothing is solved
};

/// An earlier annotation round over the same image, next to the current annotations.
struct RoundAnswer {
  std::string by;
  std::string time;
  std::optional<Pose> camera_from_station;
  sessions::Repeatability repeatability;  ///< annotations at work minus the round
};

struct AnnotationAnswer {
  std::shared_ptr<const sessions::CaseAnnotationsSolution> solution;
  std::vector<sessions::Proposal> proposals;     ///< where landmarks should be, to be confirmed
  std::vector<RoundAnswer> rounds;               ///< of other annotators of this case
  std::optional<Matrix6d> covariance;            ///< of the case's camera, in its own frame
  std::optional<sessions::PoseQuality> quality;  ///< of the pose
  sessions::AnnotationConcern concern;
  bool blind = false;  ///< a blind round is under way: there is no solution
};

/// What the operator annotates: the annotations of the current case, the one that is chosen, the
/// pair that is half made, and the pose that solves them. Views tell it where the operator pointed;
/// it edits the document, by names that Undo shows, and has the pose solved again after each edit,
/// off the UI's thread. Nothing here is computed: what a place snaps to and what a pose is,
/// sessions/ says.
class AnnotationController : public QObject {
  Q_OBJECT

 public:
  using SolutionPtr = std::shared_ptr<const sessions::CaseAnnotationsSolution>;
  static constexpr double kSigma_px = 0.3;  ///< of a place clicked with care under the loupe
  static constexpr int kPause_ms = 800;     ///< nudges within this are one step of Undo

  AnnotationController(Document& document, ViewState& state, QObject* parent = nullptr);

  PlaceMode mode() const { return mode_; }
  /// Of the current case; with a gesture's unfinished move (`dragInImage`) in it.
  const sessions::Annotations& annotations() const { return annotations_; }
  /// Id of the chosen annotation, or empty. A chosen half-made pair is what the next click
  /// completes.
  const std::string& selected() const { return selected_; }
  const sessions::PointPair* selectedPoint() const;
  const sessions::LinePair* selectedLine() const;
  /// The latest solution of this case, or nullptr before the first.
  const SolutionPtr& solution() const { return answer_.solution; }
  /// The annotations have changed since that solution was asked for.
  bool stale() const { return stale_; }
  /// The solved pose of the current case, stale or not; nothing where there is none.
  std::optional<Pose> solvedPose() const;
  const AnnotationAnswer& answer() const { return answer_; }
  bool robust() const { return robust_; }
  /// The other cases of the rig are solved with this one.
  bool together() const { return together_; }
  /// Standard deviation that new annotations get, px per axis.
  double sigma_px() const { return sigma_px_; }
  /// Named points of the station, from the case's file of landmarks.
  const std::vector<sessions::Landmark>& landmarks() const { return landmarks_; }

  void setMode(boresight::ui::PlaceMode mode);
  void select(const std::string& id);
  void setRobust(bool robust);
  void setTogether(bool together);
  void setSigma(double sigma_px);

  /// A place of the image, pixel centres at whole numbers: completes the chosen half-made pair if
  /// it lacks this side, else begins a new one. Returns the annotation's id; empty when it was
  /// refused.
  std::string placeInImage(const Eigen::Vector2d& pixel);
  std::string placeOnStation(const Eigen::Vector3d& point_in_station_m);
  std::string placeLineInImage(const sessions::ImageLine& line);
  std::string placeEdgeOnStation(const sessions::ModelEdge& edge);

  /// Moves an annotation's place in the image (of a line: `end` 0 or 1) without an edit of the
  /// document, until `finishMove` makes it one. Locked annotations do not move: false.
  bool dragInImage(const std::string& id, const Eigen::Vector2d& pixel, int end = 0);
  void finishMove();
  /// The chosen annotation by so much; nudges in one go are one step of Undo.
  bool nudge(const Eigen::Vector2d& by_px, int end = 0);
  /// Replaces the annotation of id `replaced` (edits of the table; the id may change); `text` is
  /// what Undo says. False when it was refused.
  bool replacePoint(const std::string& replaced, const sessions::PointPair& point,
                    const QString& text);
  bool replaceLine(const std::string& replaced, const sessions::LinePair& line,
                   const QString& text);
  void remove(const std::string& id);
  void setAnnotations(const sessions::Annotations& annotations, const QString& text);
  /// Annotations a proposal at the place of the image where the operator sees it: the prediction
  /// alone would be no measurement.
  void confirm(const sessions::Proposal& proposal, const Eigen::Vector2d& pixel);
  /// Proposals that nothing of the station hides.
  int seenProposals() const;
  /// Annotations those of them that the image shows a corner or an ellipse of where they should be,
  /// as one step of Undo, and tells how many are left to be placed by hand.
  void confirmSeen();
  /// Gives a proposal's station side to a new half-made pair, whose place in the image is clicked
  /// next.
  void begin(const sessions::Landmark& landmark);

  /// Keeps the annotations as this person's round and begins a blind one: the same places of the
  /// station, nothing on the image.
  void putAside(const QString& by);
  /// The annotations at work become those of a round; nothing is lost, Undo brings them back.
  void takeUp(int round);
  void removeRound(int round);
  /// The solved pose becomes the case's truth.
  void useAsTruth();
  /// The solved pose becomes the case's seed, with three sigma as its uncertainty.
  void useAsSeed();
  /// Solves another case with this one from now on, as images of cameras that are rigidly linked.
  void linkCase(const std::string& other_id, const Pose& other_from_case);
  void unlinkCase();
  /// Named points from a file, for all cases of this station.
  void setLandmarksFile(const std::filesystem::path& file);

 Q_SIGNALS:
  void modeChanged();
  void annotationsChanged();  ///< any of them, also during a gesture
  void selectionChanged();
  void solutionChanged();  ///< also when it goes stale; proposals and rounds with it
  /// One sentence for the operator: what was refused, and what to do.
  void told(const QString& sentence);

 private:
  void showDocument();
  void showLandmarks();
  void askIfChanged(bool anyway);
  void take(const AnnotationAnswer& answer);
  bool commit(const sessions::Annotations& annotations, const QString& text);
  template <class Pair, class Side>
  std::string place(const Pair* chosen, std::optional<Side> Pair::*side, const Side& value,
                    const QString& text);
  bool mayChange(const std::string& id);
  template <class Pair>
  bool replace(const Pair* before, const Pair& after, const QString& text);
  bool mayReplace(const std::string& replaced, const std::string& id);
  sessions::PointPair annotationOf(const sessions::Landmark& landmark) const;
  sessions::AnnotationRounds roundsOfCase() const;
  void setRounds(sessions::AnnotationRounds rounds, const sessions::Annotations& annotations,
                 const QString& text);

  Document& document_;
  ViewState& state_;
  PlaceMode mode_ = PlaceMode::kOff;
  std::string case_id_;
  sessions::Annotations annotations_;
  std::string selected_;
  bool moving_ = false;  ///< a gesture whose edit has not been made
  QTimer pause_;         ///< ends a row of nudges
  AnnotationAnswer answer_;
  std::optional<AnnotationQuestion> asked_;
  bool stale_ = false;
  bool robust_ = false;
  bool together_ = true;
  double sigma_px_ = kSigma_px;
  std::optional<std::filesystem::path> landmarks_file_;
  std::vector<sessions::Landmark> landmarks_;
  TaskRunner runner_;  ///< solves; the newest annotations count
};

}  // namespace boresight::ui
