// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <QMenu>
#include <QString>
#include <QWidget>

#include "ui/annotation/annotation_controller.h"
#include "ui/annotation/solution_html.h"
#include "ui/models/marks_model.h"

class QBoxLayout;
class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSplitter;
class QTableView;
class QTextBrowser;
class QToolButton;

namespace boresight::ui {

class Document;

/// The station's named points that this image has no mark of: where they should be is confirmed,
/// or one is begun by name and then clicked. Also where landmarks come from and go to.
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

/// The annotator's desk: tools, the table of marks, and what the pose that solves them is worth.
class AnnotationPanel : public QWidget {
  Q_OBJECT

 public:
  AnnotationPanel(Document& document, AnnotationController& controller, ViewState& state,
                  QWidget* parent = nullptr);

  QTableView& table() { return *table_; }
  /// Something beside the summary that shows itself when it has something to show.
  void addBeside(QWidget* widget);
  /// Asks whose marks these are, and puts them aside.
  void askForName();

 Q_SIGNALS:
  void openCaseRequested(const QString& case_id);
  void useAsSeedRequested(const boresight::Pose& camera_from_station);
  void importRequested();
  void exportRequested();
  void exportColmapRequested();
  void exportBopRequested();
  void importColmapRequested();
  void importBopRequested();
  void openLandmarksRequested();
  void saveLandmarksRequested();
  /// Keys go to the image from now on.
  void imageRequested();

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void buildTools(QBoxLayout& layout, RigMenu* rig);
  QToolButton* toolButton(const char* name, const QString& text, const QString& tip);
  QToolButton* menuButton(const char* name, const QString& text, const QString& tip, QMenu* menu);
  QWidget* buildTable();
  QWidget* buildSummary();
  QToolButton* modeButton(const char* name, const QString& text, const QString& tip,
                          PlaceMode mode);
  QMenu* fileMenu();
  void showMode();
  void showMarks();
  void showSelection();
  void showSolution();
  void showPasses();
  void chooseRow(const QModelIndex& current);
  std::vector<ComparedPose> otherPoses() const;

  AnnotationController& controller_;
  ViewState& state_;
  MarksModel model_;
  RowsFilter filter_;
  bool showing_ = false;
  QSplitter* splitter_ = nullptr;
  QToolButton* points_ = nullptr;
  QToolButton* lines_ = nullptr;
  QDoubleSpinBox* sigma_ = nullptr;
  QCheckBox* robust_ = nullptr;
  QCheckBox* together_ = nullptr;
  QToolButton* passes_ = nullptr;
  QComboBox* show_ = nullptr;
  QLabel* count_ = nullptr;
  QTableView* table_ = nullptr;
  QLabel* headline_ = nullptr;
  QLabel* meter_ = nullptr;
  QTextBrowser* summary_ = nullptr;
  QPushButton* use_as_truth_ = nullptr;
  QPushButton* use_as_seed_ = nullptr;
};

}  // namespace boresight::ui
