// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/solution_html.h"

#include <array>
#include <cmath>

#include <QCoreApplication>
#include <QStringList>

#include "core/base/math.h"
#include "sessions/evaluation/pose_error.h"
#include "ui/models/number_text.h"

namespace boresight::ui {
namespace {

using sessions::MarksSolution;

constexpr double kMradPerDegree = 1e3 * kDegree_rad;

QString solutionText(const char* text) { return QCoreApplication::translate("SolutionHtml", text); }

QString cell(const QString& text, bool number = false) {
  return QStringLiteral("<td%1>%2&nbsp;&nbsp;</td>")
      .arg(number ? QStringLiteral(" align='right'") : QString(), text);
}

QString rowOf(const QStringList& cells) {
  return QStringLiteral("<tr>%1</tr>").arg(cells.join(QString()));
}

QString table(const QString& title, const QStringList& rows) {
  if (rows.isEmpty()) return {};
  return QStringLiteral("<p><b>%1</b></p><table cellspacing='0' cellpadding='1'>%2</table>")
      .arg(title, rows.join(QString()));
}

QString judged(double value, const std::optional<double>& limit, const QString& unit) {
  if (!limit) return {};
  const QString text = QStringLiteral("%1 %2").arg(QString::number(*limit, 'g', 4), unit);
  return std::abs(value) <= *limit ? solutionText("within %1").arg(text)
                                   : solutionText("<b>beyond %1</b>").arg(text);
}

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
  const sessions::Requirement& required = marks.requirement;
  std::optional<double> rotation_mrad;
  if (required.rotation_deg) rotation_mrad = *required.rotation_deg * kMradPerDegree;
  const QString mm = solutionText("mm");
  const QString mrad = solutionText("mrad");
  const auto line = [](const QString& name, double value, const QString& unit,
                       const QString& verdict) {
    return rowOf(
        {cell(name), cell(QString::number(value, 'f', 4), true), cell(unit), cell(verdict)});
  };
  const auto axes = [](const QString& name, const Eigen::Vector3d& values, const QString& unit) {
    return QStringLiteral("<tr>%1<td colspan='3'>%2, %3, %4 %5</td></tr>")
        .arg(cell(name), QString::number(values.x(), 'f', 4), QString::number(values.y(), 'f', 4),
             QString::number(values.z(), 'f', 4), unit);
  };
  const bool at_effector = marks.camera_from_end_effector.has_value();
  const QString title = solutionText(
                            "One sigma at the %1, by the marks alone (noise %2 times what their "
                            "sigmas say)")
                            .arg(placeText(marks))
                            .arg(QString::number(solution.noise_factor, 'f', 2));
  QStringList rows = {line(solutionText("normal"), sigma->normal_mm, mm,
                           judged(sigma->normal_mm, required.normal_mm, mm)),
                      line(solutionText("lateral"), sigma->lateral_mm, mm,
                           judged(sigma->lateral_mm, required.lateral_mm, mm)),
                      line(solutionText("rotation"), sigma->out_of_plane_mrad, mrad,
                           judged(sigma->out_of_plane_mrad, rotation_mrad, mrad)),
                      axes(solutionText("along x, y, z"), sigma->translation_mm, mm)};
  // Without an end effector the row above is the camera's own already.
  const auto at_camera =
      at_effector ? sessions::poseSigma(*answer.covariance, std::nullopt) : std::nullopt;
  if (at_camera) rows << axes(solutionText("at the camera"), at_camera->translation_mm, mm);
  rows << axes(solutionText("about x, y, z"), sigma->rotation_mrad, mrad);
  return table(title, rows);
}

QStringList poseCells(const Pose& pose) {
  const Eigen::Vector3d turn_deg = rotationLog(pose.rotation) / kDegree_rad;
  QStringList cells;
  for (int i = 0; i < 3; ++i) cells << QString::number(1e3 * pose.translation_m[i], 'f', 3);
  for (int i = 0; i < 3; ++i) cells << QString::number(turn_deg[i], 'f', 4);
  return cells;
}

QString twinHtml(const sessions::CaseMarksSolution& solved) {
  const MarksSolution& solution = *solved.result.solution;
  const auto twin = solved.twin_camera_from_station();
  if (!twin) return {};
  const QStringList ours = poseCells(solution.camera_from_station.front());
  const QStringList other = poseCells(*twin);
  const QStringList names = {solutionText("x, mm"),       solutionText("y, mm"),
                             solutionText("z, mm"),       solutionText("turn x, deg"),
                             solutionText("turn y, deg"), solutionText("turn z, deg")};
  QStringList rows = {rowOf({cell(QString()), cell(solutionText("this pose"), true),
                             cell(solutionText("the other pose"), true)})};
  for (int i = 0; i < names.size(); ++i)
    rows << rowOf({cell(names[i]), cell(ours[i], true), cell(other[i], true)});
  rows << rowOf({cell(solutionText("rms, px")),
                 cell(QString::number(solution.rms_px, 'f', 3), true),
                 cell(QString::number(solution.twin->rms_px, 'f', 3), true)});
  return table(solutionText("Two poses explain marks in a plane"), rows);
}

QString viewsHtml(const sessions::CaseMarksSolution& solved) {
  const auto& views = solved.marks.views;
  if (views.size() < 2) return {};
  QStringList rows;
  for (std::size_t i = 0; i < views.size(); ++i) {
    double squares_px2 = 0.0;
    int count = 0;
    for (const sessions::SolvedMark& mark : solved.result.solution->marks) {
      if (mark.address.view != i || !mark.projected) continue;
      squares_px2 += mark.residual_px.squaredNorm();
      ++count;
    }
    const double rms_px = count > 0 ? std::sqrt(squares_px2 / (2.0 * count)) : 0.0;
    rows << rowOf({cell(fromText(views[i].name).toHtmlEscaped()),
                   cell(solutionText("%1 marks").arg(count)),
                   cell(solutionText("%1 px rms").arg(QString::number(rms_px, 'f', 3)), true)});
  }
  return table(solutionText("Cameras solved together"), rows);
}

QString differenceRow(const QString& name, const Pose& other, const Pose& annotated,
                      const sessions::CaseMarks& marks, const QString& more) {
  const sessions::PoseError error =
      sessions::poseError(other, annotated, marks.camera_from_end_effector);
  return rowOf({cell(name.toHtmlEscaped()), cell(QString::number(error.normal_mm, 'f', 3), true),
                cell(QString::number(error.lateral_mm, 'f', 3), true),
                cell(QString::number(error.geodesic_mrad / kMradPerDegree, 'f', 4), true),
                cell(more)});
}

QString comparedHtml(const AnnotationAnswer& answer, const std::vector<ComparedPose>& others,
                     const Pose& annotated) {
  const sessions::CaseMarks& marks = answer.solution->marks;
  QStringList rows;
  for (const ComparedPose& other : others)
    rows << differenceRow(other.name, other.camera_from_station, annotated, marks, {});
  for (const PassAnswer& pass : answer.passes) {
    const int shared = static_cast<int>(pass.repeatability.marks.size());
    const QString repeated = shared > 0
                                 ? solutionText("%1 marks, %2 px per mark and axis")
                                       .arg(shared)
                                       .arg(QString::number(pass.repeatability.sigma_px, 'f', 3))
                                 : solutionText("no mark in common");
    const QString name = solutionText("pass of %1").arg(fromText(pass.by));
    if (pass.camera_from_station)
      rows << differenceRow(name, *pass.camera_from_station, annotated, marks, repeated);
    else
      rows << rowOf({cell(name.toHtmlEscaped()), cell(solutionText("no pose")), cell({}), cell({}),
                     cell(repeated)});
  }
  if (rows.isEmpty()) return {};
  rows.prepend(rowOf({cell(QString()), cell(solutionText("normal, mm"), true),
                      cell(solutionText("lateral, mm"), true),
                      cell(solutionText("angle, deg"), true), cell(QString())}));
  return table(solutionText("The annotated pose is from, at the %1").arg(placeText(marks)), rows);
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
  html += twinHtml(*answer.solution);
  html += viewsHtml(*answer.solution);
  html += comparedHtml(answer, others, *annotated);
  return html;
}

}  // namespace boresight::ui
