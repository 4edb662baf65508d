// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "ui/models/rows_model.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

using Poses = std::array<std::optional<Pose>, kPoseRoles>;  ///< by role

/// One figure of each pose.
struct PoseFigure {
  QString name;
  QString help;
  std::array<QString, kPoseRoles> values;  ///< by role
};

/// The poses side by side: the name of each figure, then one column per role. Translation, rotation
/// vector and quaternion.
class PoseTableModel : public RowsModel<PoseFigure> {
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
    kRowCount,
  };

  explicit PoseTableModel(QObject* parent = nullptr);

  void setPoses(const Poses& poses);
  const std::optional<Pose>& pose(PoseRole role) const {
    return poses_[static_cast<std::size_t>(role)];
  }
  static int columnOf(PoseRole role) { return 1 + static_cast<int>(role); }

 protected:
  QVariant look(const PoseFigure& row, int column, int role) const override;

 private:
  Poses poses_;
};

/// "seed", "current", "nudged", "truth", "annotated".
QString poseRoleName(PoseRole role);

}  // namespace boresight::ui
