// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/frames_panel.h"

#include <algorithm>

#include <QtWidgets>

#include "ui/models/text.h"
#include "ui/state/view_state.h"
#include "ui/widgets/column_fitter.h"

namespace boresight::ui {
namespace {

enum Column { kFrame, kPlace, kSigma_mm, kSigma_mrad, kSource, kComment, kColumns };
constexpr int kRow = Qt::UserRole;

QString placeText(const sessions::FrameRow& row) {
  if (!row.transform) return {};
  const Eigen::Vector3d place_mm = 1e3 * row.parent_from_frame.translation_m;
  return QStringLiteral("%1  %2  %3")
      .arg(numberText(place_mm.x(), 1), numberText(place_mm.y(), 1), numberText(place_mm.z(), 1));
}

/// The largest sigma of an axis, in mm or, of the rotation, in mrad.
QString sigmaText(const sessions::FrameRow& row, bool of_rotation) {
  if (!row.transform) return {};
  if (!row.sigma) return FramesPanel::tr("exact");
  return numberText(1e3 * row.sigma->segment<3>(of_rotation ? 0 : 3).maxCoeff(), 2);
}

QTreeWidgetItem* itemOf(const sessions::FrameRow& row, int index) {
  auto* item = new QTreeWidgetItem;
  item->setData(kFrame, kRow, index);
  item->setText(kFrame, fromText(sessions::frameText(row.frame)));
  item->setText(kPlace, placeText(row));
  item->setText(kSigma_mm, sigmaText(row, false));
  item->setText(kSigma_mrad, sigmaText(row, true));
  if (!row.transform) return item;
  const auto source = static_cast<std::size_t>(row.transform->origin);
  item->setText(kSource, fromText(sessions::kTransformSourceNames[source]));
  item->setText(kComment, fromText(row.transform->comment));
  const QString file = fromText(row.transform->file.string());
  for (int column = 0; column < kColumns; ++column) item->setToolTip(column, file);
  return item;
}

}  // namespace

FramesPanel::FramesPanel(ViewState& state) : state_(state) {
  ui_.setupUi(this);
  new ColumnFitter(*ui_.frames, {kComment, kSource, kSigma_mrad, kSigma_mm});
  connect(ui_.addFrames, &QPushButton::clicked, this, &FramesPanel::addRequested);
  connect(ui_.removeFrame, &QPushButton::clicked, this, [this] {
    if (const auto chosen = removable()) Q_EMIT removeRequested(*chosen);
  });
  connect(ui_.frames, &QTreeWidget::currentItemChanged, this, &FramesPanel::showChosen);
  state_.onChange(ViewChange::kCase, this, &FramesPanel::showCase);
  showCase();
}

void FramesPanel::showCase() {
  ui_.frames->clear();
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  rows_ = loaded_case ? sessions::frameRows(sessions::framesOf(loaded_case->source))
                      : std::vector<sessions::FrameRow>();
  std::vector<QTreeWidgetItem*> items;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    items.push_back(itemOf(rows_[i], static_cast<int>(i)));
    if (rows_[i].parent < 0)
      ui_.frames->addTopLevelItem(items.back());
    else
      items[static_cast<std::size_t>(rows_[i].parent)]->addChild(items.back());
  }
  ui_.frames->expandAll();
  for (int i = 0; i < kColumns; ++i) ui_.frames->resizeColumnToContents(i);
  ui_.addFrames->setEnabled(loaded_case != nullptr);
  showChosen();
}

std::optional<sessions::FrameTransform> FramesPanel::removable() const {
  const QTreeWidgetItem* item = ui_.frames->currentItem();
  if (!item || !state_.currentCase()) return std::nullopt;
  const auto& transform =
      rows_[static_cast<std::size_t>(item->data(kFrame, kRow).toInt())].transform;
  const auto& own = state_.currentCase()->source.frames;
  if (!transform || std::find(own.begin(), own.end(), *transform) == own.end()) return std::nullopt;
  return transform;
}

void FramesPanel::showChosen() { ui_.removeFrame->setEnabled(removable().has_value()); }

}  // namespace boresight::ui
