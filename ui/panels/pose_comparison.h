// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <QWidget>

#include "sessions/io/dataset_file.h"
#include "ui/state/view_state.h"

class QComboBox;
class QGroupBox;
class QLabel;

namespace boresight::ui {

/// What poses are judged by.
struct PoseJudgement {
  std::optional<sessions::Requirement> requirement;
  std::optional<Pose> camera_from_end_effector;   ///< where translations are judged
  std::optional<Matrix6d> truth_covariance = {};  ///< of a truth that annotations gave
};

/// The covariance of what the state shows: the run's own at its end, else the iteration's. Nothing
/// where there is none.
std::optional<Matrix6d> shownCovariance(const ViewState& state);

/// How sure the shown pose is, and how far any two poses are apart, each figure against the
/// requirement where it names one.
class PoseComparison : public QWidget {
  Q_OBJECT

 public:
  explicit PoseComparison(QWidget* parent = nullptr);

  void setPoses(const std::array<std::optional<Pose>, kPoseRoles>& poses);
  void setCovariance(const std::optional<Matrix6d>& covariance);
  void setJudgement(const PoseJudgement& judgement);

 private:
  QComboBox* roleBox(PoseRole role, const char* name);
  void showSigma();
  void showDifference();
  QString truthRows(bool compared) const;

  QGroupBox* sure_ = nullptr;
  QGroupBox* apart_ = nullptr;
  QLabel* sigma_ = nullptr;
  QComboBox* from_ = nullptr;
  QComboBox* to_ = nullptr;
  QLabel* difference_ = nullptr;
  std::array<std::optional<Pose>, kPoseRoles> poses_;
  std::optional<Matrix6d> covariance_;
  PoseJudgement judgement_;
};

}  // namespace boresight::ui
