// SPDX-License-Identifier: Apache-2.0
#include "ui/models/templates_model.h"

#include <array>
#include <limits>

#include <QCoreApplication>

#include "ui/models/column_info.h"
#include "ui/models/number_text.h"

namespace boresight::ui {

using sessions::MatchDetails;

namespace {

constexpr const char* kContext = "boresight::ui::TemplatesModel";

constexpr std::array<ColumnInfo, TemplatesModel::kColumnCount> kColumns = {{
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "Template"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "Number of the template, from 1."), 0},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "x, px"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel",
                       "Predicted place of its centre, pixels of the full image to the right of "
                       "the centre of the top-left pixel."),
     1},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "y, px"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel",
                       "Predicted place of its centre, pixels of the full image below the centre "
                       "of the top-left pixel."),
     1},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "Depth, m"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel",
                       "Distance of its point from the camera along the view axis, in metres."),
     3},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "Distinctness"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel",
                       "How many edge pixels hold the template in its weakest direction; 0 slides "
                       "along a straight edge."),
     1},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "dx, px"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel",
                       "From the predicted to the found place, in pixels of the full image."),
     2},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "dy, px"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel",
                       "From the predicted to the found place, in pixels of the full image."),
     2},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "Score S"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel",
                       "Weighted Hamming similarity at the found place, S+/c+ plus S-/c-; 2 is "
                       "perfect."),
     3},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "S+/c+"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel",
                       "Share of the template's edge pixels that meet an edge of the image."),
     3},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "S-/c-"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel",
                       "Share of the template's empty pixels inside its mask that meet none."),
     3},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "Margin, %"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel",
                       "By how much the best score exceeds the second peak's, in per cent of the "
                       "best; a low one may be the wrong place."),
     1},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "Residual, px"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel",
                       "Distance of the found place from where the solved pose puts the point, in "
                       "pixels of the full image."),
     2},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "Verdict"),
     QT_TRANSLATE_NOOP(
         "boresight::ui::TemplatesModel",
         "Whether the match agrees with the solved pose within the threshold."),
     -1},
    {QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel", "Border"),
     QT_TRANSLATE_NOOP("boresight::ui::TemplatesModel",
                       "The peak lies on the border of the search window: the true place may lie "
                       "beyond, and the seed's uncertainty may be stated too small."),
     -1},
}};

const ColumnInfo& columnInfo(int column) { return kColumns[static_cast<std::size_t>(column)]; }

double numberOf(const MatchDetails& one, int column) {
  switch (column) {
    case TemplatesModel::kNumber:
      return one.index + 1;
    case TemplatesModel::kX_px:
      return one.predicted_px.x();
    case TemplatesModel::kY_px:
      return one.predicted_px.y();
    case TemplatesModel::kDepth_m:
      return one.depth_m;
    case TemplatesModel::kDistinctness:
      return one.distinctness;
    case TemplatesModel::kDx_px:
      return one.moved_px().x();
    case TemplatesModel::kDy_px:
      return one.moved_px().y();
    case TemplatesModel::kScore:
      return one.score;
    case TemplatesModel::kEdgeShare:
      return one.edge_share;
    case TemplatesModel::kEmptyShare:
      return one.empty_share;
    case TemplatesModel::kMargin:
      return 100.0 * one.margin;
    case TemplatesModel::kResidual_px:
      return one.residual_px;
    case TemplatesModel::kVerdict:  // sorts inliers first
      return one.inlier ? 0.0 : one.solved ? 1.0 : one.searched ? 2.0 : 3.0;
    case TemplatesModel::kBorder:
      return one.at_border ? 0.0 : 1.0;
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

TemplatesModel::TemplatesModel(QObject* parent) : QAbstractTableModel(parent) {}

void TemplatesModel::setIteration(const sessions::IterationTrace* iteration) {
  beginResetModel();
  details_ = iteration ? sessions::matchDetails(*iteration) : std::vector<MatchDetails>();
  reached_match_ = iteration && iteration->reached >= Stage::kMatch;
  endResetModel();
}

QString TemplatesModel::verdictOf(const MatchDetails& details) {
  if (details.inlier) return tr("inlier");
  if (details.solved) return tr("outlier");
  return details.searched ? tr("found") : tr("not searched");
}

int TemplatesModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(details_.size());
}

int TemplatesModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumnCount;
}

QVariant TemplatesModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const MatchDetails& one = details(index.row());
  const ColumnInfo& info = columnInfo(index.column());
  switch (role) {
    case Qt::DisplayRole:
      if (index.column() == kVerdict) return reached_match_ ? verdictOf(one) : QString();
      if (index.column() == kBorder) return one.at_border ? tr("at border") : QString();
      return numberText(numberOf(one, index.column()), info.decimals);
    case kNumberRole:
      return numberOf(one, index.column());
    default:
      return columnCell(kContext, info, role);
  }
}

QVariant TemplatesModel::headerData(int section, Qt::Orientation orientation, int role) const {
  return columnHeader(kContext, kColumns, section, orientation, role);
}

}  // namespace boresight::ui
