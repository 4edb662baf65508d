// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include <QObject>
#include <QString>
#include <QTimer>

#include "sessions/session/case_marks.h"
#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

class Document;

/// What a click on the image or the station does.
enum class PlaceMode : std::uint8_t {
  kOff,    ///< nobody annotates: clicks belong to the views
  kPoint,  ///< one side of a pair of points
  kLine,   ///< one side of a pair of lines: two clicks on the image, one on an edge of the station
};

/// What somebody annotates: the marks of the current case, the one that is chosen, the pair that is
/// half made, and the pose that solves them. Views tell it where somebody pointed; it edits the
/// document, by names that Undo shows, and has the pose solved anew after each edit, off the UI's
/// thread. Nothing here is computed: what a place snaps to and what a pose is, sessions/ says.
class AnnotationController : public QObject {
  Q_OBJECT

 public:
  using SolutionPtr = std::shared_ptr<const sessions::CaseMarksSolution>;

  AnnotationController(Document& document, ViewState& state, QObject* parent = nullptr);
  ~AnnotationController() override;

  PlaceMode mode() const { return mode_; }
  /// Of the current case; with a gesture's unfinished move (`dragInImage`) in it.
  const sessions::Marks& marks() const { return marks_; }
  /// Id of the chosen mark, or empty. A chosen half-made pair is what the next click completes.
  const std::string& selected() const { return selected_; }
  const sessions::PointPair* selectedPoint() const;
  const sessions::LinePair* selectedLine() const;
  /// The latest solution of this case, or nullptr before the first.
  const SolutionPtr& solution() const { return solution_; }
  /// The marks have changed since that solution was asked for.
  bool stale() const { return stale_; }
  /// The solved pose of the current case, stale or not; nothing where there is none.
  std::optional<Pose> solvedPose() const;
  bool robust() const { return robust_; }
  /// Standard deviation that new marks get, px per axis.
  double sigma_px() const { return sigma_px_; }
  /// Places that named points of the station should have in this image, to be confirmed.
  const std::vector<sessions::Proposal>& proposals() const { return proposals_; }

  void setMode(PlaceMode mode);
  void select(const std::string& id);
  void setRobust(bool robust);
  void setSigma(double sigma_px);

  /// A place of the image, pixel centres at whole numbers: completes the chosen half-made pair if
  /// it lacks this side, else begins a new one. Returns the mark's id; empty when it was refused.
  std::string placeInImage(const Eigen::Vector2d& pixel);
  std::string placeOnStation(const Eigen::Vector3d& point_in_station_m);
  std::string placeLineInImage(const sessions::ImageLine& line);
  std::string placeEdgeOnStation(const sessions::ModelEdge& edge);

  /// Moves a mark's place in the image (of a line: `end` 0 or 1) without an edit of the document,
  /// until `finishMove` makes it one. Locked marks do not move: false.
  bool dragInImage(const std::string& id, const Eigen::Vector2d& pixel, int end = 0);
  void finishMove();
  /// The chosen mark by so much, several within a second being one step of Undo.
  bool nudge(const Eigen::Vector2d& by_px, int end = 0);
  /// Replaces a mark as a whole (table edits); `text` is what Undo says.
  void replacePoint(const sessions::PointPair& point, const QString& text);
  void replaceLine(const sessions::LinePair& line, const QString& text);
  void remove(const std::string& id);
  void setMarks(const sessions::Marks& marks, const QString& text);
  /// Takes a proposal as a pair whose place in the image is where it was predicted.
  void confirm(const sessions::Proposal& proposal);
  /// Gives a proposal's station side to a new half-made pair, whose place in the image is clicked
  /// next.
  void begin(const sessions::Proposal& proposal);

 Q_SIGNALS:
  void modeChanged();
  void marksChanged();  ///< any of them, also during a gesture
  void selectionChanged();
  void solutionChanged();  ///< also when it goes stale
  void proposalsChanged();
  /// One sentence for people: what was refused, and what to do.
  void told(const QString& sentence);
};

}  // namespace boresight::ui
