// SPDX-License-Identifier: Apache-2.0
// new, run, pack, and info of a session.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include <nlohmann/json.hpp>

#include "sessions/session/case_run.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_file.h"
#include "tests/app/run_whs.h"
#include "tests/support/turned_view.h"

namespace boresight::test {
namespace {

using sessions::Session;
using sessions::SessionDocument;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::filesystem::path kDataset = exampleFolder() / "dataset.json";

/// The id of the orbiting sample's case.
std::string idOfOs() {
  for (const sessions::Case& one : sessions::readDataset(kDataset).cases)
    if (one.station == "os") return one.id;
  return "";
}

/// A session of one case in `folder`.
std::string newSession(const TemporaryFolder& folder) {
  const std::string file = folder / "s.boresight.json";
  const ProgramRun made = runWhs({"new", "--dataset", kDataset, "--case", idOfOs(), "--out", file});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  return file;
}

TEST(WhsRun, TheImagesOfARigTogetherAreOneRunThatIsRepeated) {
  const TemporaryFolder folder;
  const std::string file = folder / "two.boresight.json";
  sessions::writeSessionFile(file, sessionOfTwoViews(folder.path()));
  const ProgramRun run = runWhs({"run", file, "--views"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Session session = sessions::readSessionFile(file).session;
  ASSERT_EQ(session.runs.size(), 2u) << "the rig was run once";
  for (std::size_t v = 0; v < 2; ++v) {
    const std::string& other = session.cases[1 - v]->id;
    EXPECT_EQ(session.runs[v].case_id, session.cases[v]->id);
    EXPECT_THAT(run.out,
                HasSubstr("together with " + other + ", digest " + session.runs[v].digest));
    const ProgramRun again = runWhs({"run", file, "--again", session.runs[v].digest});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_THAT(again.out, HasSubstr(session.runs[v].digest + ", the same"));
  }
  EXPECT_THAT(runWhs({"info", file}).out, HasSubstr("together with " + session.cases[1]->id));
  EXPECT_EQ(runWhs({"run", file, "--views", "--again", "0"}).exit_code, 2);
  sessions::Session alone = session;
  alone = sessions::withoutRigLink(alone, session.cases[0]->id);
  sessions::writeSessionFile(file, alone);
  const ProgramRun refused = runWhs({"run", file, "--views", "--case", session.cases[0]->id});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("of no rig"));
}

TEST(WhsNew, RefusesWhatIsIncompleteOrThere) {
  const TemporaryFolder folder;
  const std::string file = folder.write("s.json", "mine");
  const ProgramRun there = runWhs({"new", "--dataset", kDataset, "--out", file});
  EXPECT_EQ(there.exit_code, 3);
  EXPECT_THAT(there.err, HasSubstr("there is a file of this name already"));
  EXPECT_EQ(folder.read("s.json"), "mine");
  const std::string out = folder / "t.json";
  EXPECT_EQ(runWhs({"new", "--out", out}).exit_code, 2);
  EXPECT_EQ(runWhs({"new", "--image", "a.png", "--out", out}).exit_code, 2);
  EXPECT_EQ(runWhs({"new", "--dataset", kDataset, "--case", "x", "--out", out}).exit_code, 3);
  EXPECT_EQ(runWhs({"new", "--dataset", "none.json", "--out", out}).exit_code, 3);
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(WhsNew, SaysAtOnceWhatARunWouldRefuse) {
  const TemporaryFolder folder;
  const std::filesystem::path os = exampleFolder() / "os";
  const std::string out = folder / "s.boresight.json";
  const auto make = [&](const std::string& camera, const std::string& seed) {
    return runWhs({"new", "--image", os / "image.png", "--camera", camera, "--mesh",
                   os / "model.ply", "--mesh-unit", "m", "--seed", seed, "--out", out});
  };
  nlohmann::json camera = nlohmann::json::parse(std::ifstream(os / "camera.json"));
  camera["width"] = 700;
  const ProgramRun cropped =
      make(folder.write("camera.json", camera.dump()).string(), os / "seed.json");
  EXPECT_EQ(cropped.exit_code, 3);
  EXPECT_THAT(cropped.err, HasSubstr("is 1024 x 1024, but the camera is 700 x 1024"));
  EXPECT_FALSE(std::filesystem::exists(out)) << "nothing is in the way of the next try";
  nlohmann::json seed = nlohmann::json::parse(std::ifstream(os / "seed.json"));
  seed["camera_from_station"][2][3] = -0.4;
  const ProgramRun behind = make(os / "camera.json", folder.write("seed.json", seed.dump()));
  EXPECT_EQ(behind.exit_code, 0) << "a person can move it";
  EXPECT_THAT(behind.err, HasSubstr("no run begins like this: case image: seed: "));
}

TEST(WhsRun, RecordsTheRunOfLocalizeAndInfoTellsIt) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  const ProgramRun run = runWhs({"run", file});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ProgramRun localized = runWhs(localizeArguments());
  const Session session = sessions::readSessionFile(file).session;
  ASSERT_EQ(session.runs.size(), 1u);
  EXPECT_THAT(localized.out, HasSubstr("digest " + session.runs[0].digest));
  EXPECT_THAT(run.out, AllOf(HasSubstr(": converged, "), HasSubstr(session.runs[0].digest)));
  EXPECT_TRUE(
      std::filesystem::exists(folder / ("s.boresight.runs/" + session.runs[0].digest + ".trace")));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.boresight.journal"));
  EXPECT_FALSE(std::filesystem::exists(folder / "s.boresight.lock"));

  ProgramRun info = runWhs({"info", file});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out,
              AllOf(HasSubstr("run " + session.runs[0].digest + ": converged"),
                    HasSubstr("field of view: "), HasSubstr("seed: "), Not(HasSubstr("stale"))));
  {
    SessionDocument document = SessionDocument::open(file);
    LocalizerOptions options = defaultProfile();
    options.pnp.seed += 1;
    document.apply(withOptions(document.session(), "default", options), "Another seed");
    document.save();
  }
  info = runWhs({"info", file});
  EXPECT_THAT(info.out, HasSubstr("stale: options changed since"));
}

TEST(WhsRun, RunsARecordedRunAgainWithTheOptionsThatItTookUp) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  ASSERT_EQ(runWhs({"run", file}).exit_code, 0);
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
  const ProgramRun again = runWhs({"run", file, "--again", rerun.substr(0, 12)});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("digest " + rerun + ", the same"));
  EXPECT_THAT(runWhs({"run", file, "--again", plain}).out, HasSubstr(plain + ", the same"));
  EXPECT_EQ(runWhs({"run", file, "--again", "xyz"}).exit_code, 3);
  EXPECT_THAT(runWhs({"run", file, "--again", ""}).out, HasSubstr("converged"));
  EXPECT_THAT(runWhs({"info", file}).out,
              HasSubstr("other options from its iteration 3 on, going on from run " + plain));
}

TEST(WhsRun, RefusesWhatItMustNotTouch) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  EXPECT_EQ(runWhs({"run", folder / "none.json"}).exit_code, 3);
  EXPECT_EQ(runWhs({"run", file, "--case", "x"}).exit_code, 3);
  EXPECT_EQ(runWhs({"run", kDataset}).exit_code, 3);
  {
    SessionDocument document = SessionDocument::open(file);
    const ProgramRun busy = runWhs({"run", file});
    EXPECT_EQ(busy.exit_code, 3);
    EXPECT_THAT(busy.err, HasSubstr("it is open already: process "));
    EXPECT_EQ(busy.errorLines(), 1);
    Session next = document.session();
    next.view.case_id = next.cases[0]->id;
    document.apply(next, "Look at it");
  }
  const ProgramRun unsaved = runWhs({"run", file});
  EXPECT_EQ(unsaved.exit_code, 3);
  EXPECT_THAT(unsaved.err, HasSubstr("1 edits were never saved"));
  EXPECT_THAT(runWhs({"info", file}).out, HasSubstr("1 edits are in its journal"));
  EXPECT_EQ(runWhs({"pack", file, "--out", folder / "p.zip"}).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(folder / "p.zip"));
}

TEST(WhsPack, MakesAnArchiveAndRefusesChangedInputs) {
  const TemporaryFolder folder;
  std::filesystem::copy(exampleFolder(), folder / "stations",
                        std::filesystem::copy_options::recursive);
  const std::string file = folder / "s.json";
  ASSERT_EQ(runWhs({"new", "--dataset", folder / "stations/dataset.json", "--out", file}).exit_code,
            0);
  EXPECT_EQ(runWhs({"pack", file, "--out", folder / "s.zip"}).exit_code, 0);
  EXPECT_EQ(folder.read("s.zip").substr(0, 2), "PK");
  folder.write("stations/os/model.ply", folder.read("stations/bc/model.ply"));
  const ProgramRun changed = runWhs({"pack", file, "--out", folder / "t.zip"});
  EXPECT_EQ(changed.exit_code, 3);
  EXPECT_THAT(changed.err, HasSubstr("stations/os/model.ply: it is not the file"));
  EXPECT_FALSE(std::filesystem::exists(folder / "t.zip"));
  const ProgramRun run = runWhs({"run", file, "--case", idOfOs()});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("its bytes are not those that the session was made with"));
  EXPECT_THAT(runWhs({"info", file}).out, HasSubstr("! "));
}

TEST(WhsInfo, ReadsTheInputsOfABoundedNumberOfCases) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  Session session = sessions::readSessionFile(file).session;
  sessions::SessionCase one = *session.cases[0];
  one.image.source.file = folder / "none.png";
  session.cases.clear();
  for (int i = 0; i < 250; ++i) {
    one.id = "case-" + std::to_string(i);
    session.cases.push_back(one);
  }
  sessions::writeSessionFile(file, session);
  const ProgramRun run = runWhs({"info", file});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("250 cases, 0 runs"));
  EXPECT_THAT(run.out, HasSubstr("and 50 more cases: whs queue lists them"));
  EXPECT_THAT(run.out, HasSubstr("case case-199,"));
  EXPECT_THAT(run.out, Not(HasSubstr("case case-200,")));
}

TEST(WhsPack, TakesLandmarksAlongWhereTheyAre) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  sessions::Session session = sessions::readSessionFile(file).session;
  sessions::SessionCase one = *session.cases[0];
  one.landmarks = folder.write(
      "named points.json", R"({"format": "boresight-landmarks", "version": 1, "landmarks": []})");
  sessions::writeSessionFile(file, withCase(session, one));
  const ProgramRun packed = runWhs({"pack", file, "--out", folder / "s.zip"});
  EXPECT_EQ(packed.exit_code, 0) << packed.err;
  EXPECT_EQ(packed.errorLines(), 0);
  EXPECT_THAT(folder.read("s.zip"), HasSubstr("/named points.json"));
  std::filesystem::remove(*one.landmarks);
  const ProgramRun without = runWhs({"pack", file, "--out", folder / "t.zip"});
  EXPECT_EQ(without.exit_code, 0);
  EXPECT_THAT(without.err, HasSubstr("the landmarks of case " + one.id + " are missing"));
  EXPECT_THAT(folder.read("t.zip"), Not(HasSubstr("/named points.json")));
}

TEST(WhsPack, ListsWhatItTakesAlongAndRefusesAnyOtherFile) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  const ProgramRun packed = runWhs({"pack", file, "--out", folder / "s.zip"});
  EXPECT_EQ(packed.exit_code, 0) << packed.err;
  EXPECT_THAT(packed.out, AllOf(HasSubstr("/image.png from " + exampleFolder().string()),
                                HasSubstr("/model.ply from ")));
  const std::string whole = folder.read("s.boresight.json");
  const auto refusal = [&](const std::function<void(nlohmann::json&)>& edit) {
    nlohmann::json session = nlohmann::json::parse(whole);
    edit(session);
    folder.write("s.boresight.json", session.dump());
    const ProgramRun run = runWhs({"pack", file, "--out", folder / "t.zip"});
    EXPECT_EQ(run.exit_code, 3) << run.out;
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(std::filesystem::exists(folder / "t.zip"));
    return run.err;
  };
  EXPECT_THAT(
      refusal([](auto& s) { s["cases"][0]["landmarks"] = "../../../../../../../../etc/passwd"; }),
      HasSubstr("s.boresight.json: cases[0].landmarks: /etc/passwd: "));
  EXPECT_THAT(refusal([](auto& s) {
                const std::string digest(64, 'd');
                s["runs"] = {{{"case", s["cases"][0]["id"]},
                              {"digest", digest},
                              {"file", "/etc/passwd"},
                              {"status", "converged"},
                              {"version", "0.1.0"},
                              {"time", "2026-01-31T23:59:59Z"},
                              {"inputs_sha256", digest},
                              {"options_sha256", digest}}};
              }),
              HasSubstr("s.boresight.json: runs[0].file: /etc/passwd: "));
}

}  // namespace
}  // namespace boresight::test
