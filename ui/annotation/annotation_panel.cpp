// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_panel.h"

#include <algorithm>

#include <QtWidgets>

#include "sessions/annotation/marks.h"
#include "sessions/session/rig_links.h"
#include "ui/models/number_text.h"
#include "ui/panels/paste_pose_dialog.h"
#include "ui/panels/widgets.h"
#include "ui/state/document.h"

namespace boresight::ui {

LandmarksMenu::LandmarksMenu(AnnotationController& controller, QWidget* parent)
    : QMenu(parent), controller_(controller) {
  connect(this, &QMenu::aboutToShow, this, &LandmarksMenu::fill);
  fill();
}

void LandmarksMenu::fill() {
  clear();
  addAction(tr("Open ..."), this, &LandmarksMenu::openRequested);
  addAction(tr("Save the marks as landmarks ..."), this, &LandmarksMenu::saveRequested);
  addSeparator();
  QAction* confirm =
      addAction(tr("Mark all that the image shows (%1)").arg(controller_.seenProposals()),
                &controller_, &AnnotationController::confirmSeen);
  confirm->setEnabled(controller_.seenProposals() > 0);
  addSeparator();
  bool any = false;
  for (const sessions::Landmark& landmark : controller_.landmarks()) {
    if (sessions::findPoint(controller_.marks(), landmark.name)) continue;
    any = true;
    QAction* begin = addAction(tr("Begin %1").arg(fromText(landmark.name)), this, [this, landmark] {
      controller_.setMode(PlaceMode::kPoint);
      controller_.begin(landmark);
    });
    begin->setToolTip(fromText(landmark.comment));
  }
  if (!any)
    addAction(controller_.landmarks().empty() ? tr("No landmarks are open")
                                              : tr("Every landmark has a mark here"))
        ->setEnabled(false);
}

RigMenu::RigMenu(Document& document, ViewState& state, AnnotationController& controller,
                 QWidget* parent)
    : QMenu(parent), document_(document), state_(state), controller_(controller) {
  connect(this, &QMenu::aboutToShow, this, &RigMenu::fill);
}

void RigMenu::fill() {
  clear();
  const sessions::Session& session = document_.session();
  const ViewState::CasePtr& one = state_.currentCase();
  const sessions::SessionCase* shown = one ? session.findCase(one->source.id) : nullptr;
  if (!shown) {
    addAction(tr("No case is open"))->setEnabled(false);
    return;
  }
  const std::vector<std::string> linked = sessions::casesOfRig(session, shown->id);
  for (const std::string& id : linked)
    addAction(tr("Go to %1").arg(fromText(id)), this,
              [this, id] { Q_EMIT openRequested(fromText(id)); });
  if (!linked.empty()) {
    addAction(tr("Take %1 out of this rig").arg(fromText(shown->id)), &controller_,
              &AnnotationController::unlinkCase);
    addSeparator();
  }
  QMenu* links = addMenu(tr("Link with"));
  for (const auto& other : session.cases)
    if (other->id != shown->id && other->station == shown->station &&
        std::find(linked.begin(), linked.end(), other->id) == linked.end())
      addLinks(*links->addMenu(fromText(other->id)), *shown, *other);
  if (links->isEmpty()) links->addAction(tr("No other case of this station"))->setEnabled(false);
}

void RigMenu::addLinks(QMenu& menu, const sessions::SessionCase& shown,
                       const sessions::SessionCase& other) {
  const std::string id = other.id;
  menu.addAction(tr("The same camera, not moved"), this,
                 [this, id] { controller_.linkCase(id, Pose()); });
  if (const auto other_from_shown = sessions::linkOfTruths(shown, other))
    menu.addAction(tr("As the true poses say"), this,
                   [this, id, link = *other_from_shown] { controller_.linkCase(id, link); });
  menu.addAction(tr("By a pose from the clipboard ..."), this, [this, id] { askForPose(id); });
}

void RigMenu::askForPose(const std::string& other_id) {
  PastePoseDialog dialog(QGuiApplication::clipboard()->text(), this);
  dialog.setWindowTitle(
      tr("Pose of %1 from the shown camera: p_other = R p_shown + t").arg(fromText(other_id)));
  if (dialog.exec() == QDialog::Accepted && dialog.parsed().valid)
    controller_.linkCase(other_id, dialog.parsed().camera_from_station);
}

AnnotationPanel::AnnotationPanel(Document& document, AnnotationController& controller,
                                 ViewState& state, QWidget* parent)
    : QWidget(parent), controller_(controller), state_(state) {
  filter_.setSourceModel(&model_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  auto* rig = new RigMenu(document, state, controller, this);
  connect(rig, &RigMenu::openRequested, this, &AnnotationPanel::openCaseRequested);
  buildTools(*column, rig);
  splitter_ = new QSplitter(Qt::Horizontal, this);
  splitter_->addWidget(buildTable());
  splitter_->addWidget(buildSummary());
  splitter_->setStretchFactor(0, 1);
  splitter_->setStretchFactor(1, 1);
  splitter_->setChildrenCollapsible(false);
  splitter_->setSizes({500, 400});
  column->addWidget(splitter_, 1);
  connect(&controller_, &AnnotationController::modeChanged, this, &AnnotationPanel::showMode);
  connect(&controller_, &AnnotationController::marksChanged, this, &AnnotationPanel::showMarks);
  connect(&controller_, &AnnotationController::selectionChanged, this,
          &AnnotationPanel::showSelection);
  connect(&controller_, &AnnotationController::solutionChanged, this,
          &AnnotationPanel::showSolution);
  state_.onChange(
      ViewChange::kCase | ViewChange::kSnapshot | ViewChange::kCursor | ViewChange::kNudgedPose,
      this, &AnnotationPanel::showSolution);
  connect(&model_, &MarksModel::pointEdited, &controller_, &AnnotationController::replacePoint);
  connect(&model_, &MarksModel::lineEdited, &controller_, &AnnotationController::replaceLine);
  showMode();
  showMarks();
  showSolution();
}

QToolButton* AnnotationPanel::toolButton(const char* name, const QString& text,
                                         const QString& tip) {
  auto* button = named(new QToolButton(this), name, tip);
  button->setText(text);
  return button;
}

QToolButton* AnnotationPanel::modeButton(const char* name, const QString& text, const QString& tip,
                                         PlaceMode mode) {
  QToolButton* button = toolButton(name, text, tip);
  button->setCheckable(true);
  connect(button, &QToolButton::clicked, this, [this, mode](bool on) {
    controller_.setMode(on ? mode : PlaceMode::kOff);
    showMode();
  });
  return button;
}

QToolButton* AnnotationPanel::menuButton(const char* name, const QString& text, const QString& tip,
                                         QMenu* menu) {
  QToolButton* button = toolButton(name, text, tip);
  button->setPopupMode(QToolButton::InstantPopup);
  button->setMenu(menu);
  return button;
}

void AnnotationPanel::addBeside(QWidget* widget) {
  splitter_->addWidget(widget);
  splitter_->setStretchFactor(splitter_->count() - 1, 1);
  splitter_->setCollapsible(splitter_->count() - 1, false);
}

void AnnotationPanel::buildTools(QBoxLayout& layout, RigMenu* rig) {
  auto* row = new QHBoxLayout;
  row->setSpacing(3);
  points_ = modeButton("placePoints", tr("Points"),
                       tr("Click a place on the image and the same place on the station, in either "
                          "order (F2). Ctrl and a click on the rendered edges also marks the "
                          "station."),
                       PlaceMode::kPoint);
  lines_ = modeButton("placeLines", tr("Lines"),
                      tr("Click two places along an edge in the image, and the edge of the station "
                         "(F3)"),
                      PlaceMode::kLine);
  sigma_ = named(new QDoubleSpinBox(this), "newSigma");
  sigma_->setRange(0.01, 100.0);
  sigma_->setDecimals(2);
  sigma_->setSingleStep(0.1);
  sigma_->setValue(controller_.sigma_px());
  sigma_->setPrefix(QStringLiteral("\u00b1 "));
  sigma_->setSuffix(tr(" px"));
  sigma_->setMinimumWidth(
      sigma_->fontMetrics().horizontalAdvance(QStringLiteral("\u00b1 00.00 px")) + 30);
  sigma_->setToolTip(tr("Standard deviation that new marks are given, pixels per axis"));
  robust_ = named(new QCheckBox(tr("Robust"), this), "robust",
                  tr("Marks far from where the pose puts them count little or nothing"));
  together_ = named(new QCheckBox(tr("Whole rig"), this), "together",
                    tr("Solve with the other cameras of this case's rig, as one"));
  together_->setChecked(controller_.together());
  QToolButton* files =
      menuButton("markFiles", tr("Files"), tr("Marks and poses from and to files"), fileMenu());
  auto* landmarks_menu = new LandmarksMenu(controller_, this);
  connect(landmarks_menu, &LandmarksMenu::openRequested, this,
          &AnnotationPanel::openLandmarksRequested);
  connect(landmarks_menu, &LandmarksMenu::saveRequested, this,
          &AnnotationPanel::saveLandmarksRequested);
  QToolButton* landmarks =
      menuButton("landmarks", tr("Landmarks"),
                 tr("Named points of the station, used over all its images"), landmarks_menu);
  passes_ = menuButton("passes", tr("Passes"),
                       tr("What several people marked without seeing each other's marks"),
                       new QMenu(this));
  QToolButton* rigs = menuButton(
      "rig", tr("Rig"), tr("Which images are of rigidly linked cameras, solved as one"), rig);
  connect(passes_->menu(), &QMenu::aboutToShow, this, &AnnotationPanel::showPasses);
  for (QWidget* each : std::initializer_list<QWidget*>{points_, lines_, sigma_, robust_, together_,
                                                       files, landmarks, passes_, rigs})
    row->addWidget(each);
  row->addStretch(1);
  show_ = named(new QComboBox(this), "showMarks");
  show_->setAccessibleName(tr("Which marks are listed"));
  show_->addItems(MarksModel::showNames());
  // On a narrow window the row gives way here.
  show_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  show_->setMinimumContentsLength(3);
  count_ = new QLabel(this);
  count_->setMinimumWidth(1);
  row->addWidget(count_);
  row->addWidget(show_);
  layout.addLayout(row);
  connect(sigma_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), &controller_,
          &AnnotationController::setSigma);
  connect(robust_, &QCheckBox::toggled, &controller_, &AnnotationController::setRobust);
  connect(together_, &QCheckBox::toggled, &controller_, &AnnotationController::setTogether);
}

QMenu* AnnotationPanel::fileMenu() {
  auto* menu = new QMenu(this);
  menu->addAction(tr("Import marks ..."), this, &AnnotationPanel::importRequested);
  menu->addAction(tr("Export marks ..."), this, &AnnotationPanel::exportRequested);
  menu->addSeparator();
  menu->addAction(tr("Export all poses for COLMAP ..."), this,
                  &AnnotationPanel::exportColmapRequested);
  menu->addAction(tr("Export all poses as a BOP scene ..."), this,
                  &AnnotationPanel::exportBopRequested);
  menu->addAction(tr("Import truths from COLMAP ..."), this,
                  &AnnotationPanel::importColmapRequested);
  menu->addAction(tr("Import truths from a BOP scene ..."), this,
                  &AnnotationPanel::importBopRequested);
  return menu;
}

QWidget* AnnotationPanel::buildTable() {
  table_ = newTable("marks", tr("Marks"), filter_, this);
  table_->installEventFilter(this);
  table_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed);
  table_->setSortingEnabled(true);
  table_->sortByColumn(-1, Qt::AscendingOrder);
  connect(show_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this](int index) {
    filter_.setCondition([this, show = static_cast<MarksModel::Show>(index)](int row) {
      return model_.isShown(row, show);
    });
    showMarks();
  });
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          &AnnotationPanel::chooseRow);
  return table_;
}

QWidget* AnnotationPanel::buildSummary() {
  auto* part = new QWidget(this);
  auto* column = new QVBoxLayout(part);
  column->setContentsMargins(0, 0, 0, 0);
  headline_ = named(new QLabel(part), "headline");
  headline_->setWordWrap(true);
  meter_ = named(new QLabel(part), "geometryMeter");
  meter_->setWordWrap(true);
  summary_ = named(new QTextBrowser(part), "solution");
  summary_->setAccessibleName(tr("What the solved pose is worth"));
  use_as_truth_ = named(new QPushButton(tr("Use as truth"), part), "annotationAsTruth",
                        tr("This pose becomes the case's true pose, which results are compared "
                           "with"));
  use_as_seed_ = named(new QPushButton(tr("Use as seed"), part), "annotationAsSeed",
                       tr("Runs of the case start from this pose"));
  auto* row = new QHBoxLayout;
  row->addWidget(headline_, 1);
  row->addWidget(use_as_truth_);
  row->addWidget(use_as_seed_);
  column->addLayout(row);
  column->addWidget(meter_);
  column->addWidget(summary_, 1);
  connect(use_as_truth_, &QPushButton::clicked, &controller_, &AnnotationController::useAsTruth);
  connect(use_as_seed_, &QPushButton::clicked, this, [this] {
    if (const auto pose = controller_.solvedPose()) Q_EMIT useAsSeedRequested(*pose);
  });
  return part;
}

void AnnotationPanel::showMode() {
  points_->setChecked(controller_.mode() == PlaceMode::kPoint);
  lines_->setChecked(controller_.mode() == PlaceMode::kLine);
}

void AnnotationPanel::showMarks() {
  const int before = model_.rowCount();
  showing_ = true;
  model_.setMarks(controller_.marks());
  showing_ = false;
  if (model_.rowCount() != before) table_->resizeColumnsToContents();
  count_->setText(tr("%1 of %2").arg(filter_.rowCount()).arg(model_.rowCount()));
  showSelection();
}

void AnnotationPanel::showSelection() {
  const int row = model_.rowOf(controller_.selected());
  const QModelIndex shown = filter_.mapFromSource(model_.index(row, 0));
  showing_ = true;
  const int column = std::max(table_->currentIndex().column(), 0);
  const QModelIndex current = shown.isValid() ? shown.siblingAtColumn(column) : shown;
  if (current != table_->currentIndex()) table_->setCurrentIndex(current);
  if (shown.isValid()) table_->scrollTo(current);
  showing_ = false;
}

void AnnotationPanel::chooseRow(const QModelIndex& current) {
  if (showing_ || !current.isValid()) return;
  controller_.select(model_.idOf(filter_.mapToSource(current).row()));
}

std::vector<ComparedPose> AnnotationPanel::otherPoses() const {
  std::vector<ComparedPose> made;
  if (!state_.currentCase()) return made;
  const auto add = [&](const QString& name, PoseRole role) {
    if (const auto pose = poseOf(state_, role)) made.push_back({name, *pose});
  };
  add(tr("seed"), PoseRole::kSeed);
  add(tr("run, iteration %1").arg(state_.cursor().iteration + 1), PoseRole::kEstimate);
  add(tr("nudged"), PoseRole::kNudged);
  add(tr("truth"), PoseRole::kTruth);
  return made;
}

void AnnotationPanel::showSolution() {
  const AnnotationAnswer& answer = controller_.answer();
  model_.setSolution(answer.solution, controller_.stale());
  headline_->setText(solutionHeadline(answer, controller_.stale()));
  meter_->setText(geometryMeterText(answer));
  summary_->setEnabled(!controller_.stale());  // dimmed until it is true again
  const int place = summary_->verticalScrollBar()->value();
  summary_->setHtml(solutionHtml(answer, otherPoses()));
  summary_->verticalScrollBar()->setValue(place);
  const bool solved = controller_.solvedPose().has_value();
  use_as_truth_->setEnabled(solved && !controller_.stale());
  use_as_seed_->setEnabled(solved && !controller_.stale());
  const ViewState::CasePtr& one = state_.currentCase();
  together_->setVisible(one && one->source.rig);
}

void AnnotationPanel::showPasses() {
  QMenu& menu = *passes_->menu();
  menu.clear();
  QAction* aside = menu.addAction(tr("Put these marks aside, begin a blind pass ..."), this,
                                  &AnnotationPanel::askForName);
  aside->setEnabled(!controller_.marks().empty());
  menu.addSeparator();
  for (int i = 0; i < static_cast<int>(controller_.passes().size()); ++i) {
    const auto& pass = controller_.passes()[static_cast<std::size_t>(i)];
    QMenu* one = menu.addMenu(QStringLiteral("%1, %2").arg(fromText(pass.by), fromText(pass.time)));
    one->addAction(tr("Take up"), this, [this, i] { controller_.takeUp(i); });
    one->addAction(tr("Remove"), this, [this, i] { controller_.removePass(i); });
  }
}

void AnnotationPanel::askForName() {
  bool accepted = false;
  const QString name =
      QInputDialog::getText(this, tr("Put these marks aside"), tr("Who placed them?"),
                            QLineEdit::Normal, qEnvironmentVariable("USER"), &accepted);
  if (accepted) controller_.putAside(name);
}

/// Letters typed at the table look for a row; they do not switch layers. Enter goes on to the
/// chosen mark in the image.
bool AnnotationPanel::eventFilter(QObject* watched, QEvent* event) {
  if (watched == table_ && event->type() == QEvent::KeyPress) {
    const int key = static_cast<QKeyEvent*>(event)->key();
    if ((key == Qt::Key_Return || key == Qt::Key_Enter) && !controller_.selected().empty()) {
      controller_.setMode(controller_.selectedLine() ? PlaceMode::kLine : PlaceMode::kPoint);
      Q_EMIT imageRequested();
      return true;
    }
  }
  if (watched == table_ && event->type() == QEvent::ShortcutOverride) {
    const auto& key = *static_cast<QKeyEvent*>(event);
    const bool plain = (key.modifiers() & ~Qt::ShiftModifier) == Qt::NoModifier;
    if (plain && !key.text().isEmpty() && key.text().front().isLetterOrNumber()) event->accept();
  }
  return QWidget::eventFilter(watched, event);
}

void AnnotationPanel::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Delete && !controller_.selected().empty()) {
    controller_.remove(controller_.selected());
    return;
  }
  if (event->key() == Qt::Key_Space && !controller_.selected().empty()) {
    const int row = model_.rowOf(controller_.selected());
    const QModelIndex on = model_.index(row, MarksModel::kOn);
    const bool is_on = on.data(Qt::CheckStateRole).toInt() == Qt::Checked;
    model_.setData(on, is_on ? Qt::Unchecked : Qt::Checked, Qt::CheckStateRole);
    return;
  }
  QWidget::keyPressEvent(event);
}

}  // namespace boresight::ui
