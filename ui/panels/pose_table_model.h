// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <QAbstractTableModel>

#include "ui/state/view_state.h"

namespace boresight::ui {

/// The poses side by side, one column per role, in every form that people read: translation,
/// rotation vector, quaternion, matrix. Values, no state of its own.
class PoseTableModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Row {
    kX,
    kY,
    kZ,
    kRotationX,
    kRotationY,
    kRotationZ,
    kQuaternionW,
    kQuaternionX,
    kQuaternionY,
    kQuaternionZ,
    kMatrixRow1,
    kMatrixRow2,
    kMatrixRow3,
    kMatrixRow4,
    kRowCount,
  };

  using QAbstractTableModel::QAbstractTableModel;

  void setPoses(const std::array<std::optional<Pose>, kPoseRoles>& poses);
  const std::optional<Pose>& pose(PoseRole role) const {
    return poses_[static_cast<std::size_t>(role)];
  }

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  QVariant headerData(int section, Qt::Orientation orientation,
                      int role = Qt::DisplayRole) const override;

 private:
  std::array<std::optional<Pose>, kPoseRoles> poses_;
};

/// "seed", "current", "nudged", "truth", "annotated", for people.
QString poseRoleName(PoseRole role);

}  // namespace boresight::ui
