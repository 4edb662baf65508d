// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <QStringList>
#include <QVector>
#include <QWidget>

#include "ui_pose_comparison.h"

#include "sessions/evaluation/pose_error.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/session/pose_comparer.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

using Poses = std::array<std::optional<Pose>, kPoseRoles>;  ///< by role

/// "seed", "current", "nudged", "truth", "annotated".
QString poseRoleName(PoseRole role);
/// Lists the roles in a box.
void offerRoles(QComboBox& box, PoseRole chosen);

/// Data by which poses are judged.
struct PoseJudgement {
  std::optional<sessions::Requirement> requirement;
  sessions::PoseComparer comparer = {};           ///< of the case's station
  std::optional<Matrix6d> truth_covariance = {};  ///< of a truth from annotations
};

/// The covariance of the shown pose: the run's own at its end, else the iteration's. Empty when
/// there is none.
std::optional<Matrix6d> shownCovariance(const ViewState& state);

/// Rows of an HTML table: one sigma of a pose along and across the axis, and of its rotation, each
/// against the requirement if there is one; then along and about each axis.
QVector<QStringList> sigmaRows(const sessions::PoseSigma& sigma,
                               const std::optional<sessions::Requirement>& requirement);
/// A row of three values with their unit.
QStringList axesRow(const QString& name, const Eigen::Vector3d& values, const QString& unit);

/// Uncertainty of the shown pose, and distance between any two poses, each figure against its limit
/// in the requirement, if any.
class PoseComparison : public QWidget {
  Q_OBJECT

 public:
  explicit PoseComparison(QWidget* parent = nullptr);

  void setPoses(const Poses& poses);
  void setCovariance(const std::optional<Matrix6d>& covariance);
  void setJudgement(const PoseJudgement& judgement);

 private:
  void showSigma();
  void showDifference();
  std::optional<sessions::PoseSigma> sigmaOf(const Matrix6d& covariance, PoseRole role) const;

  Poses poses_;
  std::optional<Matrix6d> covariance_;
  PoseJudgement judgement_;
  Ui::PoseComparison ui_;
};

}  // namespace boresight::ui
