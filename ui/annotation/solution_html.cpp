// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/solution_html.h"

#include <array>
#include <cmath>

#include <QCoreApplication>
#include <QStringList>

#include "core/base/math.h"
#include "sessions/evaluation/pose_error.h"
#include "ui/models/html_table.h"
#include "ui/models/number_text.h"
#include "ui/panels/pose_comparison.h"

namespace boresight::ui {
namespace {

using sessions::MarksSolution;

constexpr double kMradPerDegree = 1e3 * kDegree_rad;

QString solutionText(const char* text) { return QCoreApplication::translate("SolutionHtml", text); }

/// In the order of `GeometryWeakness`.
constexpr std::array<const char*, 7> kWeaknesses = {"too few marks",
                                                    "no mark to spare",
                                                    "all on one line",
                                                    "all in one plane",
                                                    "all in one corner of the station",
                                                    "all at one depth",
                                                    "imprecise"};

QString warningsHtml(const sessions::CaseMarksSolution& solution) {
  QStringList items;
  for (const sessions::GeometryWarning& warning : solution.warnings)
    items << QStringLiteral("<li>%1%2</li>")
                 .arg(warning.prevents ? solutionText("<b>No pose:</b> ") : QString(),
                      fromText(warning.text).toHtmlEscaped());
  if (items.isEmpty()) return {};
  return QStringLiteral("<p><b>%1</b></p><ul style='margin-left:14px;-qt-list-indent:0'>%2</ul>")
      .arg(solutionText("Geometry"), items.join(QString()));
}

/// Where translations are judged.
QString placeText(const sessions::CaseMarks& marks) {
  return marks.camera_from_end_effector ? solutionText("end effector") : solutionText("camera");
}

QString sigmaHtml(const AnnotationAnswer& answer) {
  const MarksSolution& solution = *answer.solution->result.solution;
  const sessions::CaseMarks& marks = answer.solution->marks;
  const auto sigma = answer.covariance
                         ? sessions::poseSigma(*answer.covariance, marks.camera_from_end_effector)
                         : std::nullopt;
  if (!sigma) return {};
  const QString title = solutionText(
                            "One sigma at the %1, by the marks alone (noise %2 times what their "
                            "sigmas say)")
                            .arg(placeText(marks))
                            .arg(QString::number(solution.noise_factor, 'f', 2));
  QVector<QStringList> rows = sigmaRows(*sigma, marks.requirement);
  // Without an end effector these are the camera's own already.
  const auto at_camera = marks.camera_from_end_effector
                             ? sessions::poseSigma(*answer.covariance, std::nullopt)
                             : std::nullopt;
  if (at_camera)
    rows << axesRow(solutionText("at the camera"), at_camera->translation_mm, solutionText("mm"));
  return titledTable(title, rows);
}

QStringList poseCells(const Pose& pose) {
  const Eigen::Vector3d turn_deg = rotationLog(pose.rotation) / kDegree_rad;
  QStringList cells;
  for (int i = 0; i < 3; ++i) cells << QString::number(1e3 * pose.translation_m[i], 'f', 3);
  for (int i = 0; i < 3; ++i) cells << QString::number(turn_deg[i], 'f', 4);
  return cells;
}

QString ambiguityHtml(const sessions::CaseMarksSolution& solved) {
  const MarksSolution& solution = *solved.result.solution;
  const auto other_pose = solved.ambiguous_camera_from_station();
  if (!other_pose) return {};
  const QStringList ours = poseCells(solution.camera_from_station.front());
  const QStringList other = poseCells(*other_pose);
  const QStringList names = {solutionText("x, mm"),       solutionText("y, mm"),
                             solutionText("z, mm"),       solutionText("turn x, deg"),
                             solutionText("turn y, deg"), solutionText("turn z, deg")};
  QVector<QStringList> rows = {
      {QString(), solutionText("this pose"), solutionText("the other pose")}};
  for (int i = 0; i < names.size(); ++i) rows.append({names[i], ours[i], other[i]});
  rows.append({solutionText("rms, px"), QString::number(solution.rms_px, 'f', 3),
               QString::number(solution.ambiguous->rms_px, 'f', 3)});
  return titledTable(solutionText("Two poses explain marks in a plane"), rows);
}

QString viewsHtml(const sessions::CaseMarksSolution& solved) {
  const auto& views = solved.marks.views;
  if (views.size() < 2) return {};
  QVector<QStringList> rows;
  for (std::size_t i = 0; i < views.size(); ++i) {
    double squares_px2 = 0.0;
    int count = 0;
    for (const sessions::SolvedMark& mark : solved.result.solution->marks) {
      if (mark.address.view != i || !mark.projected) continue;
      squares_px2 += mark.residual_px.squaredNorm();
      ++count;
    }
    const double rms_px = count > 0 ? std::sqrt(squares_px2 / (2.0 * count)) : 0.0;
    rows.append({fromText(views[i].name).toHtmlEscaped(), solutionText("%1 marks").arg(count),
                 solutionText("%1 px rms").arg(QString::number(rms_px, 'f', 3))});
  }
  return titledTable(solutionText("Cameras solved together"), rows);
}

QStringList differenceRow(const QString& name, const Pose& other, const Pose& annotated,
                          const sessions::CaseMarks& marks, const QString& more) {
  const sessions::PoseError error =
      sessions::poseError(other, annotated, marks.camera_from_end_effector);
  return {name.toHtmlEscaped(), QString::number(error.normal_mm, 'f', 3),
          QString::number(error.lateral_mm, 'f', 3),
          QString::number(error.geodesic_mrad / kMradPerDegree, 'f', 4), more};
}

QString comparedHtml(const AnnotationAnswer& answer, const std::vector<ComparedPose>& others,
                     const Pose& annotated) {
  const sessions::CaseMarks& marks = answer.solution->marks;
  QVector<QStringList> rows;
  for (const ComparedPose& other : others)
    rows << differenceRow(other.name, other.camera_from_station, annotated, marks, {});
  for (const RoundAnswer& round : answer.rounds) {
    const int shared = static_cast<int>(round.repeatability.marks.size());
    const QString repeated = shared > 0
                                 ? solutionText("%1 marks, %2 px per mark and axis")
                                       .arg(shared)
                                       .arg(QString::number(round.repeatability.sigma_px, 'f', 3))
                                 : solutionText("no mark in common");
    const QString name = solutionText("round of %1").arg(fromText(round.by));
    if (round.camera_from_station)
      rows << differenceRow(name, *round.camera_from_station, annotated, marks, repeated);
    else
      rows.append({name.toHtmlEscaped(), solutionText("no pose"), QString(), QString(), repeated});
  }
  if (rows.isEmpty()) return {};
  rows.prepend({QString(), solutionText("normal, mm"), solutionText("lateral, mm"),
                solutionText("angle, deg"), QString()});
  return titledTable(solutionText("The annotated pose is from, at the %1").arg(placeText(marks)),
                     rows);
}

}  // namespace

QString solutionHeadline(const AnnotationAnswer& answer, bool stale) {
  if (!answer.solution)
    return stale ? solutionText("Solving ...") : solutionText("Nothing is marked yet.");
  const sessions::MarksResult& result = answer.solution->result;
  QString text = fromText(result.reason);
  if (result.solution)
    text = solutionText("Solved from %1 marks, %2 px rms.")
               .arg(result.solution->marks.size())
               .arg(QString::number(result.solution->rms_px, 'f', 3));
  else if (text.isEmpty())
    text = solutionText("Nothing is marked yet.");
  return stale ? solutionText("Stale, solving anew: %1").arg(text) : text;
}

QString geometryMeterText(const AnnotationAnswer& answer) {
  if (!answer.solution) return {};
  QStringList weak;
  for (const sessions::GeometryWarning& warning : answer.solution->warnings)
    weak << (warning.weakness == sessions::GeometryWeakness::kImprecise
                 ? solutionText("one sigma is %1").arg(fromText(answer.solution->sigmaExcess()))
                 : solutionText(kWeaknesses[static_cast<std::size_t>(warning.weakness)]));
  const QChar sign(weak.isEmpty() ? 0x2713 : 0x26a0);
  return solutionText("Geometry: %1 %2")
      .arg(sign)
      .arg(weak.isEmpty() ? solutionText("nothing weak") : weak.join(QStringLiteral(", ")));
}

QString solutionHtml(const AnnotationAnswer& answer, const std::vector<ComparedPose>& others) {
  if (!answer.solution) return {};
  QString html = warningsHtml(*answer.solution);
  const auto annotated = answer.solution->camera_from_station();
  if (!annotated) return html;
  html += sigmaHtml(answer);
  html += ambiguityHtml(*answer.solution);
  html += viewsHtml(*answer.solution);
  html += comparedHtml(answer, others, *annotated);
  return html;
}

}  // namespace boresight::ui
