// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <QMenu>
#include <QString>
#include <QWidget>

#include "ui_annotation_panel.h"

#include "sessions/io/datasets/dataset_file.h"
#include "sessions/session/pose_comparer.h"
#include "ui/annotation/annotation_controller.h"
#include "ui/models/annotations_model.h"

namespace boresight::ui {

class Document;
class StationSnapper;

/// A pose to compare with the annotated pose.
struct ComparedPose {
  QString name;
  Pose camera_from_station;
};

/// "Solved from 8 annotations, 0.21 px rms.", or why there is no pose.
QString solutionHeadline(const AnnotationAnswer& answer, bool stale);

/// "Geometry: all in one plane, all at one depth.": weaknesses of the annotations in a few words,
/// shown before and after solving.
QString geometryMeterText(const AnnotationAnswer& answer);

/// Further details of a solution: weaknesses of the annotations, one sigma against the requirement,
/// both poses of a plane, residuals per camera, and the distances to other poses (seed, run, truth)
/// and rounds. Colour is never the only indication.
QString solutionHtml(const AnnotationAnswer& answer, const std::vector<ComparedPose>& others,
                     const sessions::PoseComparer& comparer = {});

/// Panel for annotating: tools, the table of annotations, and the quality of the solved pose.
class AnnotationPanel : public QWidget {
  Q_OBJECT

 public:
  AnnotationPanel(Document& document, AnnotationController& controller, ViewState& state,
                  QWidget* parent = nullptr);

  /// The menu of annotations and poses from and to files; to be filled.
  QMenu& filesMenu() { return *ui_.annotationFiles->menu(); }
  /// Sets the snapper that names the points of the station.
  void setSnapper(const StationSnapper& snapper);
  /// Adds a widget next to the summary, shown when it has contents.
  void addBeside(QWidget* widget);
  /// Asks for the annotator's name, and stores the annotations as a round.
  void askForName();

 Q_SIGNALS:
  void openCaseRequested(const QString& case_id);
  void openLandmarksRequested();
  void saveLandmarksRequested();
  /// Requests the keyboard focus for the image.
  void imageRequested();
  /// The case of a dialog is no longer shown; one sentence.
  void failed(const QString& message);

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
  void fillLandmarks();
  void fillRounds();
  void fillRig();
  void addLinks(QMenu& menu, const sessions::SessionCase& shown,
                const sessions::SessionCase& other);
  void askForPose(const std::string& other_id);
  void chooseRow(const QModelIndex& current);
  bool pressArrow(const QKeyEvent& key);
  std::vector<ComparedPose> otherPoses() const;

  Document& document_;
  AnnotationController& controller_;
  ViewState& state_;
  AnnotationsModel model_;
  RowsFilter filter_;
  bool showing_ = false;
  Ui::AnnotationPanel ui_;
};

}  // namespace boresight::ui
