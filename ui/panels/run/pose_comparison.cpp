// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/run/pose_comparison.h"

#include <QtWidgets>

#include "core/base/math.h"
#include "ui/models/text.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr double kDegree_mrad = 1e3 * kDegree_rad;

/// The limits in the units of the rows; none without a requirement.
struct RowLimits {
  std::optional<double> normal_mm, lateral_mm, rotation_mrad;

  explicit RowLimits(const std::optional<sessions::Requirement>& requirement) {
    if (!requirement) return;
    normal_mm = requirement->normal_mm;
    lateral_mm = requirement->lateral_mm;
    if (requirement->rotation_deg) rotation_mrad = *requirement->rotation_deg * kDegree_mrad;
  }
};

QString poseText(const char* text) { return PoseComparison::tr(text); }

}  // namespace

QString poseRoleName(PoseRole role) {
  constexpr std::array<const char*, kPoseRoles> kNames = {QT_TR_NOOP("seed"), QT_TR_NOOP("current"),
                                                          QT_TR_NOOP("nudged"), QT_TR_NOOP("truth"),
                                                          QT_TR_NOOP("annotated")};
  return PoseComparison::tr(kNames[static_cast<std::size_t>(role)]);
}

void offerRoles(QComboBox& box, PoseRole chosen) {
  for (int i = 0; i < kPoseRoles; ++i) box.addItem(poseRoleName(static_cast<PoseRole>(i)));
  box.setCurrentIndex(static_cast<int>(chosen));
}

QStringList axesRow(const QString& name, const Eigen::Vector3d& values, const QString& unit) {
  return {name, QStringLiteral("%1, %2, %3 %4")
                    .arg(QString::number(values.x(), 'f', 4), QString::number(values.y(), 'f', 4),
                         QString::number(values.z(), 'f', 4), unit)};
}

QVector<QStringList> sigmaRows(const sessions::PoseSigma& sigma,
                               const std::optional<sessions::Requirement>& requirement) {
  const RowLimits limits(requirement);
  return {judgedRow(poseText("normal"), sigma.normal_mm, poseText("mm"), limits.normal_mm),
          judgedRow(poseText("lateral"), sigma.lateral_mm, poseText("mm"), limits.lateral_mm),
          judgedRow(poseText("rotation"), sigma.out_of_plane_mrad, poseText("mrad"),
                    limits.rotation_mrad),
          axesRow(poseText("along x, y, z"), sigma.translation_mm, poseText("mm")),
          axesRow(poseText("about x, y, z"), sigma.rotation_mrad, poseText("mrad"))};
}

std::optional<Matrix6d> shownCovariance(const ViewState& state) {
  const auto shown = state.iteration();
  if (shown == nullptr || state.cursor().stage < Stage::kPose) return std::nullopt;
  const sessions::LocalizationTrace& run = *state.snapshot();
  const bool last = shown == run.iterations.back();
  if (last && run.finished && run.converged()) return run.covariance;
  if (run.replayed) return std::nullopt;  // a record has the last one alone
  return shown->kind == IterationKind::kRefine ? shown->refinement.covariance
                                               : shown->pnp.covariance;
}

PoseComparison::PoseComparison(QWidget* parent) : QWidget(parent) {
  ui_.setupUi(this);
  offerRoles(*ui_.differenceOf, PoseRole::kEstimate);
  offerRoles(*ui_.differenceFrom, PoseRole::kTruth);
  for (QComboBox* box : {ui_.differenceOf, ui_.differenceFrom})
    connect(box, kIndexChanged, this, &PoseComparison::showDifference);
  setJudgement({});
}

void PoseComparison::setPoses(const Poses& poses) {
  poses_ = poses;
  showSigma();
  showDifference();
}

void PoseComparison::setCovariance(const std::optional<Matrix6d>& covariance) {
  covariance_ = covariance;
  showSigma();
}

void PoseComparison::setJudgement(const PoseJudgement& judgement) {
  judgement_ = judgement;
  const QString place = QString::fromUtf8(sessions::judgedPlace(judgement_.comparer.endEffector()));
  ui_.sure->setTitle(tr("One sigma of the current pose at the %1, by the image only").arg(place));
  ui_.apart->setTitle(judgement_.comparer.symmetric()
                          ? tr("Difference at the %1, by the declared symmetries").arg(place)
                          : tr("Difference at the %1").arg(place));
  showSigma();
  showDifference();
}

/// One sigma of the pose of a role as it is judged; empty where there is no such pose.
std::optional<sessions::PoseSigma> PoseComparison::sigmaOf(const Matrix6d& covariance,
                                                           PoseRole role) const {
  const sessions::PoseComparer& comparer = judgement_.comparer;
  const auto& pose = poses_[static_cast<std::size_t>(role)];
  return sessions::poseSigma(pose ? comparer.determined(covariance, *pose) : covariance,
                             comparer.endEffector());
}

void PoseComparison::showSigma() {
  const auto sigma = covariance_ ? sigmaOf(*covariance_, PoseRole::kEstimate) : std::nullopt;
  ui_.sigma->setText(sigma ? htmlTable(sigmaRows(*sigma, judgement_.requirement))
                           : tr("No covariance: no pose has been solved here."));
}

void PoseComparison::showDifference() {
  const auto from_role = static_cast<PoseRole>(ui_.differenceFrom->currentIndex());
  const auto to_role = static_cast<PoseRole>(ui_.differenceOf->currentIndex());
  for (const PoseRole role : {to_role, from_role})
    if (!poses_[static_cast<std::size_t>(role)]) {
      ui_.difference->setText(tr("There is no pose \"%1\".").arg(poseRoleName(role)));
      return;
    }
  const sessions::PoseError error = judgement_.comparer.difference(
      *poses_[static_cast<std::size_t>(from_role)], *poses_[static_cast<std::size_t>(to_role)]);
  const RowLimits limits(judgement_.requirement);
  QVector<QStringList> rows = {
      judgedRow(tr("normal"), error.normal_mm, tr("mm"), limits.normal_mm),
      judgedRow(tr("lateral"), error.lateral_mm, tr("mm"), limits.lateral_mm),
      judgedRow(tr("rotation"), error.rotation_mrad, tr("mrad"), limits.rotation_mrad),
      judgedRow(tr("twist"), error.in_plane_mrad, tr("mrad")),
      judgedRow(tr("whole angle"), error.geodesic_mrad, tr("mrad"))};
  const bool of_truth = from_role == PoseRole::kTruth || to_role == PoseRole::kTruth;
  const auto sigma = of_truth && judgement_.truth_covariance
                         ? sigmaOf(*judgement_.truth_covariance, PoseRole::kTruth)
                         : std::nullopt;
  if (sigma)
    rows << judgedRow(tr("one sigma of the truth, normal"), sigma->normal_mm, tr("mm"),
                      limits.normal_mm)
         << judgedRow(tr("one sigma of the truth, lateral"), sigma->lateral_mm, tr("mm"),
                      limits.lateral_mm);
  ui_.difference->setText(htmlTable(rows));
}

}  // namespace boresight::ui
