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

/// Effect of a click on the image or the station.
enum class PlaceMode : std::uint8_t {
  kOff,    ///< annotating is off: the views handle clicks
  kPoint,  ///< one side of a pair of points
  kLine,   ///< one side of a pair of lines: two clicks on the image, one on an edge of the station
};

/// Input of solving annotations.
struct AnnotationQuestion {
  sessions::CaseAnnotations annotations;
  std::shared_ptr<const sessions::LoadedCase> one;
  Pose camera_from_station_guess;
  std::vector<sessions::Landmark> landmarks;
  sessions::AnnotationRounds rounds;
  bool blind = false;  ///< nothing is solved

  bool operator==(const AnnotationQuestion&) const = default;
};

/// An earlier annotation round over the same image, next to the current annotations.
struct RoundAnswer {
  std::string by;
  std::string time;
  std::optional<Pose> camera_from_station;
  sessions::Repeatability repeatability;  ///< current annotations minus the round
};

struct AnnotationAnswer {
  std::shared_ptr<const sessions::CaseAnnotationsSolution> solution;
  std::vector<sessions::Proposal> proposals;     ///< predicted landmarks, to be confirmed
  std::vector<RoundAnswer> rounds;               ///< of other annotators of this case
  std::optional<Matrix6d> covariance;            ///< of the case's camera, in its own frame
  std::optional<sessions::PoseQuality> quality;  ///< of the pose
  sessions::AnnotationConcern concern;
  bool blind = false;  ///< a blind round is under way: there is no solution
};

/// State of annotating: the annotations of the current case, the selected annotation, the
/// incomplete pair, and the solved pose. Views report where the operator pointed; the controller
/// edits the document, with names for Undo, and solves the pose again after each edit on a worker
/// thread. Snapping and solving are computed in sessions/.
class AnnotationController : public QObject {
  Q_OBJECT

 public:
  using SolutionPtr = std::shared_ptr<const sessions::CaseAnnotationsSolution>;
  static constexpr double kSigma_px = 0.3;  ///< of a position clicked carefully under the loupe
  static constexpr int kPause_ms = 800;     ///< nudges within this time are one step of Undo

  AnnotationController(Document& document, ViewState& state, QObject* parent = nullptr);

  PlaceMode mode() const { return mode_; }
  /// Annotations of the current case, including an unfinished move (dragInImage()).
  const sessions::Annotations& annotations() const { return annotations_; }
  /// Id of the selected annotation, or empty. The next click completes a selected incomplete pair.
  const std::string& selected() const { return selected_; }
  const sessions::PointPair* selectedPoint() const;
  const sessions::LinePair* selectedLine() const;
  /// Image position of the selected annotation (of a line: of `end` 0 or 1), if it has one.
  std::optional<Eigen::Vector2d> selectedPixel(int end = 0) const;
  /// The latest solution of this case, or nullptr before the first.
  const SolutionPtr& solution() const { return answer_.solution; }
  /// Whether the annotations have changed since that solution was requested.
  bool stale() const { return stale_; }
  /// The solved pose of the current case, stale or not; empty where there is none.
  std::optional<Pose> solvedPose() const;
  const AnnotationAnswer& answer() const { return answer_; }
  bool robust() const;
  /// Whether the other cases of the rig are solved with this one.
  bool together() const { return together_; }
  /// Standard deviation of new annotations, px per axis.
  double sigma_px() const { return sigma_px_; }
  /// Named points of the station, from the case's file of landmarks.
  const std::vector<sessions::Landmark>& landmarks() const { return landmarks_; }

  void setMode(boresight::ui::PlaceMode mode);
  void select(const std::string& id);
  void setRobust(bool robust);
  void setTogether(bool together);
  void setSigma(double sigma_px);

  /// Sets an image position (pixel centres at integers): completes the selected pair if it lacks
  /// this side, else begins a new one. Returns the annotation's id; empty when it was rejected.
  std::string placeInImage(const Eigen::Vector2d& pixel);
  std::string placeOnStation(const Eigen::Vector3d& point_in_station_m);
  std::string placeLineInImage(const sessions::ImageLine& line);
  std::string placeEdgeOnStation(const sessions::ModelEdge& edge);

  /// Moves an annotation's image position (of a line: `end` 0 or 1); finishMove() makes it an edit
  /// of the document. Returns false for locked annotations, which do not move.
  bool dragInImage(const std::string& id, const Eigen::Vector2d& pixel, int end = 0);
  void finishMove();
  /// Shows the document's annotations again instead of an unfinished move.
  void cancelMove();
  /// Moves the selected annotation; nudges in quick succession are one step of Undo.
  bool nudge(const Eigen::Vector2d& by_px, int end = 0);
  /// Replaces the annotation of id `replaced` (edits of the table; the id may change); `text` is
  /// shown by Undo. False when it was rejected.
  bool replacePoint(const std::string& replaced, const sessions::PointPair& point,
                    const QString& text);
  bool replaceLine(const std::string& replaced, const sessions::LinePair& line,
                   const QString& text);
  void remove(const std::string& id);
  void setAnnotations(const sessions::Annotations& annotations, const QString& text);
  /// Annotates a proposal at the image position where the operator sees it: the prediction alone
  /// would not be a measurement.
  void confirm(const sessions::Proposal& proposal, const Eigen::Vector2d& pixel);
  /// Number of proposals that the station does not hide.
  int seenProposals() const;
  /// Annotates the seen proposals where the image shows a corner or an ellipse near the prediction,
  /// as one step of Undo; reports the number left to place by hand.
  void confirmSeen();
  /// Begins a new pair with the landmark's station side; its image position is clicked next.
  void begin(const sessions::Landmark& landmark);

  /// Stores the annotations as this annotator's round and begins a blind one: the same points of
  /// the station, without image positions.
  void putAside(const QString& by);
  /// Loads a round as the current annotations; Undo restores the former ones.
  void takeUp(int round);
  void removeRound(int round);
  /// Makes the solved pose the case's truth.
  void useAsTruth();
  /// Makes the solved pose the case's seed, with three sigma as its uncertainty.
  void useAsSeed();
  /// Solves another case with this one from now on, as images of cameras that are rigidly linked.
  void linkCase(const std::string& other_id, const Pose& other_from_case);
  void unlinkCase();
  /// Sets the file of named points, for all cases of this station. Returns whether it is in effect.
  bool setLandmarksFile(const std::filesystem::path& file);

 Q_SIGNALS:
  void modeChanged();
  void annotationsChanged();  ///< any annotation, also during a gesture
  void selectionChanged();
  void solutionChanged();  ///< also when it becomes stale; includes proposals and rounds
  /// One sentence for the operator: the rejection and a remedy.
  void told(const QString& sentence);

 private:
  void documentOpened();
  void leaveCase(const std::string& next_id);
  void endMove();
  void showDocument();
  void showLandmarks();
  void askIfChanged(bool anyway);
  void take(const AnnotationAnswer& answer);
  bool commit(const sessions::Annotations& annotations, const QString& text);
  template <class Pair, class Side>
  std::string place(const Pair* chosen, std::optional<Side> Pair::*side, const Side& value,
                    const QString& text);
  template <class Pair>
  bool put(const Pair& pair, const QString& text);
  const sessions::SessionCase* finishMoveAndFindSolvedCase();
  bool mayChange(const std::string& id);
  template <class Pair>
  bool replace(const Pair* before, const Pair& after, const QString& text);
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
  QTimer pause_;         ///< ends a sequence of nudges
  AnnotationAnswer answer_;
  std::optional<AnnotationQuestion> asked_;
  bool stale_ = false;
  bool together_ = true;
  double sigma_px_ = kSigma_px;
  std::optional<std::filesystem::path> landmarks_file_;
  std::vector<sessions::Landmark> landmarks_;
  TaskRunner runner_;
  TaskKind solving_;
};

}  // namespace boresight::ui
