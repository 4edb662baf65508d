// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/pose_table_model.h"

#include "core/base/math.h"
#include "sessions/io/pose_text.h"

namespace boresight::ui {
namespace {

/// Fixed digits with a true minus kept out of zeros: "-0.000" says nothing.
QString number(double value, int decimals) {
  const QString text = QString::number(value, 'f', decimals);
  const bool zero = text.toDouble() == 0.0;
  return zero && text.startsWith(QLatin1Char('-')) ? text.mid(1) : text;
}

QString figureText(const Pose& pose, int row) {
  if (row <= PoseTableModel::kZ) return number(1e3 * pose.translation_m[row], 4);
  if (row <= PoseTableModel::kRotationZ)
    return number(rotationLog(pose.rotation)[row - PoseTableModel::kRotationX] / kDegree_rad, 5);
  const Eigen::Quaterniond q = sessions::shownQuaternion(pose.rotation);
  const std::array<double, 4> parts = {q.w(), q.x(), q.y(), q.z()};
  return number(parts[static_cast<std::size_t>(row - PoseTableModel::kQuaternionW)], 8);
}

struct RowText {
  const char* name;
  const char* help;
};
constexpr const char* kTranslationHelp =
    QT_TR_NOOP("The station's origin in the camera frame (x right, y down, z forward), mm");
constexpr const char* kRotationHelp = QT_TR_NOOP(
    "Rotation vector of camera_from_station in camera axes, deg: its direction is the axis, its "
    "length the angle");
constexpr const char* kQuaternionHelp =
    QT_TR_NOOP("Unit quaternion of camera_from_station, in the order w x y z, with w >= 0");
constexpr std::array<RowText, PoseTableModel::kRowCount> kRows = {{
    {QT_TR_NOOP("x, mm"), kTranslationHelp},
    {QT_TR_NOOP("y, mm"), kTranslationHelp},
    {QT_TR_NOOP("z, mm"), kTranslationHelp},
    {QT_TR_NOOP("turn x, deg"), kRotationHelp},
    {QT_TR_NOOP("turn y, deg"), kRotationHelp},
    {QT_TR_NOOP("turn z, deg"), kRotationHelp},
    {QT_TR_NOOP("quat. w"), kQuaternionHelp},
    {QT_TR_NOOP("quat. x"), kQuaternionHelp},
    {QT_TR_NOOP("quat. y"), kQuaternionHelp},
    {QT_TR_NOOP("quat. z"), kQuaternionHelp},
}};

std::vector<TableColumn<PoseFigure>> poseColumns() {
  std::vector<TableColumn<PoseFigure>> columns = {
      {QString(), QString(), -1, [](const PoseFigure& row) { return row.name; }}};
  for (std::size_t role = 0; role < kPoseRoles; ++role)
    columns.push_back({poseRoleName(static_cast<PoseRole>(role)), QString(), 0,
                       [role](const PoseFigure& row) { return row.values[role]; }});
  return columns;
}

}  // namespace

QString poseRoleName(PoseRole role) {
  constexpr std::array<const char*, kPoseRoles> kNames = {QT_TR_NOOP("seed"), QT_TR_NOOP("current"),
                                                          QT_TR_NOOP("nudged"), QT_TR_NOOP("truth"),
                                                          QT_TR_NOOP("annotated")};
  return PoseTableModel::tr(kNames[static_cast<std::size_t>(role)]);
}

PoseTableModel::PoseTableModel(QObject* parent) : RowsModel(poseColumns(), parent) { setPoses({}); }

void PoseTableModel::setPoses(const Poses& poses) {
  poses_ = poses;
  std::vector<PoseFigure> rows;
  for (int row = 0; row < kRowCount; ++row) {
    const RowText& text = kRows[static_cast<std::size_t>(row)];
    PoseFigure& figure = rows.emplace_back(PoseFigure{tr(text.name), tr(text.help), {}});
    for (std::size_t role = 0; role < kPoseRoles; ++role)
      figure.values[role] = poses[role] ? figureText(*poses[role], row) : QString(QChar(0x2013));
  }
  setRows(std::move(rows), true);
}

QVariant PoseTableModel::look(const PoseFigure& row, int /*column*/, int role) const {
  return role == Qt::ToolTipRole ? row.help : QVariant();
}

}  // namespace boresight::ui
