// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_file.h"

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "tests/sessions/session/random_session.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using namespace sessions;

using nlohmann::json;

TEST(SessionFile, ReadsBackWhatItWrote) {
  Random random = randomFor("SessionFile");
  const TemporaryFolder folder;
  for (int i = 0; i < 200; ++i) {
    const Session session = randomSession(random);
    const std::string sha256 = writeSessionFile(folder / "s.json", session);
    const SavedSession read = readSessionFile(folder / "s.json");
    ASSERT_TRUE(read.session == session) << folder.read("s.json");
    ASSERT_EQ(read.file_sha256, sha256);
    ASSERT_EQ(sessionText(read.session, folder / "s.json"), folder.read("s.json"));
  }
}

TEST(SessionFile, AnArchiveIsToBeUnpackedFirst) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("s.zip", "PK\x03\x04 and so on");
  EXPECT_EQ(folder.message([&] { (void)readSessionFile(file); }),
            "s.zip: an archive of whs pack: unpack it, then open its session");
}

/// Leaves one part, which is matched.
void keepMatchedPart(SessionCase& session_case) {
  session_case.parts.resize(1);
  session_case.parts[0].source.state = {};
  session_case.parts[0].source.frame = kStationFrame;
}

TEST(SessionFile, NamesFilesRelativeToItself) {
  const TemporaryFolder folder;
  Random random = randomFor("paths");
  SessionCase session_case = randomCase(random, "a");
  session_case.image.source.file = folder / "images/1.png";
  keepMatchedPart(session_case);
  session_case.parts[0].source.mesh = folder.path().parent_path() / "mesh.ply";
  std::filesystem::create_directories(folder / "deep/er");
  writeSessionFile(folder / "deep/s.json", withCase({}, session_case));
  const json written = json::parse(folder.read("deep/s.json"));
  EXPECT_EQ(written["cases"][0]["image"]["file"], "../images/1.png");
  EXPECT_EQ(written["cases"][0]["parts"][0]["file"], "../../mesh.ply");
  // Moved together with its inputs, it names the moved ones.
  folder.write("deep/er/s.json", folder.read("deep/s.json"));
  const Session moved = readSessionFile(folder / "deep/er/s.json").session;
  EXPECT_EQ(moved.cases[0]->image.source.file, folder / "deep/images/1.png");
}

TEST(SessionFile, CompanionFiles_HaveTheirNames) {
  EXPECT_EQ(journalFileOf("/a/x.boresight.json"), "/a/x.boresight.journal");
  EXPECT_EQ(lockFileOf("/a/x.json"), "/a/x.lock");
  EXPECT_EQ(runsFolderOf("/a/x.sol12"), "/a/x.sol12-runs");
  EXPECT_EQ(runFileOf("/a/x.json", "d"), "/a/x.runs/d.trace");
}

/// A whole session as JSON, to be spoilt in one place.
json goodSession() {
  Random random = randomFor("goodSession");
  SessionCase session_case = randomCase(random, "bc");
  keepMatchedPart(session_case);
  session_case.ignore_strokes = {MaskStroke()};
  session_case.camera = makePinhole(100, 80, 200.0);
  session_case.image.eight_bit = {};
  Session session = withCase({}, session_case);
  session = withAnnotations(session, "bc", randomAnnotations(random));
  session = withRounds(session, "bc", randomRounds(random));
  session.decisions.push_back({"bc", Verdict::kValidated, "Ada", "", "2026-01-31T23:59:59Z", ""});
  session.runs.push_back({"bc", std::string(64, 'a'), "/x", "converged", "0.1.0",
                          "2026-01-31T23:59:59Z", std::string(64, 'b'), std::string(64, 'c')});
  return json::parse(sessionText(session, "/s.json"));
}

/// A place of the session's JSON, what is merged into it there (RFC 7396; "@": a copy of another
/// place), and what is said of the file.
struct Spoilt {
  const char* place;
  const char* value;
  const char* message;
};

constexpr Spoilt kSpoilt[] = {
    {"", "[]", "s.json: not a JSON object"},
    {"", R"({"format": null})", "s.json: format: missing"},
    {"/format", R"("boresight-pose")", "format: is 'boresight-pose'"},
    {"/version", "2", "version: version 2 was written by a newer program"},
    {"/version", "0", "version: there is no version 0"},
    {"/version", R"("1")", "version: not an integer"},
    {"/zoom", "1", "zoom: is not known to this version"},
    {"/profile", R"("best")", "profile: there is no profile \"best\""},
    {"/options/pnp.speed", "1", "options.pnp.speed: unknown option"},
    {"/options/loop.max_iterations", "0", "options.loop.max_iterations: "},
    {"", R"({"cases": null})", "cases: missing"},
    {"/cases/-", "@/cases/0", "cases[1].id: 'bc' is given twice"},
    {"/cases/0/id", R"("")", "cases[0].id: is empty"},
    {"/cases/0/image/sha256", R"("12")", "cases[0].image.sha256: not a SHA"},
    {"/cases/0/image/width", "0", "cases[0].image.width: 0 is outside"},
    {"/cases/0/image/rule", R"("log")", "image.rule: 'log' is none of"},
    {"/cases/0/image/rule", R"("table")", "image.table: missing"},
    {"/cases/0/image/table", "[1]", "image.table: given although"},
    {"/cases/0/image", R"({"rule": "table", "bit_depth": 2, "table": [1, 2, 3]})",
     "image.table: has 3 values, but bit_depth needs 4"},
    {"/cases/0/image/files", "1", "image.files: is not known"},
    {"/cases/0/camera/fx", "0", "cases[0].camera.fx: "},
    {"/cases/0/parts", "[]", "parts: no part is to be matched"},
    {"/cases/0/parts/0/file", R"("a.doc")", "parts[0].file: "},
    {"/cases/0/parts/0/mesh_unit", R"("elle")", "unknown unit 'elle'"},
    {"/cases/0/parts/0", R"({"mesh_unit": null})", "mesh_unit: missing: PLY"},
    {"/cases/0/seed/rotation_wxyz", "[1, 1, 0, 0]", "seed.rotation_wxyz: not a unit quaternion"},
    {"/cases/0/seed/rotation_wxyz", "[1, 0, 0]", "not a list of 4"},
    {"/cases/0/seed/translation_m/1", "1e9", "translation_m[1]: "},
    {"/cases/0/uncertainty/pivot", R"("moon")", "uncertainty.pivot: "},
    {"/cases/0/uncertainty/pivots", "1", "uncertainty.pivots: "},
    {"/cases/0/ignore_strokes/0/kind", R"("pen")", "strokes[0].kind: "},
    {"/cases/0/ignore_strokes/0/points", "[[1e9, 0]]", "points[0]: is"},
    {"/annotations/os", "@/annotations/bc", "annotations.os: there is no case 'os'"},
    {"/annotations/bc/points/-", "@/annotations/bc/points/0", "is given twice"},
    {"/rounds/os", "@/rounds/bc", "rounds.os: there is no case 'os'"},
    {"/rounds/bc", "[]", "rounds.bc: there is none"},
    {"/rounds/bc/0/by", R"("")", "rounds.bc[0].by: is empty"},
    {"/rounds/bc/0/time", R"("now")", "rounds.bc[0].time: not a time"},
    {"/rounds/bc/0/sigma", "1", "rounds.bc[0].sigma: is not known"},
    {"/cases/0/landmarks", "3", "cases[0].landmarks: not "},
    {"/decisions/0/case", R"("os")", "decisions[0].case: there is no case"},
    {"/decisions/0/by", R"("")", "decisions[0].by: is empty"},
    {"/decisions/0/time", R"("today")", "decisions[0].time: not a time"},
    {"/decisions/0/verdict", R"("maybe")", "decisions[0].verdict: "},
    {"/runs/0/digest", R"("a")", "runs[0].digest: not a SHA-256"},
    {"/runs/0/case", R"("os")", "runs[0].case: there is no case 'os'"},
    {"/runs/0/status", R"("\u001b[2Jgood")",
     "runs[0].status: ' [2Jgood' is not a status of a run: use one of running, converged, "},
    {"/view/iteration", "-2", "view.iteration: "},
};

TEST(SessionFile, SaysWhatIsWrongAndWhere) {
  const TemporaryFolder folder;
  const json good = goodSession();
  const auto message = [&folder](const json& session) {
    const auto file = folder.write("s.json", session.dump());
    return folder.message([&] { (void)readSessionFile(file); });
  };
  EXPECT_EQ(message(good), "(nothing)");
  for (const Spoilt& spoilt : kSpoilt) {
    json session = good;
    const std::string value = spoilt.value;
    const json merged =
        value[0] == '@' ? good[json::json_pointer(value.substr(1))] : json::parse(value);
    session[json::json_pointer(spoilt.place)].merge_patch(merged);
    EXPECT_THAT(message(session), HasSubstr(spoilt.message)) << spoilt.place << " " << value;
  }
}

TEST(SessionFile, OlderFiles_AreRead) {
  const TemporaryFolder folder;
  json old = goodSession();
  old.erase("rounds");
  old["cases"][0].erase("landmarks");
  json& part = old["cases"][0]["parts"][0];
  const json pose = {{"rotation_wxyz", {0.0, 1.0, 0.0, 0.0}}, {"translation_m", {0.5, 0.0, 0.0}}};
  for (const char* later : {"role", "frame_from_mesh", "name"}) part.erase(later);
  part["station_from_mesh"] = pose;
  part["match"] = true;
  json occluder = part;
  occluder["match"] = false;
  old["cases"][0]["parts"].push_back(occluder);
  const Session session = readSessionFile(folder.write("s.json", old.dump())).session;
  EXPECT_TRUE(session.rounds.empty());
  EXPECT_FALSE(session.cases[0]->landmarks);
  const auto& parts = session.cases[0]->parts;
  EXPECT_EQ(parts[0].source.state, PartState());
  EXPECT_EQ(parts[1].source.state, (PartState{PartRole::kOccludes, true}));
  EXPECT_EQ(parts[0].source.frame_from_mesh.translation_m.x(), 0.5);
  const json written = json::parse(sessionText(session, folder / "s.json"));
  const json& written_part = written["cases"][0]["parts"][1];
  EXPECT_EQ(written_part["role"], "occludes");
  EXPECT_EQ(written_part["frame_from_mesh"], pose);
  EXPECT_FALSE(written_part.contains("match") || written_part.contains("station_from_mesh"));
  EXPECT_FALSE(written.contains("rounds")) << "a session without any is written as before";
}

TEST(SessionFile, PartsThatHaveNoPlaceInTheScene_AreRefused) {
  const TemporaryFolder folder;
  const auto message = [&folder](const json& changes) {
    json value = goodSession();
    json gripper = value["cases"][0]["parts"][0];
    gripper.erase("frame");
    gripper["role"] = "occludes";
    gripper.update(changes);
    value["cases"][0]["parts"].push_back(gripper);
    value["cases"][0].erase("frames");
    value["cases"][0].erase("camera_reference");
    const auto file = folder.write("s.json", value.dump());
    return folder.message([&] { (void)readSessionFile(file); });
  };
  EXPECT_EQ(message({{"frame", "CAMERA"}}), "(nothing)");
  EXPECT_THAT(message({{"frame", "GRIPPER"}}),
              HasSubstr("cases[0].parts[1].frame: GRIPPER is joined to neither CAMERA nor STATION: "
                        "add the transform that joins it"));
  EXPECT_THAT(message({{"frame", "CAMERA"}, {"role", "matched"}}),
              HasSubstr("cases[0].parts[1].role: a part that is fixed to the camera cannot be "
                        "matched"));
  EXPECT_THAT(message({{"role", "held"}}), HasSubstr("cases[0].parts[1].role: 'held' is none of"));
  EXPECT_THAT(message({{"match", false}}), HasSubstr("match: cannot be combined with 'role'"));
}

TEST(SessionFile, RoundsOfNoCaseOrOfNone_AreRemoved) {
  Random random = randomFor("rounds");
  const Session session =
      withRounds(withCase({}, randomCase(random, "a")), "a", randomRounds(random));
  EXPECT_TRUE(withoutCase(session, "a").rounds.empty());
  EXPECT_TRUE(withRounds(session, "a", {}).rounds.empty());
}

TEST(SessionFile, RefusesToWriteWhatIsNotText) {
  const TemporaryFolder folder;
  folder.write("s.json", "old");
  Random random = randomFor("utf8");
  SessionCase session_case = randomCase(random, "a");
  session_case.image.source.file = "/data/\xff.png";
  EXPECT_THAT(
      folder.message([&] { writeSessionFile(folder / "s.json", withCase({}, session_case)); }),
      AllOf(HasSubstr("s.json: cases[0].image"),
            HasSubstr("\\xFF.png' is not UTF-8 text: rename or retype it")));
  EXPECT_EQ(folder.read("s.json"), "old");
}

/// A number of the session's JSON with the ends of its range, and values beyond them.
struct NumberRange {
  const char* place;
  json least;
  json most;
  json below;
  json above;
};

TEST(SessionFile, RangeOfEachNumber_IncludesItsEnds) {
  const TemporaryFolder folder;
  json good = goodSession();
  json& item = good["cases"][0];
  item["parts"][0]["albedo"] = 0.5;
  item["feature_size_m"] = 0.1;
  item["mesh_scale_sigma"] = 0.1;
  item["image"]["rule"] = "levels";
  item["image"]["bit_depth"] = 8;
  item["image"]["black"] = 10;
  item["image"]["white"] = 20;
  item["ignore_strokes"] = json::parse(R"([
      {"kind": "brush", "erase": false, "radius_px": 3.0, "points": [[1.0, 2.0]]},
      {"kind": "saturation", "erase": false, "level": 200}])");
  const NumberRange ranges[] = {
      {"/image/width", 1, 16384, 0, 16385},
      {"/image/height", 1, 16384, 0, 16385},
      {"/image/black", 0, 19, -1, 20},
      {"/image/white", 11, 255, 10, 256},
      {"/parts/0/normal_threshold_rad", 1e-3, 3.15, 0.9e-3, 3.16},
      {"/parts/0/depth_threshold_m", 1e-6, 1000.0, 0.9e-6, 1001.0},
      {"/parts/0/albedo", 0.0, 1.0, -0.1, 1.1},
      {"/feature_size_m", 1e-6, 100.0, 0.9e-6, 100.1},
      {"/mesh_scale_sigma", 0.0, 0.1, -0.01, 0.11},
      {"/ignore_strokes/0/radius_px", 0.0, 16384.0, -0.1, 16385.0},
      {"/ignore_strokes/0/points/0/0", -1e6, 1e6, -1.1e6, 1.1e6},
      {"/ignore_strokes/0/points/0/1", -1e6, 1e6, -1.1e6, 1.1e6},
      {"/ignore_strokes/1/level", 0, 255, -1, 256},
  };
  const auto message = [&](const char* place, const json& value) {
    json session = good;
    session[json::json_pointer(std::string("/cases/0") + place)] = value;
    const auto file = folder.write("s.json", session.dump());
    return folder.message([&] { (void)readSessionFile(file); });
  };
  for (const auto& [place, least, most, below, above] : ranges) {
    for (const json& value : {least, most})
      EXPECT_EQ(message(place, value), "(nothing)") << place << " " << value;
    for (const json& value : {below, above})
      EXPECT_THAT(message(place, value), HasSubstr("s.json: cases[0].")) << place << " " << value;
  }
}

/// The largest level of each depth, and a table of as many values as it has levels.
TEST(SessionFile, LevelsAndTables_FitEachBitDepth) {
  const TemporaryFolder folder;
  const auto message = [&folder](const json& rule) {
    json session = goodSession();
    session["cases"][0]["image"].update(rule);
    const auto file = folder.write("s.json", session.dump());
    return folder.message([&] { (void)readSessionFile(file); });
  };
  for (const int depth : {1, 8, 12, 16}) {
    const int largest = (1 << depth) - 1;
    const json rule = {{"rule", "levels"}, {"bit_depth", depth}, {"black", 0}, {"white", largest}};
    EXPECT_EQ(message(rule), "(nothing)") << depth;
    json beyond = rule;
    beyond["white"] = largest + 1;
    EXPECT_THAT(message(beyond), HasSubstr("image.white: "));
    const json table = {{"rule", "table"},
                        {"bit_depth", depth},
                        {"table", std::vector<int>(static_cast<std::size_t>(largest) + 1, 255)}};
    EXPECT_EQ(message(table), "(nothing)") << depth;
    json shorter = table;
    shorter["table"].erase(0);
    EXPECT_THAT(message(shorter), HasSubstr("image.table: has "));
  }
  for (const int depth : {0, 17})
    for (const char* rule : {"linear", "levels", "table"})
      EXPECT_THAT(message({{"rule", rule},
                           {"bit_depth", depth},
                           {"black", 0},
                           {"white", 1},
                           {"table", json::array()}}),
                  HasSubstr("image."))
          << rule << " " << depth;
  EXPECT_THAT(message({{"rule", "table"}, {"bit_depth", 1}, {"table", {0, 256}}}),
              HasSubstr("image.table[1]: "));
  EXPECT_THAT(
      message({{"rule", "levels"}, {"bit_depth", 8}, {"black", 0}, {"white", 1}, {"table", {0}}}),
      HasSubstr("image.table: given although the rule is levels"));
}

}  // namespace
}  // namespace boresight::test
