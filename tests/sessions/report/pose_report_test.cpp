// SPDX-License-Identifier: Apache-2.0
#include "sessions/report/pose_report.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "sessions/checks/checks.h"
#include "sessions/checks/pose_quality.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/report/pdf_canvas.h"
#include "sessions/review/review_status.h"
#include "sessions/text/text_table.h"
#include "sessions/trace/decisive_iterations.h"
#include "tests/support/annotated_example.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using sessions::Session;

/// What another program reads on a page of a PDF; empty where that program is not installed.
std::string pageText(const std::filesystem::path& file, int page) {
  const std::string number = std::to_string(page);
  const std::string command =
      "pdftotext -f " + number + " -l " + number + " -layout '" + file.string() + "' - 2>/dev/null";
  std::string text;
  FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 4096> buffer{};
  while (pipe != nullptr && std::fgets(buffer.data(), buffer.size(), pipe) != nullptr)
    text += buffer.data();
  if (pipe != nullptr) ::pclose(pipe);
  return text;
}

class PoseReportTest : public testing::Test {
 protected:
  void SetUp() override {
    const Session both = annotatedExample(0.1);
    id_ = caseOfStation(both, "os");
    session_ = withoutCase(both, caseOfStation(both, "bc"));
  }

  void run() {
    const auto trace = runCase(session_, id_);
    session_ = withRun(session_, storeRun(session_, id_, trace, folder_ / "s.boresight.json"));
  }

  /// By limits that one check fails, which is passed over.
  sessions::ReviewSubject validate(const sessions::Signature& who) {
    session_.review.limits = {{"check.inlier_count", 9000.0}};
    const auto loaded = sessions::loadCase(*session_.findCase(id_));
    const auto subject = reviewSubject(session_, loaded, sessions::PoseSource::kRun);
    const auto limits = sessions::checkLimits(session_.review.preset, session_.review.limits);
    session_ = validated(session_, subject, checkPose(subject, limits),
                         {{"inlier_count", "the hose is known"}}, who);
    return subject;
  }

  std::filesystem::path write() {
    const std::filesystem::path file = folder_ / "report.pdf";
    writePoseReport(file, sessions::poseReport(session_, id_));
    return file;
  }

  TemporaryFolder folder_;
  Session session_;
  std::string id_;
};

TEST_F(PoseReportTest, UnvalidatedPose_IsLabelledOnEveryPage) {
  run();
  const std::filesystem::path file = write();
  if (pageText(file, 1).empty()) GTEST_SKIP() << "pdftotext is not installed";
  for (const int page : {1, 2}) {
    EXPECT_THAT(pageText(file, page), HasSubstr("NOT VALIDATED: converged")) << page;
    EXPECT_THAT(pageText(file, page), HasSubstr("page " + std::to_string(page) + " of 2"));
  }
  EXPECT_EQ(pageText(file, 3), "");
  std::string quality =
      runQuality(session_, sessions::loadCase(*session_.findCase(id_)), runCase(session_, id_))
          .text();
  quality.resize(quality.find(" ("));  // the rest is on the next line
  EXPECT_THAT(pageText(file, 1), HasSubstr(quality)) << "as in the window and in the checks";
  EXPECT_THAT(pageText(file, 2), HasSubstr(", current"));
}

TEST_F(PoseReportTest, HoldsPoseDecisionAndReasons) {
  run();
  const sessions::ReviewSubject subject = validate({"Ad\xC3\xA0 \xE4\xB8\xAD", "looked at twice"});
  session_ = approved(session_, id_, lastRunDigest(session_, id_), {"Bob", "so did I"});
  const std::filesystem::path file = write();
  const std::string first = pageText(file, 1);
  if (first.empty()) GTEST_SKIP() << "pdftotext is not installed";
  EXPECT_THAT(first, AllOf(HasSubstr("approved by Bob"), HasSubstr("looked at twice"),
                           HasSubstr("so did I")));
  const double z_m = subject.camera_from_station.translation_m.z();
  EXPECT_THAT(first, HasSubstr(sessions::fixedText(1e3 * z_m, 4)));
  EXPECT_THAT(pageText(file, 2),
              AllOf(HasSubstr("at the time of the decision"), HasSubstr("the hose is known")));
}

TEST_F(PoseReportTest, WithoutRefinement_ResidualsAreOfTheMatchesThatTheChecksCount) {
  session_.options = {{"refinement.enabled", false}, {"loop.inlier_threshold_px", 1.0}};
  run();
  const sessions::PoseReport report = sessions::poseReport(session_, id_);
  ASSERT_FALSE(report.trace->hypotheses.empty()) << "the last iteration repeats the best one";
  EXPECT_EQ(lastMatching(*report.trace), report.trace->iterations.back()) << "it gave the pose";
  const auto inliers = std::ranges::find(report.pose.checks, "inlier_count",
                                         [](const auto& judged) { return judged.check.id; });
  const auto& residuals = reportResiduals(report).all;
  EXPECT_EQ(std::ranges::count_if(residuals, &sessions::ReportResidual::used),
            inliers->check.figure);
}

TEST_F(PoseReportTest, OfAnnotationsNeedsNoRun) {
  const sessions::PoseReport report = sessions::poseReport(session_, id_);
  EXPECT_EQ(report.pose.source, sessions::PoseSource::kAnnotation);
  const sessions::ReportResiduals residuals = reportResiduals(report);
  EXPECT_EQ(residuals.all.size(), 10u);
  EXPECT_LT(residuals.rms_px(), 0.3);
  EXPECT_GT(poseReportPdf(report).size(), 10000u);
}

TEST_F(PoseReportTest, ForgedCheckOrDamagedOrLostTrace_IsRefused) {
  run();
  (void)validate({"Ada", "right"});
  const Session honest = session_;
  for (sessions::JudgedCheck& judged : session_.decisions.back().checks)
    judged.check.state = sessions::CheckState::kPassed;
  EXPECT_THAT(folder_.message([this] { (void)sessions::poseReport(session_, id_); }),
              HasSubstr("and measured as"));
  const std::filesystem::path trace = honest.runs.back().file;
  std::filesystem::resize_file(trace, std::filesystem::file_size(trace) - 1);
  EXPECT_THROW(sessions::poseReport(honest, id_), sessions::InputError);
  std::filesystem::remove(trace);
  EXPECT_THROW(sessions::poseReport(honest, id_), sessions::InputError);
}

TEST_F(PoseReportTest, WithoutAnyPoseThereIsNoReport) {
  session_ = withAnnotations(session_, id_, {});
  EXPECT_THROW(sessions::poseReport(session_, id_), sessions::InputError);
  run();
  EXPECT_THROW(writePoseReport(folder_ / "none" / "r.pdf", sessions::poseReport(session_, id_)),
               sessions::OutputError);
}

TEST(PdfPlot, TicksAreRoundFewAndWithin) {
  const std::pair<double, double> ranges[] = {{0.0, 1.0}, {-3.7, 912.0}, {1e-9, 2e-9}, {5.0, 5.1}};
  for (const auto& [low, high] : ranges) {
    const auto ticks = sessions::roundTicks(low, high, 6);
    EXPECT_TRUE(ticks.size() >= 2 && ticks.size() <= 7) << low;
    for (const double tick : ticks) EXPECT_TRUE(tick >= low && tick <= high) << tick;
  }
  EXPECT_TRUE(sessions::roundTicks(1.0, 1.0, 6).empty());
  EXPECT_TRUE(sessions::roundTicks(0.0, INFINITY, 6).empty());
}

}  // namespace
}  // namespace boresight::test
