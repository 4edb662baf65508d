// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/pose_table_model.h"

#include <cmath>

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

QString matrixRow(const Pose& pose, int row) {
  if (row == 3) return QStringLiteral("0  0  0  1");
  const Eigen::Matrix3d rotation = pose.matrix();
  const QString gap = QStringLiteral("  ");
  return number(rotation(row, 0), 6) + gap + number(rotation(row, 1), 6) + gap +
         number(rotation(row, 2), 6) + gap + number(pose.translation_m[row], 7);
}

QString cell(const Pose& pose, int row) {
  if (row <= PoseTableModel::kZ) return number(1e3 * pose.translation_m[row], 4);
  if (row <= PoseTableModel::kRotationZ)
    return number(rotationLog(pose.rotation)[row - PoseTableModel::kRotationX] / kDegree_rad, 5);
  if (row <= PoseTableModel::kQuaternionZ) {
    const Eigen::Quaterniond q = sessions::shownQuaternion(pose.rotation);
    const std::array<double, 4> parts = {q.w(), q.x(), q.y(), q.z()};
    return number(parts[static_cast<std::size_t>(row - PoseTableModel::kQuaternionW)], 8);
  }
  return matrixRow(pose, row - PoseTableModel::kMatrixRow1);
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
constexpr const char* kMatrixHelp =
    QT_TR_NOOP("camera_from_station as a 4x4 matrix, row by row; its last column is in metres");
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
    {QT_TR_NOOP("matrix row 1, m"), kMatrixHelp},
    {QT_TR_NOOP("matrix row 2, m"), kMatrixHelp},
    {QT_TR_NOOP("matrix row 3, m"), kMatrixHelp},
    {QT_TR_NOOP("matrix row 4"), kMatrixHelp},
}};

}  // namespace

QString poseRoleName(PoseRole role) {
  constexpr std::array<const char*, kPoseRoles> kNames = {QT_TR_NOOP("seed"), QT_TR_NOOP("current"),
                                                          QT_TR_NOOP("nudged"), QT_TR_NOOP("truth"),
                                                          QT_TR_NOOP("annotated")};
  return PoseTableModel::tr(kNames[static_cast<std::size_t>(role)]);
}

void PoseTableModel::setPoses(const std::array<std::optional<Pose>, kPoseRoles>& poses) {
  poses_ = poses;
  Q_EMIT dataChanged(index(0, 0), index(kRowCount - 1, kPoseRoles - 1));
}

int PoseTableModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kRowCount;
}

int PoseTableModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : kPoseRoles;
}

QVariant PoseTableModel::data(const QModelIndex& index, int role) const {
  if (!checkIndex(index, CheckIndexOption::IndexIsValid)) return {};
  const auto& pose = poses_[static_cast<std::size_t>(index.column())];
  switch (role) {
    case Qt::DisplayRole:
      return pose ? cell(*pose, index.row()) : QString(QChar(0x2013));
    case Qt::TextAlignmentRole:
      return static_cast<int>(Qt::AlignRight | Qt::AlignVCenter);
    case Qt::ToolTipRole:
      return PoseTableModel::tr(kRows[static_cast<std::size_t>(index.row())].help);
    default:
      return {};
  }
}

QVariant PoseTableModel::headerData(int section, Qt::Orientation orientation, int role) const {
  const bool rows = orientation == Qt::Vertical;
  if (section < 0 || section >= (rows ? static_cast<int>(kRowCount) : kPoseRoles)) return {};
  if (rows) {
    const RowText& row = kRows[static_cast<std::size_t>(section)];
    if (role == Qt::DisplayRole) return PoseTableModel::tr(row.name);
    if (role == Qt::ToolTipRole) return PoseTableModel::tr(row.help);
    return {};
  }
  if (role == Qt::DisplayRole) return poseRoleName(static_cast<PoseRole>(section));
  return {};
}

}  // namespace boresight::ui
