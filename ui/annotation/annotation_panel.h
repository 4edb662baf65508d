// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <QMenu>
#include <QString>
#include <QWidget>

#include "ui_annotation_panel.h"

#include "sessions/io/datasets/dataset_file.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/models/annotations_model.h"

namespace boresight::ui {

class Document;
class StationSnapper;

/// A pose that the annotated one is compared with.
struct ComparedPose {
  QString name;
  Pose camera_from_station;
};

/// "Solved from 8 annotations, 0.21 px rms.", or why there is no pose.
QString solutionHeadline(const AnnotationAnswer& answer, bool stale);

/// "Geometry: all in one plane, all at one depth.": what of the annotations is weak, in a few words
/// that stand there before and after solving.
QString geometryMeterText(const AnnotationAnswer& answer);

/// Everything else that an annotator reads of a solution: what is weak in the annotations, one
/// sigma against the requirement, the second pose of a plane next to the first, residuals per
/// camera, and how far the other poses (seed, run, truth) and rounds are. Colour never says
/// anything alone.
QString solutionHtml(const AnnotationAnswer& answer, const std::vector<ComparedPose>& others);

/// The station's named points that this image has no annotation of: where they should be is
/// confirmed, or one is begun by name and then clicked. Also where landmarks come from and go to.
class LandmarksMenu : public QMenu {
  Q_OBJECT

 public:
  explicit LandmarksMenu(AnnotationController& controller, QWidget* parent = nullptr);

 Q_SIGNALS:
  void openRequested();
  void saveRequested();

 private:
  void fill();

  AnnotationController& controller_;
};

/// Which cases are solved together with the shown one: lists them, opens one, links and unlinks.
class RigMenu : public QMenu {
  Q_OBJECT

 public:
  RigMenu(Document& document, ViewState& state, AnnotationController& controller,
          QWidget* parent = nullptr);

 Q_SIGNALS:
  void openRequested(const QString& case_id);

 private:
  void fill();
  void addLinks(QMenu& menu, const sessions::SessionCase& shown,
                const sessions::SessionCase& other);
  void askForPose(const std::string& other_id);

  Document& document_;
  ViewState& state_;
  AnnotationController& controller_;
};

/// The annotator's desk: tools, the table of annotations, and what the pose that solves them is
/// worth.
class AnnotationPanel : public QWidget {
  Q_OBJECT

 public:
  AnnotationPanel(Document& document, AnnotationController& controller, ViewState& state,
                  QWidget* parent = nullptr);

  QTableView& table();
  /// The menu of annotations and poses from and to files; to be filled.
  QMenu& filesMenu() { return *files_menu_; }
  LandmarksMenu& landmarksMenu() { return *landmarks_menu_; }
  /// Knows what the places of the station are.
  void setSnapper(const StationSnapper& snapper);
  /// A widget next to the summary, shown when it has contents.
  void addBeside(QWidget* widget);
  /// Asks whose annotations these are, and puts them aside.
  void askForName();

 Q_SIGNALS:
  void openCaseRequested(const QString& case_id);
  /// Keys go to the image from now on.
  void imageRequested();

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void buildTable();
  void connectTools();
  void showMode();
  void showAnnotations();
  void showSelection();
  void showSolution();
  void showRounds();
  void chooseRow(const QModelIndex& current);
  bool pressArrow(const QKeyEvent& key);
  std::vector<ComparedPose> otherPoses() const;

  AnnotationController& controller_;
  ViewState& state_;
  AnnotationsModel model_;
  RowsFilter filter_;
  QMenu* files_menu_;
  LandmarksMenu* landmarks_menu_;
  bool showing_ = false;
  Ui::AnnotationPanel ui_;
};

}  // namespace boresight::ui
