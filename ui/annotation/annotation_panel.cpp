// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_panel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QCoreApplication>
#include <QStringList>
#include <QtWidgets>

#include "core/base/math.h"
#include "sessions/annotation/annotations.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/session/rig_links.h"
#include "sessions/trace/run_text.h"
#include "ui/annotation/station_snapper.h"
#include "ui/models/text.h"
#include "ui/panels/run/pose_comparison.h"
#include "ui/panels/run/pose_panel.h"
#include "ui/state/document.h"
#include "ui/views/view_transform.h"
#include "ui/widgets/column_fitter.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

using sessions::AnnotationsSolution;

constexpr double kMradPerDegree = 1e3 * kDegree_rad;

QString solutionText(const char* text) { return QCoreApplication::translate("SolutionHtml", text); }

/// In the order of `GeometryWeakness`, but its last.
constexpr std::array<const char*, 6> kWeaknesses = {"too few annotations",
                                                    "no redundancy",
                                                    "all on one line",
                                                    "all in one plane",
                                                    "all in one corner of the station",
                                                    "all at one depth"};

QString warningsHtml(const sessions::CaseAnnotationsSolution& solution) {
  QStringList items;
  for (const sessions::GeometryWarning& warning : solution.warnings)
    items << QStringLiteral("<li>%1%2</li>")
                 .arg(warning.prevents ? solutionText("<b>No pose:</b> ") : QString(),
                      fromText(warning.text).toHtmlEscaped());
  if (items.isEmpty()) return {};
  return QStringLiteral("<p><b>%1</b></p><ul style='margin-left:14px;-qt-list-indent:0'>%2</ul>")
      .arg(solutionText("Geometry"), items.join(QString()));
}

/// Where translations are judged.
QString placeText(const sessions::CaseAnnotations& annotations) {
  return annotations.camera_from_end_effector ? solutionText("end effector")
                                              : solutionText("camera");
}

QString sigmaHtml(const AnnotationAnswer& answer) {
  const AnnotationsSolution& solution = *answer.solution->result.solution;
  const sessions::CaseAnnotations& annotations = answer.solution->annotations;
  if (!answer.covariance) return {};
  const Matrix6d covariance = annotations.sigmas * annotations.sigmas * *answer.covariance;
  const auto sigma = sessions::poseSigma(covariance, annotations.camera_from_end_effector);
  if (!sigma) return {};
  const QString title =
      solutionText("%1 sigma at the %2, from the annotations (noise %3 times their stated sigmas)")
          .arg(QString::number(annotations.sigmas), placeText(annotations))
          .arg(QString::number(solution.noise_factor, 'f', 2));
  QVector<QStringList> rows = sigmaRows(*sigma, annotations.requirement);
  // Without an end effector these are the camera's own already.
  const auto at_camera = annotations.camera_from_end_effector
                             ? sessions::poseSigma(covariance, std::nullopt)
                             : std::nullopt;
  if (at_camera)
    rows << axesRow(solutionText("at the camera"), at_camera->translation_mm, solutionText("mm"));
  return titledTable(title, rows);
}

QStringList poseCells(const Pose& pose) {
  const Eigen::Vector3d turn_deg = rotationLog(pose.rotation) / kDegree_rad;
  QStringList cells;
  for (int i = 0; i < 3; ++i) cells << QString::number(1e3 * pose.translation_m[i], 'f', 3);
  for (int i = 0; i < 3; ++i) cells << QString::number(turn_deg[i], 'f', 4);
  return cells;
}

QString ambiguityHtml(const sessions::CaseAnnotationsSolution& solved) {
  const AnnotationsSolution& solution = *solved.result.solution;
  const auto other_pose = solved.ambiguous_camera_from_station();
  if (!other_pose) return {};
  const QStringList ours = poseCells(solution.camera_from_station.front());
  const QStringList other = poseCells(*other_pose);
  const QStringList names = {solutionText("x, mm"),       solutionText("y, mm"),
                             solutionText("z, mm"),       solutionText("turn x, deg"),
                             solutionText("turn y, deg"), solutionText("turn z, deg")};
  QVector<QStringList> rows = {
      {QString(), solutionText("this pose"), solutionText("the other pose")}};
  for (int i = 0; i < names.size(); ++i) rows.append({names[i], ours[i], other[i]});
  rows.append({solutionText("rms, px"), QString::number(solution.rms_px, 'f', 3),
               QString::number(solution.ambiguous->rms_px, 'f', 3)});
  return titledTable(solutionText("Coplanar annotations fit two poses"), rows);
}

QString viewsHtml(const sessions::CaseAnnotationsSolution& solved) {
  const auto& views = solved.annotations.views;
  if (views.size() < 2) return {};
  QVector<QStringList> rows;
  for (std::size_t i = 0; i < views.size(); ++i) {
    double squares_px2 = 0.0;
    int count = 0;
    for (const sessions::SolvedAnnotation& annotation : solved.result.solution->annotations) {
      if (annotation.address.view != i || !annotation.projected) continue;
      squares_px2 += annotation.residual_px.squaredNorm();
      ++count;
    }
    const double rms_px = count > 0 ? std::sqrt(squares_px2 / (2.0 * count)) : 0.0;
    rows.append({fromText(views[i].name).toHtmlEscaped(), solutionText("%1 annotations").arg(count),
                 solutionText("%1 px rms").arg(QString::number(rms_px, 'f', 3))});
  }
  return titledTable(solutionText("Cameras solved together"), rows);
}

QStringList differenceRow(const QString& name, const Pose& other, const Pose& annotated,
                          const sessions::CaseAnnotations& annotations,
                          const sessions::PoseComparer& comparer, const QString& more) {
  const sessions::PoseError error = sessions::poseError(
      comparer.equivalent(other, annotated), annotated, annotations.camera_from_end_effector);
  return {name.toHtmlEscaped(), QString::number(error.normal_mm, 'f', 3),
          QString::number(error.lateral_mm, 'f', 3),
          QString::number(error.geodesic_mrad / kMradPerDegree, 'f', 4), more};
}

QString comparedHtml(const AnnotationAnswer& answer, const std::vector<ComparedPose>& others,
                     const Pose& annotated, const sessions::PoseComparer& comparer) {
  const sessions::CaseAnnotations& annotations = answer.solution->annotations;
  QVector<QStringList> rows;
  for (const ComparedPose& other : others)
    rows << differenceRow(other.name, other.camera_from_station, annotated, annotations, comparer,
                          {});
  for (const RoundAnswer& round : answer.rounds) {
    const int shared = static_cast<int>(round.repeatability.annotations.size());
    const QString repeated = shared > 0
                                 ? solutionText("%1 annotations, %2 px per annotation and axis")
                                       .arg(shared)
                                       .arg(QString::number(round.repeatability.sigma_px, 'f', 3))
                                 : solutionText("no annotation in common");
    const QString name = solutionText("round of %1").arg(fromText(round.by));
    if (round.camera_from_station)
      rows << differenceRow(name, *round.camera_from_station, annotated, annotations, comparer,
                            repeated);
    else
      rows.append({name.toHtmlEscaped(), solutionText("no pose"), QString(), QString(), repeated});
  }
  if (rows.isEmpty()) return {};
  rows.prepend({QString(), solutionText("normal, mm"), solutionText("lateral, mm"),
                solutionText("angle, deg"), QString()});
  return titledTable(
      solutionText("Distance of the annotated pose at the %1").arg(placeText(annotations)), rows);
}

/// Of a rig, whose annotations are more than those of the shown case.
QString camerasText(const sessions::CaseAnnotations& annotations) {
  return annotations.views.size() < 2
             ? QString()
             : solutionText(" of %1 cameras").arg(annotations.views.size());
}

}  // namespace

QString solutionHeadline(const AnnotationAnswer& answer, bool stale) {
  if (answer.blind)
    return solutionText("Blind round: nothing is predicted until all is placed or removed.");
  if (!answer.solution)
    return stale ? solutionText("Solving ...") : solutionText("No annotations yet.");
  const sessions::AnnotationsResult& result = answer.solution->result;
  QString text = fromText(result.reason);
  if (result.solution)
    text = solutionText("Solved from %1 annotations%2, %3 px rms.")
               .arg(result.solution->annotations.size())
               .arg(camerasText(answer.solution->annotations))
               .arg(QString::number(result.solution->rms_px, 'f', 3));
  else if (text.isEmpty())
    text = solutionText("No annotations yet.");
  return stale ? solutionText("Stale, solving again: %1").arg(text) : text;
}

QString geometryMeterText(const AnnotationAnswer& answer) {
  if (!answer.solution) return {};
  QStringList weak;
  for (const sessions::GeometryWarning& warning : answer.solution->warnings)
    if (warning.weakness != sessions::GeometryWeakness::kImprecise)
      weak << solutionText(kWeaknesses[static_cast<std::size_t>(warning.weakness)]);
  if (answer.quality && answer.quality->worst() && !answer.quality->holds())
    weak << solutionText("pose known to %1").arg(fromText(answer.quality->text()));
  const QChar sign(weak.isEmpty() ? 0x2713 : 0x26a0);
  return solutionText("Geometry: %1 %2")
      .arg(sign)
      .arg(weak.isEmpty() ? solutionText("no weakness") : weak.join(QStringLiteral(", ")));
}

QString solutionHtml(const AnnotationAnswer& answer, const std::vector<ComparedPose>& others,
                     const sessions::PoseComparer& comparer) {
  if (!answer.solution) return {};
  const QString html = warningsHtml(*answer.solution);
  const auto annotated = answer.solution->camera_from_station();
  if (!annotated) return html;
  return html + sigmaHtml(answer) + ambiguityHtml(*answer.solution) + viewsHtml(*answer.solution) +
         comparedHtml(answer, others, *annotated, comparer);
}

/// The station's named points without annotation in this image: to confirm their predictions, or to
/// begin one by name and click it.
void AnnotationPanel::fillLandmarks() {
  QMenu& menu = *ui_.landmarks->menu();
  menu.clear();
  menu.addAction(tr("Open ..."), this, &AnnotationPanel::openLandmarksRequested);
  menu.addAction(tr("Save as landmarks ..."), this, &AnnotationPanel::saveLandmarksRequested);
  menu.addSeparator();
  QAction* confirm =
      menu.addAction(tr("Annotate all visible landmarks (%1)").arg(controller_.seenProposals()),
                     &controller_, &AnnotationController::confirmSeen);
  confirm->setEnabled(controller_.seenProposals() > 0);
  menu.addSeparator();
  bool any = false;
  for (const sessions::Landmark& landmark : controller_.landmarks()) {
    if (sessions::findPoint(controller_.annotations(), landmark.name)) continue;
    any = true;
    QAction* begin =
        menu.addAction(tr("Begin %1").arg(fromText(landmark.name)), this, [this, landmark] {
          controller_.setMode(PlaceMode::kPoint);
          controller_.begin(landmark);
        });
    begin->setToolTip(fromText(landmark.comment));
  }
  if (!any)
    menu.addAction(controller_.landmarks().empty()
                       ? tr("No landmarks are open")
                       : tr("Every landmark is annotated in this image"))
        ->setEnabled(false);
}

/// The cases that are solved together with the shown one: opens, links and unlinks them.
void AnnotationPanel::fillRig() {
  QMenu& menu = *ui_.rig->menu();
  menu.clear();
  qDeleteAll(menu.findChildren<QMenu*>(QString(), Qt::FindDirectChildrenOnly));  // clear() does not
  const sessions::Session& session = document_.session();
  const sessions::SessionCase* shown = shownCase(document_, state_);
  if (!shown) {
    menu.addAction(tr("No case is open"))->setEnabled(false);
    return;
  }
  const std::vector<std::string> linked = sessions::casesOfRig(session, shown->id);
  for (const std::string& id : linked)
    menu.addAction(tr("Go to %1").arg(fromText(id)), this,
                   [this, id] { Q_EMIT openCaseRequested(fromText(id)); });
  if (!linked.empty()) {
    menu.addAction(tr("Take %1 out of this rig").arg(fromText(shown->id)), &controller_,
                   &AnnotationController::unlinkCase);
    menu.addSeparator();
  }
  QMenu* links = menu.addMenu(tr("Link with"));
  for (const auto& other : session.cases)
    if (other->id != shown->id && other->station == shown->station &&
        std::ranges::count(linked, other->id) == 0)
      addLinks(*links->addMenu(fromText(other->id)), *shown, *other);
  if (links->isEmpty()) links->addAction(tr("No other case of this station"))->setEnabled(false);
}

void AnnotationPanel::addLinks(QMenu& menu, const sessions::SessionCase& shown,
                               const sessions::SessionCase& other) {
  const auto add = [&](const QString& text, const Pose& other_from_shown) {
    menu.addAction(text, this, [this, id = other.id, other_from_shown] {
      controller_.linkCase(id, other_from_shown);
    });
  };
  add(tr("The same camera, not moved"), Pose());
  if (const auto link = sessions::linkOfTruths(shown, other))
    add(tr("As the true poses say"), *link);
  if (const auto link = sessions::linkOfFrames(shown, other))
    add(tr("As the frames say (%1)").arg(fromText(sessions::frameText(link->frame))),
        link->other_from_case);
  menu.addAction(tr("By a pose from the clipboard ..."), this,
                 [this, id = other.id] { askForPose(id); });
}

void AnnotationPanel::askForPose(const std::string& other_id) {
  const CaseOpening seen = state_.opening();
  PastePoseDialog dialog(QGuiApplication::clipboard()->text(), this);
  dialog.setWindowTitle(
      tr("Pose of %1 from the shown camera: p_other = R p_shown + t").arg(fromText(other_id)));
  if (dialog.exec() != QDialog::Accepted || !dialog.parsed().valid) return;
  if (seen == state_.opening())
    controller_.linkCase(other_id, dialog.parsed().camera_from_station);
  else
    Q_EMIT failed(leftText(seen));
}

AnnotationPanel::AnnotationPanel(Document& document, AnnotationController& controller,
                                 ViewState& state, QWidget* parent)
    : QWidget(parent), document_(document), controller_(controller), state_(state) {
  filter_.setSourceModel(&model_);
  ui_.setupUi(this);
  ui_.splitter->setSizes({500, 400});
  for (QToolButton* button : {ui_.annotationFiles, ui_.landmarks, ui_.rounds, ui_.rig})
    button->setMenu(new QMenu(this));
  fillLandmarks();
  buildTable();
  connectTools();
  connect(&controller_, &AnnotationController::modeChanged, this, &AnnotationPanel::showMode);
  connect(&controller_, &AnnotationController::annotationsChanged, this,
          &AnnotationPanel::showAnnotations);
  connect(&controller_, &AnnotationController::selectionChanged, this,
          &AnnotationPanel::showSelection);
  connect(&controller_, &AnnotationController::solutionChanged, this,
          &AnnotationPanel::showSolution);
  state_.onChange(
      ViewChange::kCase | ViewChange::kSnapshot | ViewChange::kCursor | ViewChange::kNudgedPose,
      this, &AnnotationPanel::showSolution);
  showMode();
  showAnnotations();
  showSolution();
}

void AnnotationPanel::setSnapper(const StationSnapper& snapper) {
  const auto take = [this, &snapper] { model_.setMesh(snapper.mesh()); };
  connect(&snapper, &StationSnapper::meshChanged, this, take);
  take();
}

void AnnotationPanel::addBeside(QWidget* widget) {
  ui_.splitter->addWidget(widget);
  ui_.splitter->setCollapsible(ui_.splitter->count() - 1, false);
  for (int i = 0; i < ui_.splitter->count(); ++i) ui_.splitter->setStretchFactor(i, 1);
}

void AnnotationPanel::connectTools() {
  ui_.newSigma->setValue(controller_.sigma_px());
  ui_.newSigma->setMinimumWidth(
      ui_.newSigma->fontMetrics().horizontalAdvance(QStringLiteral("\u00b1 00.00 px")) + 30);
  ui_.together->setChecked(controller_.together());
  for (const auto& [button, mode] :
       {std::pair(ui_.placePoints, PlaceMode::kPoint), {ui_.placeLines, PlaceMode::kLine}})
    connect(button, &QToolButton::clicked, this, [this, chosen = mode](bool on) {
      controller_.setMode(on ? chosen : PlaceMode::kOff);
      showMode();
    });
  connect(ui_.landmarks->menu(), &QMenu::aboutToShow, this, &AnnotationPanel::fillLandmarks);
  connect(ui_.rounds->menu(), &QMenu::aboutToShow, this, &AnnotationPanel::fillRounds);
  connect(ui_.rig->menu(), &QMenu::aboutToShow, this, &AnnotationPanel::fillRig);
  connect(ui_.newSigma, QOverload<double>::of(&QDoubleSpinBox::valueChanged), &controller_,
          &AnnotationController::setSigma);
  connect(ui_.robust, &QCheckBox::toggled, &controller_, &AnnotationController::setRobust);
  connect(ui_.together, &QCheckBox::toggled, &controller_, &AnnotationController::setTogether);
  connect(ui_.annotationAsTruth, &QPushButton::clicked, &controller_,
          &AnnotationController::useAsTruth);
  connect(ui_.annotationAsSeed, &QPushButton::clicked, &controller_,
          &AnnotationController::useAsSeed);
}

void AnnotationPanel::buildTable() {
  setUpTable(*ui_.annotations, filter_);
  using Model = AnnotationsModel;
  new ColumnFitter(*ui_.annotations,
                   {Model::kComment, Model::kLocked, Model::kSigma_px, Model::kResidualY_mm,
                    Model::kResidualX_mm, Model::kWithout_mrad, Model::kWithout_mm,
                    Model::kStationKind, Model::kY_mm, Model::kX_mm, Model::kZ_mm,
                    Model::kNormalized, Model::kResidualY_px, Model::kResidualX_px});
  ui_.annotations->installEventFilter(this);
  ui_.annotations->setEditTriggers(QAbstractItemView::DoubleClicked |
                                   QAbstractItemView::EditKeyPressed);
  ui_.annotations->sortByColumn(-1, Qt::AscendingOrder);
  ui_.showAnnotations->addItems(AnnotationsModel::showNames());
  connect(ui_.showAnnotations, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this](int index) {
            filter_.setCondition([this, show = static_cast<AnnotationsModel::Show>(index)](
                                     int row) { return model_.isShown(row, show); });
            showAnnotations();
          });
  connect(ui_.annotations->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          &AnnotationPanel::chooseRow);
  connect(&model_, &AnnotationsModel::pointEdited, &controller_,
          &AnnotationController::replacePoint);
  connect(&model_, &AnnotationsModel::lineEdited, &controller_, &AnnotationController::replaceLine);
}

void AnnotationPanel::showMode() {
  ui_.placePoints->setChecked(controller_.mode() == PlaceMode::kPoint);
  ui_.placeLines->setChecked(controller_.mode() == PlaceMode::kLine);
}

void AnnotationPanel::showAnnotations() {
  const int before = model_.rowCount();
  showing_ = true;
  model_.setAnnotations(controller_.annotations());
  showing_ = false;
  if (model_.rowCount() != before) ui_.annotations->resizeColumnsToContents();
  ui_.count->setText(tr("%1 of %2").arg(filter_.rowCount()).arg(model_.rowCount()));
  showSelection();
}

void AnnotationPanel::showSelection() {
  const int row = model_.rowOf(controller_.selected());
  const QModelIndex shown = filter_.mapFromSource(model_.index(row, 0));
  showing_ = true;
  const int column = std::max(ui_.annotations->currentIndex().column(), 0);
  const QModelIndex current = shown.isValid() ? shown.siblingAtColumn(column) : shown;
  if (current != ui_.annotations->currentIndex()) ui_.annotations->setCurrentIndex(current);
  if (shown.isValid()) ui_.annotations->scrollTo(current);
  showing_ = false;
}

void AnnotationPanel::chooseRow(const QModelIndex& current) {
  if (showing_ || !current.isValid()) return;
  controller_.select(model_.idOf(filter_.mapToSource(current).row()));
}

std::vector<ComparedPose> AnnotationPanel::otherPoses() const {
  std::vector<ComparedPose> compared_poses;
  if (!state_.currentCase()) return compared_poses;
  const auto add = [&](const QString& name, PoseRole role) {
    if (const auto pose = poseOf(state_, role)) compared_poses.push_back({name, *pose});
  };
  add(tr("seed"), PoseRole::kSeed);
  if (state_.snapshot())
    add(tr("run, iteration %1")
            .arg(fromText(sessions::iterationName(*state_.snapshot(), state_.cursor().iteration))),
        PoseRole::kEstimate);
  add(tr("nudged"), PoseRole::kNudged);
  add(tr("truth"), PoseRole::kTruth);
  return compared_poses;
}

void AnnotationPanel::showSolution() {
  const AnnotationAnswer& answer = controller_.answer();
  model_.setSolution(answer.solution, controller_.stale());
  ui_.headline->setText(solutionHeadline(answer, controller_.stale()));
  ui_.geometryMeter->setText(geometryMeterText(answer));
  ui_.solution->setEnabled(!controller_.stale());  // dimmed until it is true again
  const int place = ui_.solution->verticalScrollBar()->value();
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  ui_.solution->setHtml(solutionHtml(
      answer, otherPoses(),
      loaded_case ? sessions::differenceComparer(*loaded_case) : sessions::PoseComparer()));
  ui_.solution->verticalScrollBar()->setValue(place);
  const QSignalBlocker blocked(ui_.robust);
  ui_.robust->setChecked(controller_.robust());
  const bool solved = controller_.solvedPose().has_value();
  ui_.annotationAsTruth->setEnabled(solved && !controller_.stale());
  ui_.annotationAsSeed->setEnabled(solved && !controller_.stale());
  ui_.together->setVisible(loaded_case && loaded_case->source.rig);
}

void AnnotationPanel::fillRounds() {
  QMenu& menu = *ui_.rounds->menu();
  menu.clear();
  QAction* aside = menu.addAction(tr("Set annotations aside, begin a blind round ..."), this,
                                  &AnnotationPanel::askForName);
  aside->setEnabled(!controller_.annotations().empty());
  menu.addSeparator();
  for (int i = 0; i < static_cast<int>(controller_.answer().rounds.size()); ++i) {
    const auto& round = controller_.answer().rounds[static_cast<std::size_t>(i)];
    QMenu* actions =
        menu.addMenu(QStringLiteral("%1, %2").arg(fromText(round.by), fromText(round.time)));
    actions->addAction(tr("Continue"), this, [this, i] { controller_.takeUp(i); });
    actions->addAction(tr("Remove"), this, [this, i] { controller_.removeRound(i); });
  }
}

void AnnotationPanel::askForName() {
  const CaseOpening seen = state_.opening();
  bool accepted = false;
  const QString name =
      QInputDialog::getText(this, tr("Set annotations aside"), tr("Name of the annotator"),
                            QLineEdit::Normal, qEnvironmentVariable("USER"), &accepted);
  if (!accepted) return;
  if (seen == state_.opening())
    controller_.putAside(name);
  else
    Q_EMIT failed(leftText(seen));
}

/// Arrows move the chosen annotation as they do in the image, with Ctrl they go to other rows.
bool AnnotationPanel::pressArrow(const QKeyEvent& key) {
  const QPointF way = arrowOf(key.key());
  if (way.isNull() || controller_.selected().empty()) return false;
  if ((key.modifiers() & Qt::ControlModifier) != 0) {
    const QModelIndex current = ui_.annotations->currentIndex();
    const QModelIndex next = current.sibling(current.row() + static_cast<int>(way.y()),
                                             current.column() + static_cast<int>(way.x()));
    if (next.isValid()) ui_.annotations->setCurrentIndex(next);
    return true;
  }
  const double step_px = (key.modifiers() & Qt::ShiftModifier) != 0 ? 1.0 : 0.1;
  controller_.nudge(step_px * vectorOf(way));
  return true;
}

/// Letters typed at the table look for a row; they do not switch layers. Enter moves to the chosen
/// annotation in the image.
bool AnnotationPanel::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::KeyPress) {
    const auto& key = *static_cast<QKeyEvent*>(event);
    if (pressArrow(key)) return true;
    if ((key.key() == Qt::Key_Return || key.key() == Qt::Key_Enter) &&
        !controller_.selected().empty()) {
      controller_.setMode(controller_.selectedLine() ? PlaceMode::kLine : PlaceMode::kPoint);
      Q_EMIT imageRequested();
      return true;
    }
  }
  if (event->type() == QEvent::ShortcutOverride) {
    const auto& key = *static_cast<QKeyEvent*>(event);
    const bool plain = (key.modifiers() & ~Qt::ShiftModifier) == Qt::NoModifier;
    const bool to_cell = key.modifiers() == Qt::ControlModifier && !arrowOf(key.key()).isNull();
    if (to_cell || (plain && !key.text().isEmpty() && key.text().front().isLetterOrNumber()))
      event->accept();
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
    const QModelIndex on = model_.index(row, AnnotationsModel::kOn);
    const bool is_on = on.data(Qt::CheckStateRole).toInt() == Qt::Checked;
    model_.setData(on, is_on ? Qt::Unchecked : Qt::Checked, Qt::CheckStateRole);
    return;
  }
  QWidget::keyPressEvent(event);
}

}  // namespace boresight::ui
