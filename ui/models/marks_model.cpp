// SPDX-License-Identifier: Apache-2.0
#include "ui/models/marks_model.h"

#include <cmath>
#include <limits>
#include <utility>

#include <QBrush>
#include <QFont>
#include <QGuiApplication>
#include <QPalette>

#include "ui/models/marks_columns.h"
#include "ui/models/number_text.h"

namespace boresight::ui {
namespace {

using sessions::LinePair;
using sessions::MarkAddress;
using sessions::MarkKind;
using sessions::PointPair;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kMillimetres = 1e3;

template <class Pair>
MarkFacts commonFacts(const Pair& pair) {
  return {nullptr,      nullptr,     pair.id,         pair.comment, pair.sigma_px,
          pair.enabled, pair.locked, pair.complete(), {},           {}};
}

/// What points and lines have in common.
template <class Mark>
bool change(Mark& mark, int column, const QVariant& value) {
  switch (column) {
    case MarksModel::kOn:
      mark.enabled = value.toInt() == Qt::Checked;
      return true;
    case MarksModel::kLocked:
      mark.locked = value.toInt() == Qt::Checked;
      return true;
    case MarksModel::kName:
      mark.id = value.toString().trimmed().toStdString();
      return true;
    case MarksModel::kComment:
      mark.comment = value.toString().toStdString();
      return true;
    case MarksModel::kSigma_px: {
      bool number = false;
      const double sigma_px = value.toDouble(&number);
      if (!number || !(sigma_px > 0.0) || !std::isfinite(sigma_px)) return false;
      mark.sigma_px = sigma_px;
      return true;
    }
    default:
      return false;
  }
}

/// Coordinates can be typed for points whose side is placed.
bool changeCoordinate(PointPair& point, int column, double value) {
  if (!std::isfinite(value)) return false;
  if (column == MarksModel::kU_px || column == MarksModel::kV_px) {
    if (!point.pixel) return false;
    (*point.pixel)[column - MarksModel::kU_px] = value;
    return true;
  }
  if (column < MarksModel::kX_mm || column > MarksModel::kZ_mm || !point.point_in_station_m)
    return false;
  (*point.point_in_station_m)[column - MarksModel::kX_mm] = value / kMillimetres;
  return true;
}

QString editText(int column, const std::string& id, bool on) {
  const QString name = fromText(id);
  switch (column) {
    case MarksModel::kOn:
      return on ? MarksModel::tr("Turn %1 on").arg(name) : MarksModel::tr("Turn %1 off").arg(name);
    case MarksModel::kLocked:
      return on ? MarksModel::tr("Lock %1").arg(name) : MarksModel::tr("Unlock %1").arg(name);
    case MarksModel::kName:
      return MarksModel::tr("Rename %1").arg(name);
    case MarksModel::kComment:
      return MarksModel::tr("Comment on %1").arg(name);
    case MarksModel::kSigma_px:
      return MarksModel::tr("Sigma of %1").arg(name);
    default:
      return MarksModel::tr("Move %1").arg(name);
  }
}

}  // namespace

MarksModel::MarksModel(QObject* parent) : QAbstractTableModel(parent) {}

MarkFacts MarksModel::factsOf(int row) const {
  const auto index = static_cast<std::size_t>(row);
  if (index < marks_.points.size()) {
    const PointPair& point = marks_.points[index];
    MarkFacts facts = commonFacts(point);
    facts.point = &point;
    facts.pixel = point.pixel;
    facts.point_in_station_m = point.point_in_station_m;
    return facts;
  }
  const LinePair& line = marks_.lines[index - marks_.points.size()];
  MarkFacts facts = commonFacts(line);
  facts.line = &line;
  if (line.line) facts.pixel = line.line->start;
  if (line.edge) facts.point_in_station_m = line.edge->start_in_station_m;
  return facts;
}

int MarksModel::rowOf(const std::string& id) const {
  for (int row = 0; row < rowCount(); ++row)
    if (idOf(row) == id) return row;
  return -1;
}

bool MarksModel::standsOut(int row) const {
  const auto& solved = judged_[static_cast<std::size_t>(row)].solved;
  return solved && solved->standsOut();
}

void MarksModel::setMarks(const sessions::Marks& marks) {
  bool same_rows =
      marks.points.size() == marks_.points.size() && marks.lines.size() == marks_.lines.size();
  if (!same_rows) {
    beginResetModel();
    marks_ = marks;
    judge();
    endResetModel();
    return;
  }
  // An editor that is open and the chosen row stay.
  marks_ = marks;
  judge();
  if (rowCount() > 0) Q_EMIT dataChanged(index(0, 0), index(rowCount() - 1, kColumnCount - 1));
}

void MarksModel::setSolution(SolutionPtr solution, bool stale) {
  solution_ = std::move(solution);
  stale_ = stale;
  judge();
  if (rowCount() > 0)
    Q_EMIT dataChanged(index(0, kResidualX_px), index(rowCount() - 1, kResidualY_mm));
}

/// What the solution says of each row; by name, since rows may have come and gone.
void MarksModel::judge() {
  judged_.assign(static_cast<std::size_t>(rowCount()), {});
  if (!solution_ || !solution_->result.solution) return;
  const auto& views = solution_->marks.views;
  for (const sessions::SolvedMark& mark : solution_->result.solution->marks) {
    const int row = mark.address.view == 0 ? rowOf(sessions::markId(views, mark.address)) : -1;
    if (row >= 0) judged_[static_cast<std::size_t>(row)].solved = mark;
  }
  for (const sessions::LeftOut& left_out : solution_->left_out) {
    const int row =
        left_out.address.view == 0 ? rowOf(sessions::markId(views, left_out.address)) : -1;
    if (row >= 0) judged_[static_cast<std::size_t>(row)].left_out = left_out;
  }
}

int MarksModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(marks_.points.size() + marks_.lines.size());
}

int MarksModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kColumnCount;
}

double MarksModel::numberOf(int row, int column) const {
  const Judged& judged = judged_[static_cast<std::size_t>(row)];
  const MarkFacts facts = factsOf(row);
  if (column == kU_px || column == kV_px)
    return facts.pixel ? (*facts.pixel)[column - kU_px] : kNone;
  if (column >= kX_mm && column <= kZ_mm)
    return facts.point_in_station_m ? kMillimetres * (*facts.point_in_station_m)[column - kX_mm]
                                    : kNone;
  if (column == kSigma_px) return facts.sigma_px;
  if (column == kOn) return facts.enabled ? 0 : 1;
  if (column == kLocked) return facts.locked ? 0 : 1;
  if (column == kWithout_mm || column == kWithout_mrad) {
    if (!judged.left_out || !judged.left_out->determined) return kNone;
    return column == kWithout_mm ? judged.left_out->translation_mm : judged.left_out->rotation_mrad;
  }
  if (!judged.solved || !judged.solved->projected) return kNone;
  switch (column) {
    case kResidualX_px:
    case kResidualY_px:
      return judged.solved->residual_px[column - kResidualX_px];
    case kResidualX_mm:
    case kResidualY_mm:
      return judged.solved->residual_mm[column - kResidualX_mm];
    case kNormalized:
      return judged.solved->normalized;
    default:
      return kNone;
  }
}

QVariant MarksModel::display(int row, int column) const {
  if (column == kOn || column == kLocked) return {};
  if (column == kName) return fromText(idOf(row));
  if (column == kComment) return fromText(factsOf(row).comment);
  const double value = numberOf(row, column);
  if (column == kNormalized && standsOut(row))
    return tr("%1 !").arg(numberText(value, kMarksColumns[kNormalized].decimals));
  const Judged& judged = judged_[static_cast<std::size_t>(row)];
  if (column == kWithout_mm && judged.left_out && !judged.left_out->determined)
    return tr("no pose");
  if (column == kResidualX_px && judged.solved && !judged.solved->projected) return tr("not seen");
  return numberText(value, kMarksColumns[static_cast<std::size_t>(column)].decimals);
}

/// How a row looks: half-made pairs slanted, outliers bold, what is off or out of date dimmed.
QVariant MarksModel::state(int row, int column) const {
  const MarkFacts facts = factsOf(row);
  QFont font;
  font.setItalic(!facts.complete);
  font.setBold(column >= kResidualX_px && column <= kNormalized && standsOut(row));
  font.setStrikeOut(!facts.enabled && column == kName);
  return font;
}

QVariant MarksModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) return {};
  const int row = index.row();
  const int column = index.column();
  const ColumnInfo& info = kMarksColumns[static_cast<std::size_t>(column)];
  switch (role) {
    case Qt::DisplayRole:
      return display(row, column);
    case Qt::EditRole:
      return info.decimals < 0 ? display(row, column)
                               : QVariant(QString::number(numberOf(row, column), 'g', 10));
    case Qt::CheckStateRole:
      if (column != kOn && column != kLocked) return {};
      return numberOf(row, column) == 0.0 ? Qt::Checked : Qt::Unchecked;
    case Qt::FontRole:
      return state(row, column);
    case Qt::ForegroundRole: {
      const bool judged = column >= kResidualX_px && column <= kResidualY_mm;
      if (!(judged && stale_)) return {};
      return QGuiApplication::palette().brush(QPalette::Disabled, QPalette::Text);
    }
    case kNumberRole:
      if (column == kName || column == kComment) return display(row, column);
      return numberOf(row, column);
    default:
      return columnCell(kMarksContext, info, role);
  }
}

Qt::ItemFlags MarksModel::flags(const QModelIndex& index) const {
  Qt::ItemFlags flags = QAbstractTableModel::flags(index);
  if (!index.isValid()) return flags;
  const int column = index.column();
  if (column == kOn || column == kLocked) return flags | Qt::ItemIsUserCheckable;
  const MarkFacts facts = factsOf(index.row());
  const bool text = column == kName || column == kComment || column == kSigma_px;
  const bool coordinate =
      column == kU_px || column == kV_px || (column >= kX_mm && column <= kZ_mm);
  const bool place = facts.point && coordinate && std::isfinite(numberOf(index.row(), column));
  return (text || place) && !facts.locked ? flags | Qt::ItemIsEditable : flags;
}

bool MarksModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  const bool check = role == Qt::CheckStateRole;
  if (!index.isValid() || !(check || role == Qt::EditRole)) return false;
  if (check != (index.column() == kOn || index.column() == kLocked)) return false;
  const MarkFacts facts = factsOf(index.row());
  const std::string id = facts.id;  // the facts may go while the edit is told
  const bool on = value.toInt() == Qt::Checked;
  const QString text = editText(index.column(), id, on);
  if (facts.line) {
    LinePair line = *facts.line;
    if (!change(line, index.column(), value)) return false;
    if (!(line == *facts.line)) Q_EMIT lineEdited(id, line, text);
    return true;
  }
  PointPair point = *facts.point;
  bool number = false;
  const double typed = value.toDouble(&number);
  if (!change(point, index.column(), value) &&
      !(number && changeCoordinate(point, index.column(), typed)))
    return false;
  if (!(point == *facts.point)) Q_EMIT pointEdited(id, point, text);
  return true;
}

QVariant MarksModel::headerData(int section, Qt::Orientation orientation, int role) const {
  return columnHeader(kMarksContext, kMarksColumns, section, orientation, role);
}

}  // namespace boresight::ui
