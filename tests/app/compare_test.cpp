// SPDX-License-Identifier: Apache-2.0
// Records, traces and sessions compared.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sessions/io/dataset_file.h"
#include "sessions/session/input_check.h"
#include "sessions/session/session_document.h"
#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

using testing::HasSubstr;

const std::string kCase = [] {
  for (const sessions::Case& one : sessions::readDataset(exampleFolder() / "dataset.json").cases)
    if (one.station == "os") return one.id;
  return std::string();
}();

/// A session whose one case was run, and the record and trace of the same run elsewhere.
struct Runs {
  TemporaryFolder folder;
  std::string session = folder / "s.boresight.json";
  std::string record = folder / "run.whsr";
  std::string trace = folder / "run.trace";

  Runs() {
    EXPECT_EQ(runWhs({"new", "--dataset", exampleFolder() / "dataset.json", "--case", kCase,
                      "--out", session})
                  .exit_code,
              0);
    EXPECT_EQ(runWhs({"run", session}).exit_code, 0);
    EXPECT_EQ(runWhs(localizeArguments({{"--record", record}, {"--trace", trace}})).exit_code, 0);
  }

  void edit(void (*change)(sessions::SessionCase&, const Runs&)) const {
    auto document = sessions::SessionDocument::open(session);
    sessions::SessionCase one = *document.session().findCase(kCase);
    change(one, *this);
    document.apply(sessions::withCase(document.session(), one), "Change");
    document.save();
  }
};

TEST(WhsCompare, TakesRecordsTracesAndRunsOfSessions) {
  const Runs runs;
  const auto exitOf = [](const Arguments& arguments) {
    Arguments all = {"compare"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ProgramRun run = runWhs(all);
    EXPECT_EQ(run.exit_code == 0, run.out.starts_with("equal to the bit")) << run.out;
    return run.exit_code;
  };
  EXPECT_EQ(exitOf({runs.record, runs.trace}), 0);
  EXPECT_EQ(exitOf({runs.trace, runs.record}), 0);
  EXPECT_EQ(exitOf({runs.record, runs.session, "--case", kCase}), 0);
  EXPECT_EQ(exitOf({runs.session, runs.trace, "--case", kCase}), 0);
  EXPECT_EQ(exitOf({runs.record, runs.session, "--case", kCase, "--rerun"}), 0);
  EXPECT_EQ(exitOf({runs.record, runs.session, "--case", kCase, "--run", "0000000"}), 3);
  EXPECT_EQ(exitOf({runs.session, "--case", kCase}), 3) << "no record is attached";
  runs.edit([](sessions::SessionCase& one, const Runs& made) {
    one.onboard_record = {made.record, sessions::inputSha256(made.record)};
  });
  EXPECT_EQ(exitOf({runs.session, "--case", kCase}), 0);
  EXPECT_EQ(exitOf({runs.session}), 2);
  EXPECT_EQ(exitOf({runs.record}), 2);
  EXPECT_EQ(exitOf({runs.session, runs.session, "--case", kCase}), 2);
  EXPECT_EQ(exitOf({runs.record, runs.session, "--case", "none"}), 3);
}

TEST(WhsNew, AttachesAnOnboardRecordToItsOneCase) {
  const Runs runs;
  const std::string made = runs.folder / "made.boresight.json";
  const std::string dataset = exampleFolder() / "dataset.json";
  EXPECT_EQ(runWhs({"new", "--dataset", dataset, "--record", runs.record, "--out", made}).exit_code,
            2);
  EXPECT_EQ(
      runWhs({"new", "--dataset", dataset, "--case", kCase, "--record", runs.trace, "--out", made})
          .exit_code,
      3);
  ASSERT_EQ(
      runWhs({"new", "--dataset", dataset, "--case", kCase, "--record", runs.record, "--out", made})
          .exit_code,
      0);
  const ProgramRun anew = runWhs({"compare", made, "--case", kCase, "--rerun"});
  EXPECT_EQ(anew.exit_code, 0) << anew.out;
}

TEST(WhsCompare, DoesNotTakeARunOfOtherInputsForTheCases) {
  const Runs runs;
  runs.edit([](sessions::SessionCase& one, const Runs&) {
    one.camera_from_station_seed.translation_m.x() += 1e-4;
  });
  const ProgramRun stale = runWhs({"compare", runs.record, runs.session, "--case", kCase});
  EXPECT_EQ(stale.exit_code, 3);
  EXPECT_THAT(stale.err, HasSubstr("no longer its own"));
  const ProgramRun anew =
      runWhs({"compare", runs.record, runs.session, "--case", kCase, "--rerun"});
  EXPECT_EQ(anew.exit_code, 6) << anew.out;
  EXPECT_THAT(anew.out, HasSubstr("first difference: seed"));
}

TEST(WhsCompare, RunsTheCaseByTheRecordsOptions) {
  const Runs runs;
  ASSERT_EQ(
      runWhs(localizeArguments({{"--record", runs.record}, {"--set", "pnp.seed=7"}})).exit_code, 0);
  const ProgramRun last = runWhs({"compare", runs.record, runs.session, "--case", kCase});
  EXPECT_EQ(last.exit_code, 6);
  EXPECT_THAT(last.out, HasSubstr("first difference: options"));
  const ProgramRun anew =
      runWhs({"compare", runs.record, runs.session, "--case", kCase, "--rerun"});
  EXPECT_EQ(anew.exit_code, 0) << anew.out;
}

}  // namespace
}  // namespace boresight::test
