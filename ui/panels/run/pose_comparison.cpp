// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/run/pose_comparison.h"

#include <QtWidgets>

#include "core/base/math.h"
#include "ui/models/text.h"

namespace boresight::ui {
namespace {

constexpr double kDegree_mrad = 1e3 * kDegree_rad;

std::optional<double> limitOf(const std::optional<sessions::Requirement>& requirement,
                              std::optional<double> sessions::Requirement::*member) {
  return requirement ? (*requirement).*member : std::nullopt;
}

std::optional<double> rotationLimit_mrad(const std::optional<sessions::Requirement>& requirement) {
  const auto limit_deg = limitOf(requirement, &sessions::Requirement::rotation_deg);
  return limit_deg ? std::optional(*limit_deg * kDegree_mrad) : std::nullopt;
}

QString poseText(const char* text) { return PoseComparison::tr(text); }

}  // namespace

QString poseRoleName(PoseRole role) {
  constexpr std::array<const char*, kPoseRoles> kNames = {QT_TR_NOOP("seed"), QT_TR_NOOP("current"),
                                                          QT_TR_NOOP("nudged"), QT_TR_NOOP("truth"),
                                                          QT_TR_NOOP("annotated")};
  return PoseComparison::tr(kNames[static_cast<std::size_t>(role)]);
}

QStringList axesRow(const QString& name, const Eigen::Vector3d& values, const QString& unit) {
  return {name, QStringLiteral("%1, %2, %3 %4")
                    .arg(QString::number(values.x(), 'f', 4), QString::number(values.y(), 'f', 4),
                         QString::number(values.z(), 'f', 4), unit)};
}

QVector<QStringList> sigmaRows(const sessions::PoseSigma& sigma,
                               const std::optional<sessions::Requirement>& requirement) {
  return {judgedRow(poseText("normal"), sigma.normal_mm, poseText("mm"),
                    limitOf(requirement, &sessions::Requirement::normal_mm)),
          judgedRow(poseText("lateral"), sigma.lateral_mm, poseText("mm"),
                    limitOf(requirement, &sessions::Requirement::lateral_mm)),
          judgedRow(poseText("rotation"), sigma.out_of_plane_mrad, poseText("mrad"),
                    rotationLimit_mrad(requirement)),
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
  const auto offer_roles = [this](QComboBox* box, PoseRole role) {
    for (int i = 0; i < kPoseRoles; ++i) box->addItem(poseRoleName(static_cast<PoseRole>(i)));
    box->setCurrentIndex(static_cast<int>(role));
    connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
            &PoseComparison::showDifference);
  };
  offer_roles(ui_.differenceOf, PoseRole::kEstimate);
  offer_roles(ui_.differenceFrom, PoseRole::kTruth);
  setJudgement({});
}

void PoseComparison::setPoses(const Poses& poses) {
  poses_ = poses;
  showDifference();
}

void PoseComparison::setCovariance(const std::optional<Matrix6d>& covariance) {
  covariance_ = covariance;
  showSigma();
}

void PoseComparison::setJudgement(const PoseJudgement& judgement) {
  judgement_ = judgement;
  const QString place =
      QString::fromUtf8(sessions::judgedPlace(judgement_.camera_from_end_effector));
  ui_.sure->setTitle(tr("One sigma of the current pose at the %1, by the image only").arg(place));
  ui_.apart->setTitle(tr("Difference at the %1").arg(place));
  showSigma();
  showDifference();
}

void PoseComparison::showSigma() {
  const auto sigma = covariance_
                         ? sessions::poseSigma(*covariance_, judgement_.camera_from_end_effector)
                         : std::nullopt;
  if (!sigma) {
    ui_.sigma->setText(tr("No covariance: no pose has been solved here."));
    return;
  }
  ui_.sigma->setText(htmlTable(sigmaRows(*sigma, judgement_.requirement)));
}

void PoseComparison::showDifference() {
  const auto from_role = static_cast<PoseRole>(ui_.differenceFrom->currentIndex());
  const auto to_role = static_cast<PoseRole>(ui_.differenceOf->currentIndex());
  for (const PoseRole role : {to_role, from_role})
    if (!poses_[static_cast<std::size_t>(role)]) {
      ui_.difference->setText(tr("There is no pose \"%1\".").arg(poseRoleName(role)));
      return;
    }
  const sessions::PoseError error = sessions::poseError(
      *poses_[static_cast<std::size_t>(from_role)], *poses_[static_cast<std::size_t>(to_role)],
      judgement_.camera_from_end_effector);
  const auto normal_limit = limitOf(judgement_.requirement, &sessions::Requirement::normal_mm);
  const auto lateral_limit = limitOf(judgement_.requirement, &sessions::Requirement::lateral_mm);
  QVector<QStringList> rows = {judgedRow(tr("normal"), error.normal_mm, tr("mm"), normal_limit),
                               judgedRow(tr("lateral"), error.lateral_mm, tr("mm"), lateral_limit),
                               judgedRow(tr("rotation"), error.rotation_mrad, tr("mrad"),
                                         rotationLimit_mrad(judgement_.requirement)),
                               judgedRow(tr("twist"), error.in_plane_mrad, tr("mrad")),
                               judgedRow(tr("whole angle"), error.geodesic_mrad, tr("mrad"))};
  const bool of_truth = from_role == PoseRole::kTruth || to_role == PoseRole::kTruth;
  const auto sigma =
      of_truth && judgement_.truth_covariance
          ? sessions::poseSigma(*judgement_.truth_covariance, judgement_.camera_from_end_effector)
          : std::nullopt;
  if (sigma)
    rows << judgedRow(tr("one sigma of the truth, normal"), sigma->normal_mm, tr("mm"),
                      normal_limit)
         << judgedRow(tr("one sigma of the truth, lateral"), sigma->lateral_mm, tr("mm"),
                      lateral_limit);
  ui_.difference->setText(htmlTable(rows));
}

}  // namespace boresight::ui
