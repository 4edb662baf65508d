// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/pose_comparison.h"

#include <cmath>

#include <QtWidgets>

#include "core/base/math.h"
#include "sessions/evaluation/pose_error.h"
#include "ui/panels/pose_table_model.h"
#include "ui/panels/widgets.h"

namespace boresight::ui {
namespace {

constexpr double kDegree_mrad = 1e3 * kDegree_rad;

/// A row of an HTML table: name, figure, and the limit with a sign that does not rest on colour.
QString row(const QString& name, double value, const QString& unit,
            const std::optional<double>& limit = std::nullopt) {
  QString text = QStringLiteral(
                     "<tr><td>%1&nbsp;&nbsp;</td><td align='right'>%2</td><td>&nbsp;%3"
                     "</td>")
                     .arg(name, QString::number(value, 'f', 4), unit);
  if (limit) {
    const bool within = std::abs(value) <= *limit;
    text += QStringLiteral("<td>&nbsp;&nbsp;%1 %2 %3</td>")
                .arg(within ? PoseComparison::tr("within") : PoseComparison::tr("<b>beyond</b>"),
                     QString::number(*limit, 'g', 4), unit);
  }
  return text + QStringLiteral("</tr>");
}

QString table(const QString& rows) {
  return QStringLiteral("<table cellspacing='0' cellpadding='0'>%1</table>").arg(rows);
}

QString axesRow(const QString& name, const Eigen::Vector3d& values, const QString& unit) {
  return QStringLiteral("<tr><td>%1&nbsp;&nbsp;</td><td colspan='3'>%2, %3, %4 %5</td></tr>")
      .arg(name, QString::number(values.x(), 'f', 4), QString::number(values.y(), 'f', 4),
           QString::number(values.z(), 'f', 4), unit);
}

std::optional<double> limitOf(const PoseJudgement& judgement,
                              std::optional<double> sessions::Requirement::*member) {
  return judgement.requirement ? (*judgement.requirement).*member : std::nullopt;
}

std::optional<double> rotationLimit_mrad(const PoseJudgement& judgement) {
  const auto limit_deg = limitOf(judgement, &sessions::Requirement::rotation_deg);
  return limit_deg ? std::optional(*limit_deg * kDegree_mrad) : std::nullopt;
}

}  // namespace

std::optional<Matrix6d> shownCovariance(const ViewState& state) {
  const sessions::IterationTrace* shown = state.iteration();
  if (shown == nullptr || state.cursor().stage < Stage::kPose) return std::nullopt;
  const sessions::LocalizationTrace& run = *state.snapshot();
  const bool last = shown == run.iterations.back().get();
  if (last && run.finished && run.converged()) return run.covariance;
  if (run.replayed) return std::nullopt;  // a record has the last one alone
  return shown->kind == IterationKind::kRefine ? shown->refinement.covariance
                                               : shown->pnp.covariance;
}

PoseComparison::PoseComparison(QWidget* parent) : QWidget(parent) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);

  sure_ = new QGroupBox(this);
  auto* sure_layout = new QVBoxLayout(sure_);
  sigma_ = named(new QLabel(sure_), "sigma");
  sigma_->setTextFormat(Qt::RichText);
  sigma_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  sigma_->setToolTip(
      tr("From the covariance of the fit: it says how well the matches determine "
         "the pose, not whether they are right. Errors of the mesh's scale and of the "
         "calibration are not in it: the checks add them."));
  sure_layout->addWidget(sigma_);
  layout->addWidget(sure_);

  apart_ = new QGroupBox(this);
  auto* apart_layout = new QVBoxLayout(apart_);
  auto* chooser = new QHBoxLayout;
  to_ = roleBox(PoseRole::kEstimate, "differenceOf");
  from_ = roleBox(PoseRole::kTruth, "differenceFrom");
  chooser->addWidget(to_);
  chooser->addWidget(new QLabel(tr("from"), apart_));
  chooser->addWidget(from_);
  chooser->addStretch(1);
  apart_layout->addLayout(chooser);
  difference_ = named(new QLabel(apart_), "difference");
  difference_->setTextFormat(Qt::RichText);
  difference_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  difference_->setToolTip(
      tr("The second pose counts as the truth. Normal: along its camera's axis; "
         "lateral: across it; rotation: between the axes; twist: about the "
         "axis."));
  apart_layout->addWidget(difference_);
  layout->addWidget(apart_);
  setJudgement({});
}

QComboBox* PoseComparison::roleBox(PoseRole role, const char* name) {
  auto* box = new QComboBox(this);
  box->setObjectName(QString::fromUtf8(name));
  for (int i = 0; i < kPoseRoles; ++i) box->addItem(poseRoleName(static_cast<PoseRole>(i)));
  box->setCurrentIndex(static_cast<int>(role));
  connect(box, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          &PoseComparison::showDifference);
  return box;
}

void PoseComparison::setPoses(const std::array<std::optional<Pose>, kPoseRoles>& poses) {
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
  sure_->setTitle(tr("One sigma of the current pose at the %1, by the picture alone").arg(place));
  apart_->setTitle(tr("Difference at the %1").arg(place));
  showSigma();
  showDifference();
}

void PoseComparison::showSigma() {
  const auto sigma = covariance_
                         ? sessions::poseSigma(*covariance_, judgement_.camera_from_end_effector)
                         : std::nullopt;
  if (!sigma) {
    sigma_->setText(tr("No covariance: no pose has been solved here."));
    return;
  }
  const QString mm = tr("mm");
  const QString mrad = tr("mrad");
  sigma_->setText(
      table(row(tr("normal"), sigma->normal_mm, mm,
                limitOf(judgement_, &sessions::Requirement::normal_mm)) +
            row(tr("lateral"), sigma->lateral_mm, mm,
                limitOf(judgement_, &sessions::Requirement::lateral_mm)) +
            row(tr("rotation"), sigma->out_of_plane_mrad, mrad, rotationLimit_mrad(judgement_)) +
            axesRow(tr("along x, y, z"), sigma->translation_mm, mm) +
            axesRow(tr("about x, y, z"), sigma->rotation_mrad, mrad)));
}

void PoseComparison::showDifference() {
  const auto from_role = static_cast<PoseRole>(from_->currentIndex());
  const auto to_role = static_cast<PoseRole>(to_->currentIndex());
  for (const PoseRole role : {to_role, from_role})
    if (!poses_[static_cast<std::size_t>(role)]) {
      difference_->setText(tr("There is no pose \"%1\".").arg(poseRoleName(role)));
      return;
    }
  const sessions::PoseError error = sessions::poseError(
      *poses_[static_cast<std::size_t>(from_role)], *poses_[static_cast<std::size_t>(to_role)],
      judgement_.camera_from_end_effector);
  const QString mm = tr("mm");
  const QString mrad = tr("mrad");
  difference_->setText(
      table(row(tr("normal"), error.normal_mm, mm,
                limitOf(judgement_, &sessions::Requirement::normal_mm)) +
            row(tr("lateral"), error.lateral_mm, mm,
                limitOf(judgement_, &sessions::Requirement::lateral_mm)) +
            row(tr("rotation"), error.rotation_mrad, mrad, rotationLimit_mrad(judgement_)) +
            row(tr("twist"), error.in_plane_mrad, mrad) +
            row(tr("whole angle"), error.geodesic_mrad, mrad) +
            truthRows(from_role == PoseRole::kTruth || to_role == PoseRole::kTruth)));
}

/// How well a truth is known that annotations gave.
QString PoseComparison::truthRows(bool compared) const {
  const auto sigma =
      compared && judgement_.truth_covariance
          ? sessions::poseSigma(*judgement_.truth_covariance, judgement_.camera_from_end_effector)
          : std::nullopt;
  if (!sigma) return {};
  return row(tr("one sigma of the truth, normal"), sigma->normal_mm, tr("mm"),
             limitOf(judgement_, &sessions::Requirement::normal_mm)) +
         row(tr("one sigma of the truth, lateral"), sigma->lateral_mm, tr("mm"),
             limitOf(judgement_, &sessions::Requirement::lateral_mm));
}

}  // namespace boresight::ui
