// SPDX-License-Identifier: Apache-2.0
#include "sessions/report/pose_report.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/math.h"
#include "sessions/checks/checks.h"
#include "sessions/checks/pose_quality.h"
#include "sessions/checks/pose_uncertainty.h"
#include "sessions/decision/check.h"
#include "sessions/decision/check_limits.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/report/pdf_canvas.h"
#include "sessions/review/review_status.h"
#include "sessions/review/validated_pose_file.h"
#include "sessions/session/named_poses.h"
#include "sessions/session/stated_inputs.h"
#include "sessions/text/plain_text.h"
#include "sessions/version.h"

namespace boresight::sessions {
namespace {

constexpr double kLeft = 40.0;
constexpr double kRight = PdfCanvas::kWidth - 40.0;
constexpr double kTextWidth = kRight - kLeft;
constexpr double kFoot = PdfCanvas::kHeight - 38.0;
constexpr double kGap = 8.0;

const PdfTextStyle kHeading{9.5, true, false, kInk, 1};
const PdfTextStyle kFaint{7.0, false, false, kFaintInk, 0};

const SessionCase& caseOf(const PoseReport& report) { return report.loaded->source; }

/// The decision that the report's pose rests on, or nullptr.
const Decision* decisionOf(const PoseReport& report) {
  const ReviewStatus status = reviewStatusOf(*report.session, report.pose.case_id);
  return status.holds() ? status.decision : nullptr;
}

// ---- what every page has

void drawHead(PdfCanvas& canvas, const PoseReport& report) {
  const SessionCase& session_case = caseOf(report);
  const std::string title =
      "Pose of " + session_case.id +
      (session_case.station.empty() ? "" : ", station " + session_case.station);
  canvas.text(kLeft, 28.0, kTextWidth, title, {14.0, true, false, kInk, 1});
  const bool plain =
      report.pose.validated && reviewStatusOf(*report.session, session_case.id).outdated.empty();
  const PdfColor& color = plain ? kPdfBlue : kPdfOrange;
  const PdfBox bar = {kLeft, 48.0, kTextWidth, 17.0};
  canvas.fill(bar, color);
  const char* sign = plain ? "\xE2\x9C\x94  " : "\xE2\x9A\xA0  ";
  canvas.text(bar.x + 6.0, bar.y + 3.0, bar.width - 12.0, sign + report.pose.review_status,
              {9.0, true, false, {1.0, 1.0, 1.0}, 1});
}

void drawFoot(PdfCanvas& canvas, const PoseReport& report, int pages) {
  canvas.line(kLeft, kFoot, kRight, kFoot, kPaperGrid);
  const std::string what = report.pose.run_digest.empty()
                               ? "pose of the annotations"
                               : "run " + report.pose.run_digest.substr(0, 16);
  canvas.text(kLeft, kFoot + 4.0, kTextWidth - 90.0,
              report.pose.review_status + ".  " + what + ", pixels " +
                  caseOf(report).image.pixels_sha256.substr(0, 16) + ", Boresight " + kVersion,
              {6.5, false, false, kFaintInk, 2});
  canvas.text(kRight - 90.0, kFoot + 4.0, 90.0, formatText("page %d of %d", canvas.page(), pages),
              {6.5, false, false, kFaintInk, 1, PdfTextStyle::Align::kRight});
}

double drawHeading(PdfCanvas& canvas, double x, double y, double width, const std::string& text) {
  const double height = canvas.text(x, y, width, text, kHeading);
  canvas.line(x, y + height + 1.0, x + width, y + height + 1.0, kPaperGrid);
  return y + height + 4.0;
}

// ---- the first page

/// The place below.
double drawOverlayPicture(PdfCanvas& canvas, const PdfBox& box, const PoseReport& report) {
  const ReportPicture picture = overlayPicture(report);
  const PdfBox taken = canvas.picture(box, picture.image);
  canvas.frame(taken, kFaintInk);
  const double below = taken.bottom() + 2.0;
  return below +
         canvas.text(
             box.x, below, box.width,
             formatText("Edges of the seed (orange) and of the pose (blue) over the "
                        "image; %d x %d px from (%d, %d).",
                        picture.image.width, picture.image.height, picture.left_px, picture.top_px),
             kFaint);
}

/// `number`: printf's conversion of a component.
std::string vectorText(const Eigen::Vector3d& vector, const char* unit, const char* number) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) text += formatText(number, vector[axis]) + "  ";
  return text + unit;
}

std::string quaternionText(const Pose& pose) {
  Eigen::Quaterniond q = pose.rotation;
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  return formatText("%.9f  %.9f  %.9f  %.9f", q.w(), q.x(), q.y(), q.z());
}

/// Rows with a heading above them.
class Rows {
 public:
  Rows(PdfCanvas& canvas, const PdfBox& box, const std::string& heading)
      : canvas_(&canvas), box_(box) {
    box_.y = drawHeading(canvas, box.x, box.y, box.width, heading);
  }
  void add(const std::string& name, const std::string& value, bool fixed = true) {
    constexpr double kNameWidth = 92.0;
    const double left = canvas_->text(box_.x, box_.y, kNameWidth, name, kFaint);
    const double right = canvas_->text(box_.x + kNameWidth, box_.y, box_.width - kNameWidth, value,
                                       {7.0, false, fixed, kInk, 12});
    box_.y += std::max(left, right) + 1.0;
  }
  void addText(const std::string& text) {
    box_.y += canvas_->text(box_.x, box_.y, box_.width, text, kFaint);
  }
  void addRotation(const Pose& pose) {
    add("rotation vector", vectorText(rotationLog(pose.rotation) / kDegree_rad, "deg", "%.5f"));
  }
  double below() const { return box_.y; }

 private:
  PdfCanvas* canvas_;
  PdfBox box_;
};

PoseQuality qualityOf(const PoseReport& report) {
  ReviewSubject subject;
  subject.loaded = report.loaded;
  subject.requirement = requirementOf(*report.session, caseOf(report));
  static_cast<JudgedPose&>(subject) = report.pose;
  const ReviewSettings& review = report.session->review;
  return poseQuality(subject, checkLimits(review.preset, review.limits).sigmas);
}

double drawPose(PdfCanvas& canvas, const PdfBox& box, const PoseReport& report) {
  const Pose& pose = report.pose.camera_from_station;
  Rows rows(canvas, box, "camera_from_station");
  rows.add("translation", vectorText(1e3 * pose.translation_m, "mm", "%.4f"));
  rows.addRotation(pose);
  rows.add("quaternion wxyz", quaternionText(pose));
  const PoseQuality quality = qualityOf(report);
  rows.add("quality", quality.text());
  for (const PrecisionFigure& figure : quality.figures)
    if (figure.judged())
      rows.add(figure.where,
               figure.text() + formatText("; image alone %.2g %s", *figure.by_image, figure.unit));
  return rows.below();
}

/// Draws the pose in the last named frame, if there is one.
double drawNamedPose(PdfCanvas& canvas, const PdfBox& box, const PoseReport& report) {
  const SessionCase& session_case = caseOf(report);
  const auto named = namedPoses(session_case, report.pose.camera_from_station);
  if (named.empty()) return box.y;
  const Pose& pose = named.back().reference_from_station;
  Rows rows(canvas, box, namedPoseTitle(named.back()));
  rows.add("translation", vectorText(pose.translation_m, "m", "%.6f"));
  rows.addRotation(pose);
  rows.add("quaternion wxyz", quaternionText(pose));
  return rows.below() + kGap;
}

void drawEndEffector(PdfCanvas& canvas, const PdfBox& box, const PoseReport& report) {
  const SessionCase& session_case = caseOf(report);
  if (!session_case.camera_from_end_effector || !session_case.has_seed) return;
  const EndEffectorPose end_effector_pose = endEffectorPose(
      session_case, report.pose.camera_from_station, report.pose.covariance.total());
  const Pose& correction = end_effector_pose.end_effector_seed_from_end_effector_estimated;
  Rows rows(canvas, box, "Correction of the commanded pose");
  rows.addText("end_effector_seed_from_end_effector_estimated");
  rows.add("translation", vectorText(1e3 * correction.translation_m, "mm", "%.4f"));
  rows.addRotation(correction);
  if (!report.pose.covariance.known()) return;
  const Vector6d sigma = sigmasOf(end_effector_pose.covariance);
  rows.add("1 sigma", vectorText(1e3 * sigma.tail<3>(), "mm", "%.4f"));
  rows.add("", vectorText(1e3 * sigma.head<3>(), "mrad", "%.4f"));
}

double drawInputs(PdfCanvas& canvas, const PdfBox& box, const PoseReport& report) {
  const SessionCase& session_case = caseOf(report);
  Rows rows(canvas, box, "Inputs");
  const auto row = [&rows](const std::string& name, const std::string& value) {
    rows.add(name, value, false);
  };
  row("image",
      session_case.image.source.file.filename().string() +
          formatText(", %d x %d px, file %s", session_case.image.width, session_case.image.height,
                     session_case.image.source.sha256.substr(0, 16).c_str()));
  row("to 8 bit", report.loaded->image.rule);
  row("camera",
      formatText("%s, fx %.3f, fy %.3f, cx %.3f, cy %.3f px; centre of the top-left pixel "
                 "is (0, 0)",
                 cameraModelName(session_case.camera.model), session_case.camera.fx,
                 session_case.camera.fy, session_case.camera.cx, session_case.camera.cy));
  for (const LabelItem& line : frameLines(session_case)) row(line.name, line.value);
  for (const LabelItem& item : session_case.image.label)
    if (item.name == "PRODUCT_ID" || item.name == "START_TIME") row(item.name, item.value);
  for (const MeshInput& part : session_case.parts)
    row("mesh", part.source.mesh.filename().string() + " in " +
                    (part.source.mesh_unit.empty() ? "its own unit" : part.source.mesh_unit) +
                    ", " + part.sha256.substr(0, 16) +
                    (part.source.state == PartState() && part.source.frame == kStationFrame
                         ? ""
                         : "; " + partText(part.source)));
  const InputSigmas sigmas(session_case);
  row("known to", "scale " + meshScaleText(sigmas) + "; calibration " + calibrationText(sigmas));
  if (session_case.ignore || !session_case.ignore_strokes.empty()) row("ignored pixels", "a mask");
  row("seed",
      session_case.has_seed
          ? vectorText(1e3 * session_case.camera_from_station_seed.translation_m, "mm", "%.1f")
          : "none");
  if (report.trace) {
    row("run",
        formatText("%s, %zu iterations, version %s", localizationStatusText(report.trace->status),
                   report.trace->iterations.size(), report.trace->version.c_str()));
    row("digest", report.trace->digest);
  }
  return rows.below();
}

void drawDecision(PdfCanvas& canvas, const PdfBox& box, const PoseReport& report) {
  Rows rows(canvas, box, "Decision");
  const Decision* decision = decisionOf(report);
  if (decision == nullptr) {
    canvas.text(box.x, rows.below(), box.width, report.pose.review_status + ".",
                {7.5, true, false, kPdfOrange, 4});
    return;
  }
  const char* verdict = decision->verdict == Verdict::kValidated ? "validated by" : "rejected by";
  rows.add(verdict, decision->by + ", " + decision->time, false);
  rows.add("comment", decision->comment, false);
  if (!decision->approval) return;
  rows.add("approved by", decision->approval->by + ", " + decision->approval->time, false);
  rows.add("comment", decision->approval->comment, false);
}

void drawFirstPage(PdfCanvas& canvas, const PoseReport& report, int pages) {
  drawHead(canvas, report);
  const double below = drawOverlayPicture(canvas, {kLeft, 74.0, kTextWidth, 470.0}, report) + kGap;
  const double column = 0.5 * (kTextWidth - 2.0 * kGap);
  PdfBox left = {kLeft, below, column, kFoot - below};
  left.y = drawPose(canvas, left, report) + kGap;
  left.y = drawNamedPose(canvas, left, report);
  drawEndEffector(canvas, left, report);
  PdfBox right = {kLeft + column + 2.0 * kGap, below, column, kFoot - below};
  right.y = drawInputs(canvas, right, report) + kGap;
  drawDecision(canvas, right, report);
  drawFoot(canvas, report, pages);
}

// ---- the second page

struct CheckLook {
  const char* sign;
  PdfColor color;
};

CheckLook lookOf(const JudgedCheck& judged) {
  if (judged.check.state == CheckState::kPassed) return {"\xE2\x9C\x94", kPdfBlue};
  if (judged.check.state == CheckState::kFailed)
    return {judged.waiver_reason.empty() ? "\xE2\x9C\x98" : "\xE2\x9C\x98!", kPdfOrange};
  return {"\xE2\x80\x93", kFaintInk};
}

double drawCheck(PdfCanvas& canvas, double y, const JudgedCheck& judged) {
  constexpr double kSize = 6.6;
  const CheckLook look = lookOf(judged);
  const Check& check = judged.check;
  const PdfColor& ink = check.state == CheckState::kNotApplicable ? kFaintInk : kInk;
  std::string sentence = check.sentence;
  if (!judged.waiver_reason.empty()) sentence += " Waived: " + judged.waiver_reason;
  canvas.text(kLeft, y, 14.0, look.sign, {kSize, true, false, look.color, 1});
  const double title = canvas.text(kLeft + 14.0, y, 138.0, check.title, {kSize, false, false, ink});
  const double figure =
      canvas.text(kLeft + 156.0, y, 104.0, figureText(check), {kSize, false, false, ink});
  const double text =
      canvas.text(kLeft + 262.0, y, kTextWidth - 262.0, sentence, {kSize, false, false, ink});
  return y + std::max({title, figure, text}) + 1.0;
}

double drawChecks(PdfCanvas& canvas, double y, const PoseReport& report) {
  std::vector<Check> plain;
  for (const JudgedCheck& judged : report.pose.checks) plain.push_back(judged.check);
  const bool judged = decisionOf(report) != nullptr;
  const std::string text = plain.empty()
                               ? "Checks: none"
                               : "Checks: " + checkCountsText(plain) +
                                     (judged ? ", at the time of the decision" : ", current");
  y = drawHeading(canvas, kLeft, y, kTextWidth, text);
  for (const JudgedCheck& item : report.pose.checks) y = drawCheck(canvas, y, item);
  return y;
}

/// A power of ten times 1, 2 or 5 that makes a residual of `rms_px` some pixels long.
double magnification(double rms_px, double pixels) {
  double factor = 1.0;
  for (const double step : {2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0})
    if (step * rms_px <= pixels) factor = step;
  return factor;
}

constexpr std::size_t kMostArrows = 1200;  ///< more would hide each other

void drawResidualPicture(PdfCanvas& canvas, const PdfBox& box, const PoseReport& report,
                         const ReportResiduals& residuals) {
  const ReportPicture picture = palePicture(report);
  const PdfBox taken = canvas.picture({box.x, box.y, box.width, box.height - 20.0}, picture.image);
  const double scale = taken.width / picture.image.width;
  const double factor = magnification(residuals.rms_px(), 6.0 / scale);
  canvas.clip(taken);
  const std::size_t step = 1 + residuals.all.size() / kMostArrows;
  const Eigen::Vector2d corner_px(picture.left_px - 0.5, picture.top_px - 0.5);
  for (std::size_t i = 0; i < residuals.all.size(); i += step) {
    const auto& [predicted_px, residual_px, used] = residuals.all[i];
    const Eigen::Vector2d from =
        Eigen::Vector2d(taken.x, taken.y) + scale * (predicted_px - corner_px);
    const Eigen::Vector2d to = from + scale * factor * residual_px;
    const PdfColor& color = used ? kPdfBlue : kPdfOrange;
    canvas.line(from.x(), from.y(), to.x(), to.y(), color, 0.5);
    used ? canvas.circle(from.x(), from.y(), 0.9, color, true)
         : canvas.cross(from.x(), from.y(), 1.4, color);
  }
  canvas.unclip();
  canvas.frame(taken, kFaintInk);
  const auto set_aside = std::ranges::count(residuals.all, false, &ReportResidual::used);
  canvas.text(
      box.x, taken.bottom() + 2.0, box.width,
      formatText("Residuals of %zu %s (one in %zu is drawn), magnified %.3g times; rms %.3f px. "
                 "Dots: used; crosses: not used (%td).",
                 residuals.all.size(), residuals.of, step, factor, residuals.rms_px(), set_aside),
      kFaint);
}

PdfPlot correctionPlot(const LocalizationTrace& trace) {
  PdfPlot plot{
      "Correction of each iteration", "iteration", "mm (dots), mrad (crosses)", {}, true, true};
  plot.series = {{"translation, mm", {}, kPdfBlue, false},
                 {"rotation, mrad", {}, kPdfOrange, true}};
  for (std::size_t i = 0; i < trace.iterations.size(); ++i) {
    const double x = static_cast<double>(i + 1);
    plot.series[0].points.push_back({x, 1e3 * trace.iterations[i]->correction_translation_m});
    plot.series[1].points.push_back({x, 1e3 * trace.iterations[i]->correction_rotation_rad});
  }
  return plot;
}

PdfPlot supportPlot(const LocalizationTrace& trace) {
  PdfPlot plot{
      "Matches and edge points of each iteration", "iteration", "count", {}, true, true, true};
  plot.series = {{"looked for", {}, kFaintInk, false}, {"agree", {}, kPdfBlue, false}};
  for (std::size_t i = 0; i < trace.iterations.size(); ++i) {
    const IterationTrace& iteration = *trace.iterations[i];
    const double x = static_cast<double>(i + 1);
    const bool refine = iteration.kind == IterationKind::kRefine;
    plot.series[0].points.push_back(
        {x, static_cast<double>(refine ? iteration.refinement.sample_count
                                       : iteration.searched_count)});
    plot.series[1].points.push_back({x, static_cast<double>(iteration.support())});
  }
  return plot;
}

void drawResidualHistogram(PdfCanvas& canvas, const PdfBox& box, const ReportResiduals& residuals) {
  std::vector<double> lengths;
  for (const ReportResidual& residual : residuals.all)
    if (residual.used) lengths.push_back(residual.residual_px.norm());
  if (lengths.empty()) return;
  const double high = std::max(0.1, *std::max_element(lengths.begin(), lengths.end()));
  drawHistogram(canvas, box, "Lengths of the used residuals", "px", lengths, 0.0, high, 24);
}

void drawPlots(PdfCanvas& canvas, double y, const PoseReport& report) {
  const ReportResiduals residuals = reportResiduals(report);
  const double column = 0.5 * (kTextWidth - 2.0 * kGap);
  const double room = kFoot - y - kGap;
  const double right = kLeft + column + 2.0 * kGap;
  if (residuals.all.empty()) {
    canvas.text(kLeft, y, kTextWidth, "No residuals: no matches.", kFaint);
    return;
  }
  drawResidualPicture(canvas, {kLeft, y, column, 0.62 * room}, report, residuals);
  drawResidualHistogram(canvas, {kLeft, y + 0.64 * room, column, 0.36 * room}, residuals);
  if (!report.trace || report.pose.source != PoseSource::kRun) return;
  drawPlot(canvas, {right, y, column, 0.48 * room}, correctionPlot(*report.trace));
  drawPlot(canvas, {right, y + 0.52 * room, column, 0.48 * room}, supportPlot(*report.trace));
}

constexpr int kUsualPages = 2;
constexpr double kLeastPlotRoom = 150.0;

/// Plots take what the checks leave of their page, else a page of their own.
void drawPages(PdfCanvas& canvas, const PoseReport& report, int pages) {
  constexpr double kBelowHead = 74.0;
  drawFirstPage(canvas, report, pages);
  canvas.nextPage();
  drawHead(canvas, report);
  double below = drawChecks(canvas, kBelowHead, report);
  if (kFoot - below - kGap < kLeastPlotRoom) {
    drawFoot(canvas, report, pages);
    canvas.nextPage();
    drawHead(canvas, report);
    below = kBelowHead;
  }
  drawPlots(canvas, below + kGap, report);
  drawFoot(canvas, report, pages);
}

}  // namespace

PoseReport poseReport(const Session& session, const std::string& case_id) {
  PoseReport report;
  report.session = &session;
  CheckedPose checked = checkedPose(session, case_id);
  report.pose = std::move(checked.pose);
  report.loaded = std::move(checked.subject.loaded);
  if (checked.subject.run) report.trace = *checked.subject.run;
  return report;
}

std::vector<std::uint8_t> poseReportPdf(const PoseReport& report) {
  const std::string title =
      "Pose of " + report.pose.case_id + " (" + report.pose.review_status + ")";
  int pages = kUsualPages;
  PdfCanvas canvas(title);
  drawPages(canvas, report, pages);
  if (canvas.page() == pages) return canvas.finish();
  pages = canvas.page();  // not known when the footers were drawn
  PdfCanvas longer(title);
  drawPages(longer, report, pages);
  return longer.finish();
}

void writePoseReport(const std::filesystem::path& file, const PoseReport& report) {
  writeFileAtomically(file, poseReportPdf(report));
}

}  // namespace boresight::sessions
