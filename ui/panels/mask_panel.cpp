// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/mask_panel.h"

#include <QtWidgets>

#include "sessions/session/mask_edits.h"
#include "ui/panels/widgets.h"

namespace boresight::ui {
namespace {

using sessions::MaskStroke;
using sessions::MaskStrokes;

QToolButton* toolButton(const QString& name, const QString& text, const QString& tip) {
  auto* button = new QToolButton;
  button->setObjectName(name);
  button->setText(text);
  button->setToolTip(tip);
  button->setCheckable(true);
  return button;
}

QPushButton* pushButton(const QString& name, const QString& text, const QString& tip) {
  auto* button = new QPushButton(text);
  button->setObjectName(name);
  button->setToolTip(tip);
  return button;
}

}  // namespace

MaskPanel::MaskPanel(MaskEditor& editor, QWidget* parent) : QWidget(parent), editor_(editor) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  auto* about = new QLabel(
      tr("Pixels that are not trusted: the arm's own gripper, dropped packets, saturation. Runs "
         "take no edges from them."));
  about->setWordWrap(true);
  layout->addWidget(about);
  buildTools(*layout);
  buildSaturation(*layout);
  buildStrokes(*layout);
  connect(&editor_, &MaskEditor::changed, this, &MaskPanel::showTool);
  showTool();
  setCase(nullptr, {}, 0);
}

void MaskPanel::buildTools(QBoxLayout& layout) {
  auto* row = new QHBoxLayout;
  brush_ = toolButton(QStringLiteral("brush"), tr("Brush"),
                      tr("Draw on the image with the left button (Shift+B); Escape ends"));
  polygon_ = toolButton(QStringLiteral("polygon"), tr("Polygon"),
                        tr("Click the corners on the image (Shift+P); Enter or a double click "
                           "closes, Backspace drops the last corner"));
  erase_ = toolButton(QStringLiteral("erase"), tr("Erase"),
                      tr("What is drawn is trusted again instead of ignored (Shift+E)"));
  size_ = new QDoubleSpinBox;
  size_->setObjectName(QStringLiteral("brushSize"));
  size_->setRange(2.0 * MaskEditor::kMinRadius_px, 2.0 * MaskEditor::kMaxRadius_px);
  size_->setDecimals(0);
  size_->setSuffix(tr(" px"));
  size_->setToolTip(tr("Width of the brush in pixels of the image ([ smaller, ] larger)"));
  size_->setAccessibleName(tr("Width of the brush"));
  for (QWidget* each : {static_cast<QWidget*>(brush_), static_cast<QWidget*>(size_),
                        static_cast<QWidget*>(polygon_), static_cast<QWidget*>(erase_)})
    row->addWidget(each);
  row->addStretch(1);
  layout.addLayout(row);
  connect(brush_, &QToolButton::clicked, this,
          [this](bool on) { editor_.setTool(on ? MaskTool::kBrush : MaskTool::kNone); });
  connect(polygon_, &QToolButton::clicked, this,
          [this](bool on) { editor_.setTool(on ? MaskTool::kPolygon : MaskTool::kNone); });
  connect(erase_, &QToolButton::clicked, &editor_, &MaskEditor::setErase);
  connect(size_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), &editor_,
          [this](double width) { editor_.setRadius(0.5 * width); });
}

void MaskPanel::buildSaturation(QBoxLayout& layout) {
  auto* row = new QHBoxLayout;
  auto* label = new QLabel(tr("Gray of at least"));
  level_ = new QSpinBox;
  level_->setObjectName(QStringLiteral("saturationLevel"));
  level_->setRange(1, 255);
  level_->setValue(255);
  level_->setToolTip(tr("8-bit gray value, as the core sees it"));
  label->setBuddy(level_);
  saturated_ = pushButton(QStringLiteral("saturated"), tr("Ignore"),
                          tr("Every pixel of this gray value or more (Shift+S); with Erase they "
                             "are trusted again"));
  row->addWidget(label);
  row->addWidget(level_);
  row->addWidget(saturated_);
  row->addStretch(1);
  layout.addLayout(row);
  connect(saturated_, &QPushButton::clicked, this, &MaskPanel::askForSaturated);
}

void MaskPanel::buildStrokes(QBoxLayout& layout) {
  summary_ = new QLabel;
  summary_->setObjectName(QStringLiteral("maskSummary"));
  summary_->setWordWrap(true);
  layout.addWidget(summary_);
  strokes_ = new QListWidget;
  strokes_->setObjectName(QStringLiteral("strokes"));
  strokes_->setAccessibleName(tr("Strokes of the mask"));
  strokes_->setToolTip(tr("What the mask is made of, the first stroke first"));
  layout.addWidget(strokes_, 1);
  (new EmptyHint(*strokes_))
      ->setText(tr("Nothing yet: paint with the brush, draw a polygon, or ignore bright pixels."));
  name_ = pushButton(QStringLiteral("nameStroke"), tr("Name..."),
                     tr("Name the chosen stroke, \"gripper\" for one; other cases of the camera "
                        "can then take it"));
  copy_ = pushButton(QStringLiteral("copyStroke"), tr("Copy to camera"),
                     tr("Copy the chosen stroke to all other cases of this camera"));
  take_ = pushButton(QStringLiteral("takeStroke"), tr("Take"),
                     tr("Take a named stroke of another case of this camera"));
  take_->setMenu(new QMenu(take_));
  remove_ =
      pushButton(QStringLiteral("removeStroke"), tr("Remove"), tr("Remove the chosen stroke"));
  clear_ = pushButton(QStringLiteral("clearMask"), tr("Clear"),
                      tr("Ignore no pixel at all, not those of the mask image either"));
  auto* upper = new QHBoxLayout;
  upper->addWidget(name_);
  upper->addWidget(copy_);
  upper->addWidget(take_);
  auto* lower = new QHBoxLayout;
  lower->addWidget(remove_);
  lower->addWidget(clear_);
  layout.addLayout(upper);
  layout.addLayout(lower);
  connect(strokes_, &QListWidget::currentRowChanged, this, &MaskPanel::updateButtons);
  connect(strokes_, &QListWidget::itemActivated, this, &MaskPanel::nameChosen);
  connect(name_, &QPushButton::clicked, this, &MaskPanel::nameChosen);
  connect(copy_, &QPushButton::clicked, this, [this] { Q_EMIT copyRequested(chosen()); });
  connect(remove_, &QPushButton::clicked, this, &MaskPanel::removeChosen);
  connect(clear_, &QPushButton::clicked, this, &MaskPanel::clearAll);
}

void MaskPanel::showTool() {
  brush_->setChecked(editor_.tool() == MaskTool::kBrush);
  polygon_->setChecked(editor_.tool() == MaskTool::kPolygon);
  erase_->setChecked(editor_.erases());
  saturated_->setText(editor_.erases() ? tr("Trust again") : tr("Ignore"));
  const QSignalBlocker blocker(size_);
  size_->setValue(2.0 * editor_.radius_px());
}

void MaskPanel::setCase(const sessions::SessionCase* one, const MaskStrokes& named,
                        int cases_of_camera) {
  case_ = one ? std::optional(*one) : std::nullopt;
  named_ = named;
  cases_of_camera_ = cases_of_camera;
  showStrokes();
}

void MaskPanel::setIgnored(std::int64_t ignored, std::int64_t pixels) {
  if (!case_ || ignored < 0 || pixels <= 0) {
    summary_->setText(case_ ? QString() : tr("No case that can be edited is open."));
    return;
  }
  const QString file =
      case_->ignore ? tr(" Mask image: %1.")
                          .arg(QString::fromStdString(case_->ignore->file.filename().string()))
                    : QString();
  summary_->setText(
      tr("%1 pixels are ignored, %2 % of the image.%3")
          .arg(ignored)
          .arg(100.0 * static_cast<double>(ignored) / static_cast<double>(pixels), 0, 'f', 2)
          .arg(file));
}

void MaskPanel::showStrokes() {
  const int row = strokes_->currentRow();
  {
    const QSignalBlocker blocker(strokes_);
    strokes_->clear();
    if (case_)
      for (const MaskStroke& stroke : case_->ignore_strokes)
        strokes_->addItem(QString::fromStdString(sessions::strokeText(stroke)));
    strokes_->setCurrentRow(std::min(row, strokes_->count() - 1));
  }
  take_->menu()->clear();
  for (const MaskStroke& stroke : named_)
    take_->menu()->addAction(QString::fromStdString(sessions::strokeText(stroke)), this,
                             [this, stroke] { Q_EMIT strokeRequested(stroke); });
  updateButtons();
}

int MaskPanel::chosen() const { return strokes_->currentRow(); }

void MaskPanel::updateButtons() {
  const bool open = case_.has_value();
  for (QWidget* each : {static_cast<QWidget*>(brush_), static_cast<QWidget*>(polygon_),
                        static_cast<QWidget*>(erase_), static_cast<QWidget*>(size_),
                        static_cast<QWidget*>(level_), static_cast<QWidget*>(saturated_)})
    each->setEnabled(open);
  name_->setEnabled(chosen() >= 0);
  copy_->setEnabled(chosen() >= 0 && cases_of_camera_ > 0);
  remove_->setEnabled(chosen() >= 0);
  take_->setEnabled(!named_.empty());
  clear_->setEnabled(open && case_->ignore_strokes != sessions::clearedStrokes(*case_));
}

void MaskPanel::askForSaturated() {
  if (!case_) return;
  MaskStroke stroke;
  stroke.kind = sessions::StrokeKind::kSaturation;
  stroke.erase = editor_.erases();
  stroke.level = level_->value();
  Q_EMIT strokeRequested(stroke);
}

void MaskPanel::nameChosen() {
  if (!case_ || chosen() < 0) return;
  MaskStrokes strokes = case_->ignore_strokes;
  std::string& name = strokes[static_cast<std::size_t>(chosen())].name;
  bool accepted = false;
  const QString given =
      QInputDialog::getText(this, tr("Name of the stroke"), tr("Name"), QLineEdit::Normal,
                            QString::fromStdString(name), &accepted);
  if (!accepted) return;
  name = given.trimmed().toStdString();
  Q_EMIT strokesRequested(strokes, tr("Name a stroke of the ignore mask"));
}

void MaskPanel::removeChosen() {
  if (!case_ || chosen() < 0) return;
  MaskStrokes strokes = case_->ignore_strokes;
  strokes.erase(strokes.begin() + chosen());
  Q_EMIT strokesRequested(strokes, tr("Remove a stroke of the ignore mask"));
}

void MaskPanel::clearAll() {
  if (case_) Q_EMIT strokesRequested(sessions::clearedStrokes(*case_), tr("Clear the ignore mask"));
}

}  // namespace boresight::ui
