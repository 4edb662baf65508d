// SPDX-License-Identifier: Apache-2.0
#include "ui/models/annotations_model.h"

#include <cmath>
#include <optional>
#include <utility>

#include <QtWidgets>

#include "sessions/text/units.h"
#include "ui/models/text.h"

namespace boresight::ui {
namespace {

using sessions::kMillimetres;
using sessions::kUnknown;
using sessions::LinePair;
using sessions::PointPair;

template <class Pair>
AnnotationRow commonRow(const Pair& pair) {
  AnnotationRow row;
  row.id = pair.id;
  row.comment = pair.comment;
  row.sigma_px = pair.sigma_px;
  row.enabled = pair.enabled;
  row.locked = pair.locked;
  row.complete = pair.complete();
  return row;
}

using AnnotationRef = const AnnotationRow&;
using Solved = const sessions::SolvedAnnotation&;

auto solved(double (*value)(Solved)) {
  return [value](AnnotationRef annotation) {
    return annotation.solved && annotation.solved->projected ? value(*annotation.solved) : kUnknown;
  };
}
auto leftOut(double sessions::LeftOut::*value) {
  return [value](AnnotationRef annotation) {
    return annotation.left_out && annotation.left_out->determined ? (*annotation.left_out).*value
                                                                  : kUnknown;
  };
}
auto pixel(int axis) {
  return [axis](AnnotationRef annotation) {
    return annotation.pixel ? (*annotation.pixel)[axis] : kUnknown;
  };
}
auto coordinate(int axis) {
  return [axis](AnnotationRef annotation) {
    return annotation.point_in_station_m ? kMillimetres * (*annotation.point_in_station_m)[axis]
                                         : kUnknown;
  };
}

std::vector<TableColumn<AnnotationRow>> annotationColumns() {
  constexpr auto tr = [](const char* text) { return AnnotationsModel::tr(text); };
  return {
      {tr("On"), tr("Whether the annotation is used by the solver."), -1,
       [](AnnotationRef) { return QString(); },
       [](AnnotationRef annotation) { return annotation.enabled ? 0 : 1; }},
      {tr("Name"), tr("Name; a landmark has the same name in all images. Double click renames."),
       -1, [](AnnotationRef annotation) { return fromText(annotation.id); }},
      {tr("u, px"),
       tr("Annotated position, pixels to the right of the centre of the top-left pixel; of a line "
          "its first point."),
       2, pixel(0)},
      {tr("v, px"),
       tr("Annotated position, pixels below the centre of the top-left pixel; of a line its first "
          "point."),
       2, pixel(1)},
      {tr("X, mm"), tr("Point of the station, station frame; of a line the edge's start."), 3,
       coordinate(0)},
      {tr("Y, mm"), tr("Point of the station, station frame; of a line the edge's start."), 3,
       coordinate(1)},
      {tr("Z, mm"), tr("Point of the station, station frame; of a line the edge's start."), 3,
       coordinate(2)},
      {tr("Station place"),
       tr("Feature of the station there: corner, circle centre, edge, or bare surface."), -1,
       [](AnnotationRef annotation) { return annotation.station_kind; }},
      {tr("dx, px"),
       tr("Seen minus predicted, to the right; of a line the distance of its first end across the "
          "edge."),
       2, solved([](Solved annotation) { return annotation.residual_px[0]; })},
      {tr("dy, px"),
       tr("Seen minus predicted, downwards; of a line the distance of its second end across the "
          "edge."),
       2, solved([](Solved annotation) { return annotation.residual_px[1]; })},
      {tr("By scatter"),
       tr("Residual divided by its standard deviation as the scatter of all residuals shows it, "
          "whatever sigmas are stated; above 3: an outlier."),
       1, solved([](Solved annotation) { return annotation.normalized; })},
      {tr("Middle without, mm"),
       tr("Shift of the annotations' centre when the pose is solved without this annotation, in "
          "millimetres."),
       3, leftOut(&sessions::LeftOut::translation_mm)},
      {tr("Without, mrad"),
       tr("Rotation of the pose when it is solved without this annotation, in milliradians."), 3,
       leftOut(&sessions::LeftOut::rotation_mrad)},
      {tr("dx, mm"), tr("The same at the annotation's distance from the camera, in millimetres."),
       3, solved([](Solved annotation) { return annotation.residual_mm[0]; })},
      {tr("dy, mm"), tr("The same at the annotation's distance from the camera, in millimetres."),
       3, solved([](Solved annotation) { return annotation.residual_mm[1]; })},
      {tr("Sigma, px"),
       tr("Standard deviation of the pixel position per axis; of a line, of either end across the "
          "edge."),
       2, [](AnnotationRef annotation) { return annotation.sigma_px; }},
      {tr("Lock"), tr("A locked annotation cannot be moved or removed."), -1,
       [](AnnotationRef) { return QString(); },
       [](AnnotationRef annotation) { return annotation.locked ? 0 : 1; }},
      {tr("Comment"), tr("Comment on the annotation. Double click edits."), -1,
       [](AnnotationRef annotation) { return fromText(annotation.comment); }},
  };
}

/// Changes a field that points and lines have in common.
template <class Mark>
bool change(Mark& annotation, int column, const QVariant& value) {
  switch (column) {
    case AnnotationsModel::kOn:
      annotation.enabled = value.toInt() == Qt::Checked;
      return true;
    case AnnotationsModel::kLocked:
      annotation.locked = value.toInt() == Qt::Checked;
      return true;
    case AnnotationsModel::kName:
      annotation.id = value.toString().trimmed().toStdString();
      return true;
    case AnnotationsModel::kComment:
      annotation.comment = value.toString().toStdString();
      return true;
    case AnnotationsModel::kSigma_px: {
      const std::optional<double> sigma_px = typedNumber(value.toString());
      if (!sigma_px || !(*sigma_px > 0.0)) return false;
      annotation.sigma_px = *sigma_px;
      return true;
    }
    default:
      return false;
  }
}

/// Coordinates can be typed for points whose side is placed.
bool changeCoordinate(PointPair& point, int column, double value) {
  using Model = AnnotationsModel;
  const bool in_image = column == Model::kU_px || column == Model::kV_px;
  const bool in_station = column >= Model::kX_mm && column <= Model::kZ_mm;
  if (in_image && point.pixel)
    (*point.pixel)[column - Model::kU_px] = value;
  else if (in_station && point.point_in_station_m)
    (*point.point_in_station_m)[column - Model::kX_mm] = value / kMillimetres;
  else
    return false;
  return true;
}

/// Name of an edit; %1 is the annotation.
QString editText(int column, bool on) {
  constexpr auto tr = [](const char* text) { return AnnotationsModel::tr(text); };
  switch (column) {
    case AnnotationsModel::kOn:
      return on ? tr("Turn %1 on") : tr("Turn %1 off");
    case AnnotationsModel::kLocked:
      return on ? tr("Lock %1") : tr("Unlock %1");
    case AnnotationsModel::kName:
      return tr("Rename %1");
    case AnnotationsModel::kComment:
      return tr("Comment on %1");
    case AnnotationsModel::kSigma_px:
      return tr("Sigma of %1");
    default:
      return tr("Move %1");
  }
}

/// Filters of the list, in the order of `Show`.
struct AnnotationChoice {
  const char* name;
  bool (*holds)(AnnotationRef annotation);
};
constexpr AnnotationChoice kAnnotationChoices[] = {
    {QT_TR_NOOP("All"), [](AnnotationRef) { return true; }},
    {QT_TR_NOOP("In use"),
     [](AnnotationRef annotation) { return annotation.enabled && annotation.complete; }},
    {QT_TR_NOOP("Off"), [](AnnotationRef annotation) { return !annotation.enabled; }},
    {QT_TR_NOOP("Incomplete"), [](AnnotationRef annotation) { return !annotation.complete; }},
    {QT_TR_NOOP("Outliers"), [](AnnotationRef annotation) { return annotation.isOutlier(); }},
    {QT_TR_NOOP("Lines"), [](AnnotationRef annotation) { return annotation.line != nullptr; }},
};

}  // namespace

AnnotationsModel::AnnotationsModel() : RowsModel(annotationColumns()) {}

int AnnotationsModel::rowOf(const std::string& id) const {
  return firstRow([&id](const AnnotationRow& row) { return row.id == id; });
}

void AnnotationsModel::setAnnotations(const sessions::Annotations& annotations) {
  annotations_ = annotations;
  fillRows();
}

void AnnotationsModel::setSolution(SolutionPtr solution, bool stale) {
  solution_ = std::move(solution);
  stale_ = stale;
  fillRows();
}

void AnnotationsModel::setMesh(std::shared_ptr<const sessions::MeshSnapper> mesh) {
  mesh_ = std::move(mesh);
  kinds_.clear();
  fillRows();
}

QString AnnotationsModel::stationKind(const AnnotationRow& row) {
  if (!mesh_ || !row.point_in_station_m) return {};
  if (row.line) return tr("edge");
  const Eigen::Vector3d& point_m = *row.point_in_station_m;
  const auto [known, added] = kinds_.try_emplace({point_m.x(), point_m.y(), point_m.z()});
  if (!added) return known->second;
  const auto kind = mesh_->kindAt(point_m);
  known->second = !kind                                      ? tr("surface")
                  : *kind == sessions::MeshSnapKind::kVertex ? tr("corner")
                  : *kind == sessions::MeshSnapKind::kCircle ? tr("circle centre")
                                                             : tr("edge");
  return known->second;
}

/// Results are matched to rows by name, since rows may have been added or removed since. An open
/// editor and the chosen row stay while the number of rows is the same.
void AnnotationsModel::fillRows() {
  std::vector<AnnotationRow> rows;
  for (const PointPair& point : annotations_.points) {
    AnnotationRow& row = rows.emplace_back(commonRow(point));
    row.point = &point;
    row.pixel = point.pixel;
    row.point_in_station_m = point.point_in_station_m;
  }
  for (const LinePair& line : annotations_.lines) {
    AnnotationRow& row = rows.emplace_back(commonRow(line));
    row.line = &line;
    if (line.line) row.pixel = line.line->start;
    if (line.edge) row.point_in_station_m = line.edge->start_in_station_m;
  }
  for (AnnotationRow& row : rows) row.station_kind = stationKind(row);
  if (solution_ && solution_->result.solution) {
    const auto fill = [this, &rows](const auto& judged, auto member) {
      for (const auto& item : judged)
        for (AnnotationRow& row : rows)
          if (item.address.view == 0 &&
              row.id == sessions::annotationId(solution_->annotations.views, item.address))
            row.*member = item;
    };
    fill(solution_->result.solution->annotations, &AnnotationRow::solved);
    fill(solution_->left_out, &AnnotationRow::left_out);
  }
  const bool same_count = static_cast<int>(rows.size()) == rowCount();
  setRows(std::move(rows), same_count);
}

/// Incomplete pairs are in italics, outliers bold, disabled annotations struck out, outdated
/// results dimmed.
QVariant AnnotationsModel::look(const AnnotationRow& row, int column, int role) const {
  const bool switches = column == kOn || column == kLocked;
  switch (role) {
    case Qt::DisplayRole:
      if (column == kNormalized && row.isOutlier())
        return tr("%1 !").arg(numberText(row.solved->normalized, 1));
      if (column == kWithout_mm && row.left_out && !row.left_out->determined) return tr("no pose");
      if (column == kResidualX_px && row.solved && !row.solved->projected) return tr("not seen");
      return {};
    case Qt::EditRole: {
      const QVariant value = valueOf(row, column);
      return value.userType() == QMetaType::QString ? value
                                                    : QString::number(value.toDouble(), 'g', 10);
    }
    case Qt::CheckStateRole:
      if (!switches) return {};
      return (column == kOn ? row.enabled : row.locked) ? Qt::Checked : Qt::Unchecked;
    case Qt::FontRole: {
      QFont font;
      font.setItalic(!row.complete);
      font.setBold(column >= kResidualX_px && column <= kNormalized && row.isOutlier());
      font.setStrikeOut(!row.enabled && column == kName);
      return font;
    }
    case Qt::ForegroundRole:
      if (!stale_ || column < kResidualX_px || column > kResidualY_mm) return {};
      return QGuiApplication::palette().brush(QPalette::Disabled, QPalette::Text);
    default:
      return {};
  }
}

QStringList AnnotationsModel::showNames() {
  QStringList names;
  for (const AnnotationChoice& each : kAnnotationChoices) names << tr(each.name);
  return names;
}

bool AnnotationsModel::isShown(int row, Show show) const {
  return kAnnotationChoices[static_cast<std::size_t>(show)].holds(at(row));
}

Qt::ItemFlags AnnotationsModel::flags(const QModelIndex& index) const {
  Qt::ItemFlags flags = QAbstractTableModel::flags(index);
  if (!index.isValid()) return flags;
  const int column = index.column();
  if (column == kOn || column == kLocked) return flags | Qt::ItemIsUserCheckable;
  const AnnotationRow& annotation = at(index.row());
  const bool text = column == kName || column == kComment || column == kSigma_px;
  const bool place = annotation.point && column >= kU_px && column <= kZ_mm &&
                     std::isfinite(valueOf(annotation, column).toDouble());
  return (text || place) && !annotation.locked ? flags | Qt::ItemIsEditable : flags;
}

bool AnnotationsModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  const bool check = role == Qt::CheckStateRole;
  if (!index.isValid() || !(check || role == Qt::EditRole)) return false;
  if (check != (index.column() == kOn || index.column() == kLocked)) return false;
  const AnnotationRow& annotation = at(index.row());
  const std::string id = annotation.id;  // the row may be removed while the edit is reported
  const QString text =
      editText(index.column(), value.toInt() == Qt::Checked).arg(fromText(annotation.id));
  if (annotation.line) {
    LinePair line = *annotation.line;
    if (!change(line, index.column(), value)) return false;
    if (!(line == *annotation.line)) Q_EMIT lineEdited(id, line, text);
    return true;
  }
  PointPair point = *annotation.point;
  const std::optional<double> typed = typedNumber(value.toString());
  if (!change(point, index.column(), value) &&
      !(typed && changeCoordinate(point, index.column(), *typed)))
    return false;
  if (!(point == *annotation.point)) Q_EMIT pointEdited(id, point, text);
  return true;
}

}  // namespace boresight::ui
