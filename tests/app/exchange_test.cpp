// SPDX-License-Identifier: Apache-2.0
// export and import.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/session/session_document.h"
#include "sessions/session/session_file.h"
#include "tests/app/run_whs.h"
#include "tests/support/marked_example.h"

namespace boresight::test {
namespace {

using sessions::Session;
using testing::HasSubstr;

class WhsExchange : public testing::Test {
 protected:
  WhsExchange() { sessions::writeSessionFile(file_, session_); }

  Session saved() const { return sessions::readSessionFile(file_).session; }

  TemporaryFolder folder_;
  std::string file_ = folder_ / "s.boresight.json";
  Session session_ = markedExample(0.2);
  std::string bc_ = caseOfStation(session_, "bc");
  std::string os_ = caseOfStation(session_, "os");
};

TEST_F(WhsExchange, TakesPosesOutAndInAgain) {
  for (const char* form : {"--colmap", "--bop"}) {
    const std::string folder = folder_ / ("out" + std::string(form));
    const ProgramRun out = runWhs({"export", file_, form, folder, "--case", bc_});
    ASSERT_EQ(out.exit_code, 0) << out.err;
    EXPECT_EQ(out.out, bc_ + "\n");
    // Another folder of this name is not touched.
    EXPECT_EQ(runWhs({"export", file_, form, folder, "--case", bc_}).exit_code, 3);
    const ProgramRun kept = runWhs({"import", file_, form, folder});
    EXPECT_EQ(kept.exit_code, 3);
    EXPECT_THAT(kept.err, HasSubstr("another truth already"));
    const ProgramRun in = runWhs({"import", file_, form, folder, "--replace"});
    ASSERT_EQ(in.exit_code, 0) << in.err;
    EXPECT_EQ(in.out, bc_ + "\n");
    const auto error = perturbationBetween(*saved().findCase(bc_)->camera_from_station_truth,
                                           *session_.findCase(bc_)->camera_from_station_truth);
    EXPECT_GT(error.norm(), 1e-7);  // the marks are noisy
    EXPECT_LT(error.norm(), 5e-3);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.boresight.journal"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.boresight.lock"));
}

TEST_F(WhsExchange, TakesMarksOutAndInAgain) {
  const std::string points = folder_ / "points.csv";
  ASSERT_EQ(runWhs({"export", file_, "--points", points, "--case", bc_}).exit_code, 0);
  ASSERT_EQ(runWhs({"import", file_, "--points", points, "--case", os_, "--replace"}).exit_code, 0);
  EXPECT_EQ(*saved().annotations.at(os_), *session_.annotations.at(bc_));
  const std::string landmarks = folder_ / "landmarks.json";
  ASSERT_EQ(runWhs({"export", file_, "--landmarks", landmarks, "--case", bc_}).exit_code, 0);
  EXPECT_THAT(folder_.read("landmarks.json"), HasSubstr("boresight-landmarks"));
}

TEST_F(WhsExchange, RefusesWhatIsIncompleteOrWrong) {
  const std::string before = folder_.read("s.boresight.json");
  const std::string points = folder_ / "points.json";
  EXPECT_EQ(runWhs({"export", file_}).exit_code, 2);
  EXPECT_EQ(runWhs({"import", file_}).exit_code, 2);
  EXPECT_EQ(runWhs({"export", file_, "--points", points}).exit_code, 2);
  EXPECT_EQ(runWhs({"export", file_, "--points", points, "--bop", points}).exit_code, 2);
  EXPECT_EQ(runWhs({"export", file_, "--points", points, "--case", "x"}).exit_code, 3);
  const ProgramRun missing = runWhs({"import", file_, "--points", points, "--case", bc_});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_EQ(missing.errorLines(), 1);
  folder_.write("points.json", std::string_view(R"({"format": "boresight-points", "version": 1,
      "points": [{"id": "far", "pixel": [99373, 2]}]})"));
  const ProgramRun outside =
      runWhs({"import", file_, "--points", points, "--case", bc_, "--replace"});
  EXPECT_EQ(outside.exit_code, 3);
  EXPECT_THAT(outside.err, HasSubstr("far"));
  {
    const auto open = sessions::SessionDocument::open(file_);
    folder_.write("points.json", std::string_view(R"({"format": "boresight-points", "version": 1,
        "points": [{"id": "p1", "pixel": [1, 2]}]})"));
    const ProgramRun locked =
        runWhs({"import", file_, "--points", points, "--case", bc_, "--replace"});
    EXPECT_EQ(locked.exit_code, 3);
    EXPECT_EQ(locked.errorLines(), 1) << locked.err;
  }
  EXPECT_EQ(folder_.read("s.boresight.json"), before);
}

}  // namespace
}  // namespace boresight::test
