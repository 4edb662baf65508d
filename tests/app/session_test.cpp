// SPDX-License-Identifier: Apache-2.0
// new, run, pack, and info of a session.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iterator>

#include "sessions/session/case_run.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_file.h"
#include "tests/app/ended_whs.h"
#include "tests/app/json_lines.h"
#include "tests/app/run_whs.h"
#include "tests/support/annotated_example.h"
#include "tests/support/matchers.h"
#include "tests/support/turned_view.h"

namespace boresight::test {
namespace {

using sessions::Session;
using sessions::SessionDocument;

TEST(WhsRun, TheImagesOfARigTogetherAreOneRunThatIsRepeated) {
  const TemporaryFolder folder;
  const std::string file = folder / "two.boresight.json";
  Session two = sessionOfTwoViews(folder.path());
  two.options = {{"search.enabled", false}};
  sessions::writeSessionFile(file, two);
  const ProgramRun run = runWhs({"run", file, "--views"}, 0);
  const Session session = sessions::readSessionFile(file).session;
  ASSERT_EQ(session.runs.size(), 2u) << "the rig was run once";
  for (std::size_t v = 0; v < 2; ++v) {
    const std::string& other = session.cases[1 - v]->id;
    EXPECT_EQ(session.runs[v].case_id, session.cases[v]->id);
    EXPECT_THAT(run.out,
                HasSubstr("together with " + other + ", digest " + session.runs[v].digest));
    const ProgramRun again = runWhs({"run", file, "--again", session.runs[v].digest}, 0);
    EXPECT_THAT(again.out, HasSubstr(session.runs[v].digest + ", the same"));
  }
  EXPECT_THAT(runWhs({"info", file}).out, HasSubstr("together with " + session.cases[1]->id));
  runWhs({"run", file, "--views", "--again", "0"}, 2);
  sessions::writeSessionFile(file, sessions::withoutRigLink(session, session.cases[0]->id));
  EXPECT_THAT(runWhs({"run", file, "--views", "--case", session.cases[0]->id}, 3).err,
              HasSubstr("has no rig"));
}

TEST(WhsRun, EndEffectorAndRequirementAreStatedAsAnEdit) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder, true);
  const std::string id = sessions::readSessionFile(file).session.cases[0]->id;
  runWhs({"run", file, "--case", id, "--end-effector", "0", "0.01", "0.4", "--requirement", "0.5",
          "0.6", "0.3"},
         0);
  const Session session = sessions::readSessionFile(file).session;
  EXPECT_EQ(session.cases[0]->camera_from_end_effector->translation_m,
            Eigen::Vector3d(0.0, 0.01, 0.4));
  EXPECT_EQ(session.cases[0]->requirement->lateral_mm, 0.6);
  EXPECT_NE(session.cases[1]->requirement, session.cases[0]->requirement) << "not asked for";
  runWhs({"run", file, "--again", session.runs[0].digest, "--requirement", "1"}, 2);
}

TEST(WhsRun, RepeatedRunWithAnotherDigest_IsDifferent) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder, true);
  const std::string id = sessions::readSessionFile(file).session.cases[0]->id;
  runWhs({"run", file, "--case", id, "--requirement", "1", "1", "1"}, 0);
  Session session = sessions::readSessionFile(file).session;
  std::string& digest = session.runs[0].digest;
  runWhs({"run", file, "--again", digest}, 0);
  digest.front() = digest.front() == 'a' ? 'b' : 'a';
  sessions::writeSessionFile(file, session);
  EXPECT_THAT(runWhs({"run", file, "--again", digest}, 6).out,
              HasSubstr("NOT the same as recorded"));
}

/// The traces in a session's folder of runs.
int storedTraces(const std::filesystem::path& session_file) {
  std::error_code none_yet;
  const std::filesystem::directory_iterator runs(sessions::runsFolderOf(session_file), none_yet);
  return static_cast<int>(std::count_if(begin(runs), end(runs), [](const auto& entry) {
    return entry.path().extension() == ".trace";
  }));
}

TEST(WhsRun, SignalKeepsAndSavesTheRunsThatEnded) {
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) {
    const TemporaryFolder folder;
    const std::string file = newSession(folder, true);
    Session session = sessions::readSessionFile(file).session;
    const sessions::SessionCase one = *session.cases[0];
    for (int i = 0; i < 100; ++i) {
      sessions::SessionCase copy = one;
      copy.id = "copy" + std::to_string(i);
      // Another run each, with a trace of its own.
      copy.camera_from_station_seed.translation_m.x() += 1e-6 * i;
      session.cases.push_back(std::move(copy));
    }
    sessions::writeSessionFile(file, session);
    const EndedWhs ended = endWhsWhen(
        {"run", file}, signal, [&file] { return storedTraces(file); }, 2);
    ASSERT_TRUE(WIFEXITED(ended.status)) << signal;
    EXPECT_EQ(WEXITSTATUS(ended.status), 128 + signal);
    EXPECT_FALSE(std::filesystem::exists(sessions::journalFileOf(file)));
    EXPECT_FALSE(std::filesystem::exists(sessions::lockFileOf(file)));
    const Session saved = sessions::readSessionFile(file).session;
    EXPECT_EQ(saved.runs.size(), static_cast<std::size_t>(ended.held));
    EXPECT_GE(ended.held, 2);
    EXPECT_LT(saved.runs.size(), session.cases.size());
  }
}

/// A session of copies of a case that differ by their seeds, or are run once for all.
Session copiesOf(const std::string& file, int count, double step_m) {
  Session session = sessions::readSessionFile(file).session;
  const sessions::SessionCase one = *session.cases[0];
  const auto runs = session.runs;
  session.runs.clear();
  session.cases.clear();
  for (int i = 0; i < count; ++i) {
    sessions::SessionCase copy = one;
    copy.id = "copy" + std::to_string(i);
    copy.camera_from_station_seed.translation_m.x() += step_m * i;
    session.cases.push_back(std::move(copy));
    for (sessions::RunRecord run : runs) {
      run.case_id = "copy" + std::to_string(i);
      session.runs.push_back(std::move(run));
    }
  }
  return session;
}

TEST(WhsRun, ErrorOfTheWhole_KeepsAndSavesTheRunsBefore) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  const Session session = copiesOf(file, 2, 1e-6);
  sessions::writeSessionFile(file, session);
  runWhs({"run", file}, 0);
  const Session ran = sessions::readSessionFile(file).session;
  ASSERT_EQ(ran.runs.size(), 2u);
  // The same again, where the second trace cannot be written.
  sessions::writeSessionFile(file, session);
  std::filesystem::remove(ran.runs[1].file);
  std::filesystem::create_directory(ran.runs[1].file);
  EXPECT_THAT(runWhs({"run", file}, 3).err,
              AllOf(HasSubstr("the runs that ended before are saved"), HasSubstr("cannot write")));
  const Session saved = sessions::readSessionFile(file).session;
  ASSERT_EQ(saved.runs.size(), 1u);
  EXPECT_EQ(saved.runs[0].digest, ran.runs[0].digest);
  EXPECT_FALSE(std::filesystem::exists(sessions::journalFileOf(file)));
  std::filesystem::remove(ran.runs[1].file);
  runWhs({"run", file}, 0);  // needs no recovery
}

/// The number of cases whose inputs a whs has read, by its log in this folder.
int casesRead(const TemporaryFolder& folder) {
  const std::string log = folder.read("state/boresight/boresight.log");
  int count = 0;
  for (std::size_t at = 0; (at = log.find(": inputs SHA-256 ", at)) != std::string::npos; ++at)
    ++count;
  return count;
}

/// Commands that check a run, and get a signal in their convergence tests.
class SignalledCheck : public testing::TestWithParam<int> {
 protected:
  SignalledCheck() {
    runWhs({"run", file_}, 0);
    sessions::writeSessionFile(file_, copiesOf(file_, 3, 0.0));
    before_ = folder_.read("s.boresight.json");
    ::setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
  }
  ~SignalledCheck() override { ::setenv("XDG_STATE_HOME", "/dev/null", 1); }

  void expectEnded(const EndedWhs& ended) const {
    ASSERT_TRUE(WIFEXITED(ended.status)) << "it has the signal's default action";
    EXPECT_EQ(WEXITSTATUS(ended.status), 128 + GetParam());
    EXPECT_EQ(folder_.read("s.boresight.json"), before_);
    EXPECT_FALSE(std::filesystem::exists(sessions::journalFileOf(file_)));
    EXPECT_FALSE(std::filesystem::exists(sessions::lockFileOf(file_)));
  }

  const TemporaryFolder folder_;
  const std::string file_ = newSession(folder_);
  std::string before_;
};

TEST_P(SignalledCheck, Check_KeepsTheCasesThatAreChecked) {
  const std::string json = folder_ / "checks.json";
  expectEnded(endWhsWhen(
      {"check", file_, "--json", json, "--convergence-test", "100"}, GetParam(),
      [this] { return casesRead(folder_); }, 1));
  EXPECT_EQ(jsonOf(json)["cases"].size(), 0u) << "the first was not complete";
  expectEnded(endWhsWhen(
      {"check", file_, "--json", json, "--convergence-test", "3"}, GetParam(),
      [this] { return casesRead(folder_); }, 3));
  EXPECT_EQ(jsonOf(json)["cases"].size(), 1u);
}

TEST_P(SignalledCheck, Decide_DecidesNothing) {
  expectEnded(endWhsWhen(
      {"decide", file_, "--case", "copy0", "--validate", "--by", "Ada", "--comment", "right",
       "--convergence-test", "100"},
      GetParam(), [this] { return casesRead(folder_); }, 1));
}

/// A command that keeps nothing of what it has not finished ends at once, with the signal itself.
TEST_P(SignalledCheck, Verify_EndsByTheSignal) {
  runWhs({"export", file_, "--case", "copy0", "--pose", folder_ / "pose.json"}, 0);
  const int before = casesRead(folder_);
  const EndedWhs ended = endWhsWhen(
      {"verify", folder_ / "pose.json"}, GetParam(), [this] { return casesRead(folder_); },
      before + 1);
  ASSERT_TRUE(WIFSIGNALED(ended.status));
  EXPECT_EQ(WTERMSIG(ended.status), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Signals, SignalledCheck, testing::Values(SIGINT, SIGTERM));

TEST(WhsPack, SignalLeavesNoTemporaryFile) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder, true);
  const std::filesystem::path archive = folder / "out/s.zip";
  std::filesystem::create_directory(archive.parent_path());
  const auto files = [&archive] {
    const std::filesystem::directory_iterator all(archive.parent_path());
    return static_cast<int>(std::distance(begin(all), end(all)));
  };
  const EndedWhs ended = endWhsWhen({"pack", file, "--out", archive.string()}, SIGTERM, files, 1);
  EXPECT_EQ(ended.held, std::filesystem::exists(archive) ? 1 : 0) << "the archive, or nothing";
}

TEST(WhsNew, RefusesWhatIsIncompleteOrThere) {
  const TemporaryFolder folder;
  runWhs({"new", "--dataset", exampleDataset(), "--out", folder.write("s.json", "mine")}, 3);
  EXPECT_EQ(folder.read("s.json"), "mine");
  const std::string out = folder / "t.json";
  runWhs({"new", "--out", out}, 2);
  runWhs({"new", "--image", "a.png", "--out", out}, 2);
  runWhs({"new", "--dataset", exampleDataset(), "--case", "x", "--out", out}, 3);
  runWhs({"new", "--dataset", "none.json", "--out", out}, 3);
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(WhsNew, EveryProfileMakesASession) {
  const TemporaryFolder folder;
  for (const char* profile : {"default", "paper", "flight"}) {
    const std::string out = folder / (std::string(profile) + ".boresight.json");
    const ProgramRun run =
        runWhs({"new", "--dataset", exampleDataset(), "--profile", profile, "--out", out}, 0);
    EXPECT_EQ(run.err.find("only localize, follow and evaluate have the memory limit") !=
                  std::string::npos,
              std::string(profile) == "flight");
    const sessions::Session session = sessions::readSessionFile(out).session;
    EXPECT_EQ(sessions::sessionOptions(session, out).search.color,
              std::string(profile) != "flight");
  }
}

TEST(WhsNew, SaysAtOnceWhatARunWouldRefuse) {
  const TemporaryFolder folder;
  const std::filesystem::path os = exampleFolder() / "os";
  const std::string out = folder / "s.boresight.json";
  const auto make = [&](const std::string& camera, const std::string& seed, int exit_code) {
    return runWhs({"new", "--image", os / "image.png", "--camera", camera, "--mesh",
                   os / "model.ply", "--mesh-unit", "m", "--seed", seed, "--out", out},
                  exit_code)
        .err;
  };
  auto camera = jsonOf(os / "camera.json");
  camera["width"] = 700;
  EXPECT_THAT(make(folder.write("camera.json", camera.dump()), os / "seed.json", 3),
              HasSubstr("is 1024 x 1024, but the camera is 700 x 1024"));
  EXPECT_FALSE(std::filesystem::exists(out)) << "nothing is in the way of the next try";
  auto seed = jsonOf(os / "seed.json");
  seed["camera_from_station"][2][3] = -0.4;  // a person can move it
  EXPECT_THAT(make(os / "camera.json", folder.write("seed.json", seed.dump()), 0),
              HasSubstr("a run cannot start from this seed: case image: seed: "));
}

TEST(WhsRun, RecordsTheRunOfLocalizeAndInfoTellsIt) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  const ProgramRun run = runWhs({"run", file}, 0);
  const ProgramRun localized = runWhs(localizeArguments());
  const Session session = sessions::readSessionFile(file).session;
  ASSERT_EQ(session.runs.size(), 1u);
  EXPECT_THAT(localized.out, HasSubstr("digest " + session.runs[0].digest));
  EXPECT_THAT(run.out, AllOf(HasSubstr(": converged, "), HasSubstr(session.runs[0].digest)));
  EXPECT_TRUE(
      std::filesystem::exists(folder / ("s.boresight.runs/" + session.runs[0].digest + ".trace")));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.boresight.journal"));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.boresight.lock"));

  EXPECT_THAT(runWhs({"info", file}, 0).out,
              AllOf(HasSubstr("run " + session.runs[0].digest + ": converged"),
                    HasSubstr("field of view: "), HasSubstr("seed: "), Not(HasSubstr("outdated"))));
  {
    SessionDocument document = SessionDocument::open(file);
    LocalizerOptions options = sessionOptions(document.session(), file);
    options.pnp.seed += 1;
    document.apply(withOptions(document.session(), "default", options), "Another seed");
    document.save();
  }
  EXPECT_THAT(runWhs({"info", file}).out, HasSubstr("outdated: options changed since"));
}

TEST(WhsRun, RunsARecordedRunAgainWithTheOptionsThatItTookUp) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  runWhs({"run", file}, 0);
  Session session = sessions::readSessionFile(file).session;
  const std::string plain = session.runs[0].digest;
  {
    SessionDocument document = SessionDocument::open(file);
    const auto loaded = sessions::loadCase(*session.cases[0]);
    const sessions::LocalizationTrace first = sessions::loadRun(session.runs[0]);
    LocalizerOptions other = first.options;
    other.loop.render_again_px = 5.0;
    const auto trace = sessions::runCase(*loaded, continuedPlan(first.plan(), 2, other));
    session =
        withRun(session, sessions::storeRun(session, session.cases[0]->id, trace, file, plain));
    document.apply(session, "Run from an iteration");
    document.save();
  }
  const std::string rerun = session.runs[1].digest;
  EXPECT_THAT(runWhs({"run", file, "--again", rerun.substr(0, 12)}, 0).out,
              HasSubstr("digest " + rerun + ", the same"));
  EXPECT_THAT(runWhs({"run", file, "--again", plain}).out, HasSubstr(plain + ", the same"));
  runWhs({"run", file, "--again", "xyz"}, 3);
  EXPECT_THAT(runWhs({"run", file, "--again", ""}).out, HasSubstr("converged"));
  EXPECT_THAT(runWhs({"info", file}).out,
              HasSubstr("other options from its iteration 3 on, continued from run " + plain));
}

TEST(WhsRun, RefusesWhatItMustNotTouch) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  runWhs({"run", folder / "none.json"}, 3);
  runWhs({"run", file, "--case", "x"}, 3);
  runWhs({"run", exampleDataset()}, 3);
  {
    SessionDocument document = SessionDocument::open(file);
    EXPECT_THAT(refusal({"run", file}), HasSubstr("it is open already: process "));
    Session next = document.session();
    next.view.case_id = next.cases[0]->id;
    document.apply(next, "Look at it");
  }
  EXPECT_THAT(runWhs({"run", file}, 3).err, HasSubstr("1 edit was never saved"));
  EXPECT_THAT(runWhs({"check", file}, 3).err, HasSubstr("recover with `whs decide --recover`"));
  EXPECT_THAT(runWhs({"info", file}).out,
              HasSubstr("1 edit was never saved: recover with `whs decide"));
  runWhs({"pack", file, "--out", folder / "p.zip"}, 3);
  EXPECT_FALSE(std::filesystem::exists(folder / "p.zip"));
}

TEST(WhsPack, MakesAnArchiveAndRefusesChangedInputs) {
  const TemporaryFolder folder;
  const std::string file = folder / "s.json";
  runWhs({"new", "--dataset", copyOfExample(folder), "--out", file}, 0);
  EXPECT_THAT(runWhs({"pack", file, "--out", folder / "s.zip"}, 0).out,
              AllOf(HasSubstr("/image.png from " + (folder / "stations").string()),
                    HasSubstr("/model.ply from ")));
  EXPECT_EQ(folder.read("s.zip").substr(0, 2), "PK");
  folder.write("stations/os/model.ply", folder.read("stations/bc/model.ply"));
  runWhs({"pack", file, "--out", folder / "t.zip"}, 3);
  runWhs({"run", file, "--case", kOsCase}, 3);
  EXPECT_THAT(runWhs({"info", file}).out, HasSubstr("! "));
}

TEST(WhsInfo, ReadsTheInputsOfABoundedNumberOfCases) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  Session session = sessions::readSessionFile(file).session;
  sessions::SessionCase session_case = *session.cases[0];
  session_case.image.source.file = folder / "none.png";
  session.cases.clear();
  for (int i = 0; i < 250; ++i) {
    session_case.id = "case-" + std::to_string(i);
    session.cases.push_back(session_case);
  }
  sessions::writeSessionFile(file, session);
  EXPECT_THAT(
      runWhs({"info", file}, 0).out,
      AllOf(HasSubstr("250 cases, 0 runs"), HasSubstr("and 50 more cases: whs queue lists them"),
            HasSubstr("case case-199,"), Not(HasSubstr("case case-200,"))));
}

TEST(WhsPack, TakesLandmarksAlongWhereTheyAre) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  sessions::Session session = sessions::readSessionFile(file).session;
  sessions::SessionCase session_case = *session.cases[0];
  session_case.landmarks = folder.write(
      "named points.json", R"({"format": "boresight-landmarks", "version": 1, "landmarks": []})");
  sessions::writeSessionFile(file, withCase(session, session_case));
  EXPECT_EQ(runWhs({"pack", file, "--out", folder / "s.zip"}, 0).err, "");
  EXPECT_THAT(folder.read("s.zip"), HasSubstr("/named points.json"));
  std::filesystem::remove(*session_case.landmarks);
  EXPECT_THAT(runWhs({"pack", file, "--out", folder / "t.zip"}, 0).err,
              HasSubstr("the landmarks of case " + session_case.id + " are missing"));
  EXPECT_THAT(folder.read("t.zip"), Not(HasSubstr("/named points.json")));
}

// export and import.

class WhsExchange : public testing::Test {
 protected:
  WhsExchange() { sessions::writeSessionFile(file_, session_); }

  Session saved() const { return sessions::readSessionFile(file_).session; }

  TemporaryFolder folder_;
  std::string file_ = folder_ / "s.boresight.json";
  Session session_ = annotatedExample(0.2);
  std::string bc_ = caseOfStation(session_, "bc");
  std::string os_ = caseOfStation(session_, "os");
};

TEST_F(WhsExchange, TakesPosesOutAndInAgain) {
  for (const char* form : {"--colmap", "--bop"}) {
    const std::string folder = folder_ / ("out" + std::string(form));
    EXPECT_EQ(runWhs({"export", file_, form, folder, "--case", bc_}, 0).out, bc_ + "\n");
    // Another folder of this name is not touched.
    runWhs({"export", file_, form, folder, "--case", bc_}, 3);
    runWhs({"import", file_, form, folder}, 3);
    EXPECT_EQ(runWhs({"import", file_, form, folder, "--replace"}, 0).out, bc_ + "\n");
    const auto error = perturbationBetween(*saved().findCase(bc_)->camera_from_station_truth,
                                           *session_.findCase(bc_)->camera_from_station_truth);
    EXPECT_GT(error.norm(), 1e-7);  // the annotations are noisy
    EXPECT_LT(error.norm(), 5e-3);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.boresight.journal"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.boresight.lock"));
}

TEST_F(WhsExchange, TakesAnnotationsOutAndInAgain) {
  const std::string points = folder_ / "points.csv";
  runWhs({"export", file_, "--points", points, "--case", bc_}, 0);
  runWhs({"import", file_, "--points", points, "--case", os_, "--replace"}, 0);
  EXPECT_EQ(*saved().annotations.at(os_), *session_.annotations.at(bc_));
  const std::string landmarks = folder_ / "landmarks.json";
  runWhs({"export", file_, "--landmarks", landmarks, "--case", bc_}, 0);
  EXPECT_THAT(folder_.read("landmarks.json"), HasSubstr("boresight-landmarks"));
}

TEST_F(WhsExchange, RefusesWhatIsIncompleteOrWrong) {
  const std::string before = folder_.read("s.boresight.json");
  const std::string points = folder_ / "points.json";
  runWhs({"export", file_}, 2);
  runWhs({"import", file_}, 2);
  runWhs({"export", file_, "--points", points}, 2);
  runWhs({"export", file_, "--points", points, "--bop", points}, 2);
  runWhs({"export", file_, "--points", points, "--case", "x"}, 3);
  const Arguments importing = {"import", file_, "--points", points, "--case", bc_, "--replace"};
  refusal(importing);  // there are no points yet
  const auto writePoint = [this](const std::string& point) {
    folder_.write("points.json",
                  R"({"format": "boresight-points", "version": 1, "points": [)" + point + "]}");
  };
  writePoint(R"({"id": "far", "pixel": [99373, 2]})");
  EXPECT_THAT(runWhs(importing, 3).err, HasSubstr("far"));
  writePoint(R"({"id": "p1", "pixel": [1, 2]})");
  const auto open = SessionDocument::open(file_);
  refusal(importing);
  EXPECT_EQ(folder_.read("s.boresight.json"), before);
}

}  // namespace
}  // namespace boresight::test
