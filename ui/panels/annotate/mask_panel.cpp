// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/annotate/mask_panel.h"

#include <algorithm>

#include <QtWidgets>

#include "sessions/session/session.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

using sessions::MaskStroke;
using sessions::MaskStrokes;

MaskPanel::MaskPanel(MaskEditor& editor) : editor_(editor) {
  ui_.setupUi(this);
  ui_.takeStroke->setMenu(new QMenu(ui_.takeStroke));
  (new EmptyHint(*ui_.strokes))
      ->setText(
          tr("No strokes yet: paint with the brush, draw a polygon, or ignore bright pixels."));
  connect(ui_.brush, &QToolButton::clicked, this,
          [this](bool on) { editor_.setTool(on ? MaskTool::kBrush : MaskTool::kNone); });
  connect(ui_.polygon, &QToolButton::clicked, this,
          [this](bool on) { editor_.setTool(on ? MaskTool::kPolygon : MaskTool::kNone); });
  connect(ui_.erase, &QToolButton::clicked, &editor_, &MaskEditor::setErase);
  connect(ui_.brushSize, QOverload<double>::of(&QDoubleSpinBox::valueChanged), &editor_,
          [this](double width) { editor_.setRadius(0.5 * width); });
  connect(ui_.saturated, &QPushButton::clicked, this, &MaskPanel::askForSaturated);
  connect(ui_.strokes, &QListWidget::currentRowChanged, this, &MaskPanel::updateButtons);
  connect(ui_.strokes, &QListWidget::itemActivated, this, &MaskPanel::nameChosen);
  connect(ui_.nameStroke, &QPushButton::clicked, this, &MaskPanel::nameChosen);
  connect(ui_.copyStroke, &QPushButton::clicked, this, [this] { Q_EMIT copyRequested(chosen()); });
  connect(ui_.removeStroke, &QPushButton::clicked, this, &MaskPanel::removeChosen);
  connect(ui_.clearMask, &QPushButton::clicked, this, &MaskPanel::clearAll);
  connect(&editor_, &MaskEditor::changed, this, &MaskPanel::showTool);
  showTool();
  setCase(nullptr, {}, 0);
}

void MaskPanel::showTool() {
  ui_.brush->setChecked(editor_.tool() == MaskTool::kBrush);
  ui_.polygon->setChecked(editor_.tool() == MaskTool::kPolygon);
  ui_.erase->setChecked(editor_.erases());
  ui_.saturated->setText(editor_.erases() ? tr("Use again") : tr("Ignore"));
  const QSignalBlocker blocker(ui_.brushSize);
  ui_.brushSize->setValue(2.0 * editor_.radius_px());
}

void MaskPanel::setCase(const sessions::SessionCase* session_case, const MaskStrokes& named,
                        int cases_of_camera) {
  const int row = session_case ? rowInNext(*session_case) : -1;
  case_ = session_case ? std::optional(*session_case) : std::nullopt;
  named_ = named;
  cases_of_camera_ = cases_of_camera;
  showStrokes(row);
}

/// Row of the chosen stroke, whatever its name, in the next state of the same case; -1 where it has
/// gone.
int MaskPanel::rowInNext(const sessions::SessionCase& next) const {
  if (!case_ || case_->id != next.id || chosen() < 0) return -1;
  const auto row = static_cast<std::size_t>(chosen());
  const MaskStroke& stroke = case_->ignore_strokes[row];
  const MaskStrokes& strokes = next.ignore_strokes;
  const auto is_it = [&stroke](MaskStroke other) {
    other.name = stroke.name;
    return other == stroke;
  };
  if (row < strokes.size() && is_it(strokes[row])) return chosen();
  const auto found = std::ranges::find_if(strokes, is_it);
  return found == strokes.end() ? -1 : static_cast<int>(found - strokes.begin());
}

void MaskPanel::setIgnored(std::int64_t ignored, std::int64_t pixels) {
  if (!case_ || ignored < 0 || pixels <= 0) {
    ui_.maskSummary->setText(case_ ? QString() : tr("No editable case is open."));
    return;
  }
  const QString file =
      case_->ignore ? tr(" Mask image: %1.")
                          .arg(QString::fromStdString(case_->ignore->file.filename().string()))
                    : QString();
  ui_.maskSummary->setText(
      tr("%1 pixels are ignored, %2 % of the image.%3")
          .arg(ignored)
          .arg(100.0 * static_cast<double>(ignored) / static_cast<double>(pixels), 0, 'f', 2)
          .arg(file));
}

void MaskPanel::showStrokes(int row) {
  {
    const QSignalBlocker blocker(ui_.strokes);
    ui_.strokes->clear();
    if (case_)
      for (const MaskStroke& stroke : case_->ignore_strokes)
        ui_.strokes->addItem(QString::fromStdString(sessions::strokeText(stroke)));
    ui_.strokes->setCurrentRow(row);
  }
  ui_.takeStroke->menu()->clear();
  for (const MaskStroke& stroke : named_)
    ui_.takeStroke->menu()->addAction(QString::fromStdString(sessions::strokeText(stroke)), this,
                                      [this, stroke] { Q_EMIT strokeRequested(stroke); });
  updateButtons();
}

int MaskPanel::chosen() const { return ui_.strokes->currentRow(); }

void MaskPanel::updateButtons() {
  const bool open = case_.has_value();
  for (QWidget* each : std::initializer_list<QWidget*>{
           ui_.brush, ui_.polygon, ui_.erase, ui_.brushSize, ui_.saturationLevel, ui_.saturated})
    each->setEnabled(open);
  for (QPushButton* each : {ui_.nameStroke, ui_.removeStroke}) each->setEnabled(chosen() >= 0);
  ui_.copyStroke->setEnabled(chosen() >= 0 && cases_of_camera_ > 0);
  ui_.takeStroke->setEnabled(!named_.empty());
  ui_.clearMask->setEnabled(open && case_->ignore_strokes != sessions::clearedStrokes(*case_));
}

void MaskPanel::askForSaturated() {
  if (!case_) return;
  MaskStroke stroke;
  stroke.kind = sessions::StrokeKind::kSaturation;
  stroke.erase = editor_.erases();
  stroke.level = ui_.saturationLevel->value();
  Q_EMIT strokeRequested(stroke);
}

void MaskPanel::nameChosen() {
  if (!case_ || chosen() < 0) return;
  const sessions::SessionCase seen = *case_;
  MaskStrokes strokes = seen.ignore_strokes;
  std::string& name = strokes[static_cast<std::size_t>(chosen())].name;
  bool accepted = false;
  const QString given =
      QInputDialog::getText(this, tr("Name of the stroke"), tr("Name"), QLineEdit::Normal,
                            QString::fromStdString(name), &accepted);
  if (!accepted) return;
  if (!case_ || case_->id != seen.id || case_->ignore_strokes != seen.ignore_strokes)
    return failed(tr("The stroke was not named: the mask that is shown has changed."));
  name = given.trimmed().toStdString();
  Q_EMIT strokesRequested(seen.id, strokes, tr("Name a stroke of the ignore mask"));
}

void MaskPanel::removeChosen() {
  if (!case_ || chosen() < 0) return;
  MaskStrokes strokes = case_->ignore_strokes;
  strokes.erase(strokes.begin() + chosen());
  Q_EMIT strokesRequested(case_->id, strokes, tr("Remove a stroke of the ignore mask"));
}

void MaskPanel::clearAll() {
  if (case_)
    Q_EMIT strokesRequested(case_->id, sessions::clearedStrokes(*case_),
                            tr("Clear the ignore mask"));
}

}  // namespace boresight::ui
