// SPDX-License-Identifier: Apache-2.0
// render, solve, info, options, bench and --version.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>

#include <nlohmann/json.hpp>

#include "sessions/annotation/annotations_file.h"
#include "sessions/annotation/solution_file.h"
#include "sessions/session/case_annotations.h"
#include "sessions/session/session_file.h"
#include "sessions/session/session_maker.h"
#include "sessions/trace/scene_render.h"
#include "tests/app/json_lines.h"
#include "tests/app/run_whs.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

const std::filesystem::path kExample = exampleFolder() / "os";

TEST(Whs, EveryCommandKnowsTheVersion) {
  for (const Arguments& arguments : {Arguments{"--version"}, Arguments{"pack", "--version"}})
    EXPECT_THAT(runWhs(arguments, 0).out, HasSubstr("whs "));
}

/// The state folder of whs while this object exists.
class StateFolder {
 public:
  explicit StateFolder(const std::string& folder) { ::setenv("XDG_STATE_HOME", folder.c_str(), 1); }
  ~StateFolder() { ::setenv("XDG_STATE_HOME", "/dev/null", 1); }
};

TEST(WhsLog, NamesRunsInputsFilesAndErrors) {
  const TemporaryFolder folder;
  const std::string file = newSession(folder);
  const StateFolder state(folder / "state");
  const std::string digest = digestOf(runWhs({"run", file}, 0));
  runWhs({"run", folder / "none.boresight.json"}, 3);
  const std::string log = folder.read("state/boresight/boresight.log");
  EXPECT_THAT(log,
              AllOf(HasSubstr(" begins: "), HasSubstr("s.boresight.lock: locked"),
                    HasSubstr("case os-000038: inputs SHA-256 "), HasSubstr("model.ply, SHA-256 "),
                    HasSubstr("info run begins: version "), HasSubstr("info run ends: converged, "),
                    HasSubstr(digest), HasSubstr("s.boresight.json: written, ")));
  EXPECT_THAT(log, AllOf(HasSubstr("error " + (folder / "none.boresight.json").string()),
                         HasSubstr("whs ends with exit status 3")));
}

TEST(WhsLog, OffOrWithoutAFolderToWrite_ChangesNothing) {
  const TemporaryFolder folder;
  {
    const StateFolder state(folder / "state");
    runWhs({"options", "--log-level", "off"}, 0);
    runWhs({"--log-level", "off", "options"}, 0);
    runWhs({"--help"}, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "state"));
  }
  const StateFolder state("/proc/nowhere");
  EXPECT_EQ(runWhs({"options"}, 0).err, "");
}

TEST(WhsOptions, ListsEveryOptionWithRangeAndMeaning) {
  const std::string out = runWhs({"options"}, 0).out;
  const LocalizerOptions options;
  LocalizerOptions::visitFields(options, [&out](const OptionInfo& info, const auto&) {
    EXPECT_THAT(out, AllOf(HasSubstr(info.name), HasSubstr(info.help)));
  });
  for (const char* name : {"ssd.masked", "ncc.kind", "orb.features", "external.timeout_s"})
    EXPECT_THAT(out, HasSubstr(name));
  EXPECT_NE(runWhs({"options", "--profile", "paper"}).out, out);
}

TEST(WhsOptions, TableForUplinkIsReadAsAConfiguration) {
  const TemporaryFolder folder;
  const std::string table = folder / "parameters.bin";
  const std::string dictionary = folder / "dictionary.json";
  const Arguments options_of_table = {"options", "--profile", "paper", "--set",
                                      "loop.max_iterations=7"};
  runWhs(with(options_of_table, {"--table", table, "--dictionary", dictionary}), 0);
  const auto ownOptions = [](const Arguments& arguments) {
    const std::string out = runWhs(arguments, 0).out;
    return out.substr(0, out.find("Options of the other methods"));
  };
  EXPECT_EQ(ownOptions({"options", "--config", table}), ownOptions(options_of_table));
  const auto json = jsonOf(dictionary);
  std::size_t count = 0;
  const LocalizerOptions options;
  LocalizerOptions::visitFields(options, [&](const OptionInfo& info, const auto&) {
    EXPECT_EQ(json["parameters"][count++]["name"], info.name);
  });
  EXPECT_EQ(json["parameters"].size(), count);
  std::string bytes = folder.read("parameters.bin");
  bytes[40] ^= 1;
  EXPECT_THAT(runWhs({"options", "--config", folder.write("bad.bin", bytes)}, 3).err,
              HasSubstr("damaged: the checksum does not match"));
}

TEST(WhsRender, DrawsWhatTheCoreRenders) {
  const TemporaryFolder folder;
  runWhs({"render", "--camera", kExample / "camera.json", "--mesh", kExample / "model.ply",
          "--mesh-unit", "m", "--pose", kExample / "truth.json", "--out", folder / "e.png"},
         0);
  const ExampleCase& example = osExample();
  sessions::RenderTrace render;
  ASSERT_EQ(sessions::renderScene(example.camera, example.scene.view(),
                                  example.truth.camera_from_station, render),
            Status::kOk);
  const sessions::GrayImage drawn = sessions::readImage(folder / "e.png");
  EXPECT_EQ(std::count(drawn.pixels.begin(), drawn.pixels.end(), 255), std::ssize(render.pixels));
  for (const EdgePixel& pixel : render.pixels) ASSERT_EQ(drawn.view().at(pixel.x, pixel.y), 255);
}

/// The example's mesh as OBJ, with a line that is not read.
std::string objWithACurve() {
  const sessions::SceneMesh& scene = osExample().scene;
  std::string text = "curv 0 1 1 2\n";
  for (const Eigen::Vector3f& vertex : scene.vertices_in_station_m)
    text += "v " + std::to_string(vertex.x()) + " " + std::to_string(vertex.y()) + " " +
            std::to_string(vertex.z()) + "\n";
  for (const Face& face : scene.faces)
    text += "f " + std::to_string(face.vertex[0] + 1) + " " + std::to_string(face.vertex[1] + 1) +
            " " + std::to_string(face.vertex[2] + 1) + "\n";
  return text;
}

TEST(WhsNotes, OnHowFilesWereRead_ArePrintedByRenderLocalizeAndNew) {
  const TemporaryFolder folder;
  const std::string mesh = folder.write("model.obj", objWithACurve()).string();
  const auto said =
      HasSubstr("whs: model.obj: 1 line of curves, surfaces or other files: not read");
  EXPECT_THAT(runWhs({"render", "--camera", kExample / "camera.json", "--mesh", mesh, "--mesh-unit",
                      "m", "--pose", kExample / "truth.json", "--out", folder / "e.png"},
                     0)
                  .err,
              said);
  const ProgramRun run =
      runWhs(with(localizeArguments({{"--mesh", mesh}, {"--out", folder / "result.json"}}),
                  {"loop.max_iterations=1", "loop.max_attempts=1"}));
  EXPECT_THAT(run.err, said);
  EXPECT_THAT(folder.read("result.json"), HasSubstr("1 line of curves"));
  Arguments new_session = localizeArguments({{"--mesh", mesh}, {"--out", folder / "s.json"}});
  new_session[0] = "new";
  EXPECT_THAT(runWhs(new_session, 0).err, said);
}

/// Points of the example's mesh where the true pose projects them.
sessions::Annotations trueAnnotations(std::size_t count) {
  const ExampleCase& example = osExample();
  sessions::Annotations annotations;
  for (std::size_t i = 0; annotations.points.size() < count; i += 97) {
    sessions::PointPair& point = annotations.points.emplace_back();
    point.id = "p" + std::to_string(i);
    point.point_in_station_m = example.scene.vertices_in_station_m.at(i).cast<double>();
    const Eigen::Vector3d in_camera_m =
        example.truth.camera_from_station * *point.point_in_station_m;
    EXPECT_TRUE(project(example.camera, in_camera_m, point.pixel.emplace()));
  }
  return annotations;
}

class WhsSolve : public testing::Test {
 protected:
  ProgramRun solve(const sessions::Annotations& annotations, int exit_code,
                   const Arguments& more = {}) const {
    sessions::writeAnnotations(folder_ / "points.json", annotations);
    return runWhs(
        with({"solve", "--points", folder_ / "points.json", "--camera", kExample / "camera.json"},
             more),
        exit_code);
  }

  /// A session of the example's cases with annotations of one of them.
  std::string annotatedSession(const sessions::Annotations& annotations) const {
    const sessions::Session session = sessions::makeSession(exampleDataset());
    sessions::writeSessionFile(folder_ / "s.json", withAnnotations(session, kOsCase, annotations));
    return folder_ / "s.json";
  }

  const TemporaryFolder folder_;
};

TEST_F(WhsSolve, FindsThePoseDespiteAMistakenPoint) {
  sessions::Annotations annotations = trueAnnotations(10);
  *annotations.points[3].pixel += Eigen::Vector2d(120.0, -80.0);
  EXPECT_THAT(solve(annotations, 0, {"--robust", "--out", folder_ / "pose.json"}).out,
              AllOf(HasSubstr("10 annotations"), HasSubstr("120.000"), HasSubstr(" !")));
  const Vector6d error =
      perturbationBetween(osExample().truth.camera_from_station,
                          sessions::readPose(folder_ / "pose.json").camera_from_station);
  EXPECT_LT(error.norm(), 1e-6);
}

TEST_F(WhsSolve, SaysWhereItsSigmasAreAndKeepsTheCovarianceWithThePose) {
  sessions::Annotations annotations = trueAnnotations(10);
  *annotations.points[3].pixel += Eigen::Vector2d(1.0, -1.0);
  EXPECT_THAT(solve(annotations, 0, {"--out", folder_ / "pose.json"}).out,
              AllOf(HasSubstr("1 sigma at the camera"),
                    HasSubstr("without: change of the annotations' centre")));
  const auto covariance = sessions::readPose(folder_ / "pose.json").covariance;
  ASSERT_TRUE(covariance);
  EXPECT_GT(covariance->diagonal().minCoeff(), 0.0);
}

TEST_F(WhsSolve, LeavesOutDisabledPointsAndAsksForFour) {
  sessions::Annotations annotations = trueAnnotations(5);
  annotations.points[0].enabled = false;
  annotations.points[1].enabled = false;
  EXPECT_THAT(solve(annotations, 4).err, HasSubstr("one image needs at least 4"));
  // Three do where there is a first guess.
  solve(annotations, 0, {"--seed", kExample / "seed.json"});
}

TEST_F(WhsSolve, SwappedPairs_AreMentioned) {
  sessions::Annotations annotations = trueAnnotations(6);
  EXPECT_THAT(solve(annotations, 0).out, Not(HasSubstr("swapped pairs")));
  std::swap(annotations.points[1].pixel, annotations.points[4].pixel);
  EXPECT_THAT(solve(annotations, 0).out, HasSubstr("check for swapped pairs"));
}

TEST_F(WhsSolve, SaysWhenNoPoseAgrees) {
  sessions::Annotations annotations = trueAnnotations(6);
  for (sessions::PointPair& point : annotations.points)
    point.point_in_station_m = annotations.points[0].point_in_station_m;
  const ProgramRun run = solve(annotations, 4);
  EXPECT_EQ(run.errorLines(), 1) << run.err;
}

TEST_F(WhsSolve, SolvesTwoCamerasOfARigAsOne) {
  sessions::writeAnnotations(folder_ / "points.json", trueAnnotations(6));
  const std::string view = R"("camera": ")" + (kExample / "camera.json").string() +
                           R"(", "points": "points.json", "camera_from_rig":
      [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]})";
  folder_.write("rig.json",
                R"({"format": "boresight-rig", "version": 1, "views": [{"name": "a", )" + view +
                    R"(, {"name": "b", )" + view + "]}");
  EXPECT_THAT(
      runWhs({"solve", "--rig", folder_ / "rig.json", "--out", folder_ / "pose.json"}, 0).out,
      HasSubstr("12 annotations"));
}

TEST_F(WhsSolve, SolvesACaseOfASessionAsTheDesktopDoes) {
  sessions::Annotations annotations = trueAnnotations(8);
  *annotations.points[2].pixel += Eigen::Vector2d(0.4, -0.3);
  const std::string file = annotatedSession(annotations);
  const sessions::Session session = sessions::readSessionFile(file).session;
  const std::string written = folder_ / "s.solution.json";
  const ProgramRun run = runWhs({"solve", "--session", file, "--case", kOsCase, "--json", written,
                                 "--out", folder_ / "pose.json"},
                                0);
  const auto solved = sessions::solveCaseAnnotations(session, kOsCase);
  const sessions::AnnotationsSolution& solution = *solved.result.solution;
  EXPECT_EQ(run.out, sessions::solutionText(solved.annotations.views, solution, solved.left_out,
                                            solved.warnings));
  const auto json = jsonOf(written);
  EXPECT_EQ(json["solved"], true);
  EXPECT_EQ(json["rms_px"], solution.rms_px);
  EXPECT_EQ(json["annotations"].size(), 8u);
  const auto& third = json["annotations"][2];
  EXPECT_EQ(third["id"], annotations.points[2].id);
  EXPECT_EQ(third["residual_px"][0], solution.annotations[2].residual_px.x());
  EXPECT_EQ(third["residual_mm"][1], solution.annotations[2].residual_mm.y());
  EXPECT_EQ(json["annotations"][7]["without"]["translation_mm"], solved.left_out[7].translation_mm);
  const Matrix6d covariance = cameraCovariance(solution, solved.annotations.views[0]);
  const auto& view = json["views"][0];
  EXPECT_EQ(view["name"], kOsCase);
  EXPECT_EQ(view["covariance"][1][4], covariance(1, 4));
  EXPECT_EQ(view["sigma_mm"][2], 1000.0 * std::sqrt(covariance(5, 5)));
  EXPECT_EQ(view["camera_from_station"][1][3], solved.camera_from_station()->translation_m.y());
  EXPECT_EQ(json["warnings"].size(), solved.warnings.size());
  EXPECT_LT(perturbationBetween(*solved.camera_from_station(),
                                sessions::readPose(folder_ / "pose.json").camera_from_station)
                .norm(),
            1e-12);
}

TEST_F(WhsSolve, SaysWhyACaseHasNoPose) {
  const std::string file = annotatedSession(trueAnnotations(2));
  const std::string written = folder_ / "out.json";
  const std::string error =
      refusal({"solve", "--session", file, "--case", kOsCase, "--json", written}, 4);
  const auto json = jsonOf(written);
  EXPECT_EQ(json["solved"], false);
  EXPECT_THAT(error, HasSubstr(json["reason"].get<std::string>()));
  EXPECT_EQ(json["warnings"][0]["kind"], "too_few");
  runWhs({"solve", "--session", file, "--case", "unknown"}, 3);
}

TEST_F(WhsSolve, FewAnnotations_PassNoCheckOfPrecisionAndAreNotValidated) {
  sessions::Annotations annotations = trueAnnotations(5);
  for (sessions::PointPair& point : annotations.points) point.sigma_px = 0.02;
  const Arguments about = {
      annotatedSession(annotations), "--case", kOsCase, "--source", "annotation",
      "--convergence-test",          "0"};
  EXPECT_THAT(runWhs(with({"check"}, about), 4).out,
              AllOf(HasSubstr("FAIL  Covariance across the view axis"),
                    HasSubstr("4 degrees of freedom, which cannot confirm their sigmas")));
  const Arguments decision = {"--validate", "--by", "Ada", "--comment", "right"};
  EXPECT_THAT(refusal(with(with({"decide"}, about), decision), 4),
              HasSubstr("failed checks are not waived: Covariance"));
}

TEST_F(WhsSolve, WrongUse_IsRefused) {
  const std::string file = annotatedSession({});
  for (const Arguments& options :
       {Arguments{}, Arguments{"--points", folder_ / "points.json"}, Arguments{"--session", file},
        Arguments{"--session", file, "--case", kOsCase, "--seed", "x.json"}, Arguments{"--alone"}})
    runWhs(with({"solve"}, options), 2);
}

TEST(WhsInfo, DescribesEveryKindOfFile) {
  EXPECT_THAT(runWhs({"info", kExample / "image.png", kExample / "camera.json",
                      kExample / "model.ply", kExample / "seed.json", exampleDataset()},
                     0)
                  .out,
              AllOf(HasSubstr("PNG, 1024 x 1024 px"), HasSubstr("brown_conrady"),
                    HasSubstr("field of view"), HasSubstr("faces"), HasSubstr("is not stated"),
                    HasSubstr("uncertainty"), HasSubstr("2 cases, 2 stations")));
}

TEST(WhsInfo, DescribesRigsAndLandmarks) {
  const TemporaryFolder folder;
  folder.write("points.json",
               R"({"format": "boresight-points", "version": 1, "points": [{"id": "p"}]})");
  const auto rig = folder.write(
      "rig.json", R"({"format": "boresight-rig", "version": 1, "views": [{"name": "left",
      "camera": ")" + (kExample / "camera.json").string() +
                      R"(", "points": "points.json",
      "camera_from_rig": [[1,0,0,0.1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}]})");
  const auto landmarks =
      folder.write("landmarks.json", R"({"format": "boresight-landmarks", "version": 1,
      "landmarks": [{"name": "screw", "point_in_station_m": [0, 0, 0], "comment": ""}]})");
  EXPECT_THAT(runWhs({"info", rig, landmarks}, 0).out,
              AllOf(HasSubstr("view left: camera of 1024 x 1024 px, 1 point, 0 lines"),
                    HasSubstr("\ncamera_from_rig\n"), HasSubstr("  1 landmark\n")));
}

/// A tree of nodes so deep that an importer's recursion ended the program.
TEST(WhsInfo, PrintsABoundedPartOfManyFrames) {
  const TemporaryFolder folder;
  const auto framesOf = [&](int count) {
    std::string text = R"({"format": "boresight-frames", "version": 1, "transforms": [)";
    for (int i = 0; i < count; ++i)
      text += std::string(i == 0 ? "" : ",") + R"({"target": {"name": "F)" + std::to_string(i) +
              R"("}, "source": {"name": "F)" + std::to_string(i + 1) +
              R"("}, "target_from_source": [[1,0,0,0.1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})";
    return folder.write("frames.json", text + "]}").string();
  };
  const ProgramRun printed = runWhs({"info", framesOf(150)}, 0);
  EXPECT_THAT(printed.out, AllOf(HasSubstr("... 100 more transforms"),
                                 HasSubstr("further frames of 151 are left out")));
  EXPECT_LT(printed.out.size(), 200'000u);
}

TEST(WhsInfo, RefusesADeepChainOfNodesInOneSentence) {
  const TemporaryFolder folder;
  std::string nodes;
  for (int i = 1; i < 100'000; ++i) nodes += R"({"children":[)" + std::to_string(i) + "]},";
  const auto file = folder.write(
      "deep.gltf",
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"meshes":[],"accessors":[],)"
      R"("nodes":[)" +
          nodes + "{}]}");
  EXPECT_THAT(refusal({"info", file}),
              HasSubstr("deep.gltf: nodes[256]: is nested deeper than 256 nodes"));
}

TEST(WhsInfo, JsonWithoutAFormat_SaysWhatToWrite) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal({"info", folder.write("cut.json", R"({"model": "pinhole"})")}),
              HasSubstr("cut.json: format: missing: state what the file is, e.g. "
                        "\"format\": \"boresight-camera\", \"version\": 1"));
}

TEST(WhsInfo, TellsOfWhatIsInAnImageAndNotUsed) {
  const TemporaryFolder folder;
  // A TIFF of one pixel that states orientation 6 and has a second directory.
  std::string tiff("II*\0\x0a\0\0\0\x50\0\x0a\0", 12);
  const std::pair<char, int> tags[] = {{'\0', 1},   {'\1', 1},   {'\2', 8},   {'\3', 1},
                                       {'\6', 1},   {'\x11', 8}, {'\x12', 6}, {'\x15', 1},
                                       {'\x16', 1}, {'\x17', 1}};
  std::string entries;
  for (const auto& [tag, value] : tags)
    entries +=
        {tag, '\1', '\4', '\0', '\1', '\0', '\0', '\0', static_cast<char>(value), '\0', '\0', '\0'};
  // The second directory is a copy of the first, behind it.
  tiff += entries + std::string("\x88\0\0\0\x0a\0", 6) + entries + std::string(4, '\0');
  EXPECT_THAT(runWhs({"info", folder.write("turned.tif", tiff)}, 0).out,
              AllOf(HasSubstr("EXIF orientation 6 is not applied"),
                    HasSubstr("the file holds further images (pages)")));
}

/// A pipe without a writer: reading would block for ever.
TEST(Whs, RefusesPipesOfEveryKindOfInput) {
  const TemporaryFolder folder;
  const auto pipe = [&folder](const std::string& name) {
    const std::string file = folder / name;
    EXPECT_EQ(::mkfifo(file.c_str(), 0600), 0);
    return file;
  };
  std::vector<Arguments> all;
  for (const char* name : {"a.png", "a.img", "a.ply", "a.json", "a.cahvor", "a.trace", "a.whsr"})
    all.push_back({"info", pipe(name)});
  const std::string session = pipe("s.boresight.json"), record = folder / "a.whsr";
  all.insert(all.end(),
             {{"info", session},
              {"run", session},
              {"queue", session},
              {"evaluate", "--dataset", folder / "a.json", "--out", folder / "r.sqlite"},
              {"solve", "--points", folder / "a.json", "--camera", kExample / "camera.json"},
              {"compare", record, record},
              {"verify", folder / "a.json"},
              {"tables", pipe("p.sqlite")},
              {"merge", folder / "m.sqlite", folder / "p.sqlite"}});
  const char* const label =
      "PDS_VERSION_ID = PDS3\r\n^IMAGE = \"a.img\"\r\nOBJECT = IMAGE\r\n LINES = 8\r\n"
      " LINE_SAMPLES = 8\r\n SAMPLE_BITS = 8\r\n SAMPLE_TYPE = UNSIGNED_INTEGER\r\n"
      "END_OBJECT = IMAGE\r\nEND\r\n";
  all.push_back({"info", folder.write("d.lbl", label)});
  for (const Arguments& arguments : all)
    EXPECT_THAT(refusal(arguments), HasSubstr("a pipe")) << arguments[0] << " " << arguments[1];
}

TEST(WhsInfo, GoesOnAfterABadFile) {
  const ProgramRun run = runWhs({"info", "/no/such/file.png", kExample / "camera.json"}, 3);
  EXPECT_THAT(run.err, HasSubstr("/no/such/file.png"));
  EXPECT_THAT(run.out, HasSubstr("brown_conrady"));
}

// What `whs bench` prints and writes; how long anything takes decides nothing.

TEST(WhsBench, WritesWhatItMeasured) {
  const TemporaryFolder folder;
  const ProgramRun run = runWhs({"bench", "--quick", "--json", folder / "bench.json"}, 0);
  EXPECT_EQ(run.err, "");
  const auto json = jsonOf(folder / "bench.json");
  EXPECT_EQ(json["format"], "boresight-bench");
  // Two stations, by portable and by the best kernels.
  ASSERT_EQ(json["localizations"].size(), 4u);
  for (const auto& item : json["localizations"]) {
    EXPECT_THAT(run.out, HasSubstr(item["name"].get<std::string>()));
    EXPECT_GT(item["per_second"], 0.0);
    EXPECT_GT(item["arena_bytes"], 1000000);
    EXPECT_EQ(item["digest"].get<std::string>().size(), 64u);
    for (const char* stage : {"initialization", "rendering", "matching", "pose", "refinement"})
      EXPECT_GT(item["mean_seconds"][stage], 0.0) << item["name"] << " " << stage;
  }
  for (const std::size_t i : {0u, 1u}) {
    EXPECT_EQ(json["localizations"][i]["kernels"], "portable");
    EXPECT_EQ(json["localizations"][i]["converged"], 1) << i;
    EXPECT_EQ(json["localizations"][i]["digest"], json["localizations"][i + 2]["digest"]);
  }
}

TEST(WhsBench, GivesTheDigestOfTheRunItTimes) {
  const TemporaryFolder folder;
  runWhs({"evaluate", "--dataset", exampleDataset(), "--station", "os", "--out",
          folder / "r.sqlite", "--jsonl", folder / "r.jsonl"},
         0);
  const auto evaluated = jsonOf(folder / "r.jsonl");
  runWhs({"bench", "--quick", "--case", evaluated["id"], "--json", folder / "bench.json"}, 0);
  const auto timed = jsonOf(folder / "bench.json");
  EXPECT_EQ(timed["localizations"][0]["digest"], evaluated["digest"]);
  EXPECT_THAT(runWhs({"bench", "--quick", "--case", "nowhere"}, 3).err, HasSubstr("nowhere"));
}

}  // namespace
}  // namespace boresight::test
