// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_run.h"

#include <gtest/gtest.h>

#include "sessions/run/runner.h"
#include "sessions/session/input_check.h"
#include "sessions/session/session_file.h"
#include "sessions/session/session_pack.h"
#include "tests/sessions/io/meshes/mesh_samples.h"
#include "tests/sessions/session/example_session.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using namespace sessions;

/// Station "os", which runs without a search.
Session sessionOfOs(const std::filesystem::path& stations = exampleFolder()) {
  Session os = makeSession(stations / "dataset.json", {"os-000038"});
  os.options = {{"search.enabled", false}};
  return os;
}

TEST(CaseRun, RefusesWhatCannotBeRun) {
  const TemporaryFolder folder;
  const Session session = sessionOfOs();
  const SessionCase& os = *session.cases[0];
  const auto message = [&](void (*spoil)(SessionCase&)) {
    SessionCase session_case = os;
    spoil(session_case);
    return folder.message([&] { (void)runCase(withCase(session, session_case), os.id); });
  };
  EXPECT_THAT(folder.message([&] { (void)runCase(session, "x"); }),
              HasSubstr("there is no case 'x'"));
  EXPECT_THAT(message([](auto& c) { c.camera.width = 100; }), HasSubstr("image size: is 1024"));
  EXPECT_THAT(message([](auto& c) { c.camera_from_station_seed.translation_m.z() *= -1; }),
              HasSubstr("seed: the station lies behind the camera"));
  EXPECT_THAT(message([](auto& c) { c.parts[0].source.mesh_unit = "km"; }),
              HasSubstr("mesh_unit: the mesh measures"));
  EXPECT_THAT(message([](auto& c) { c.image.pixels_sha256 = std::string(64, '0'); }),
              HasSubstr("its 8-bit pixels differ from those"));
  Session options = session;
  options.options.emplace_back("pnp.nonsense", 1.0);
  EXPECT_THAT(folder.message([&] { (void)runCase(options, os.id); }),
              HasSubstr("options.pnp.nonsense: unknown option"));
}

/// An unknown file in place of the mesh is not parsed.
TEST(CaseRun, AMeshWithAnotherHashIsNotParsed) {
  const TemporaryFolder folder;
  SessionCase session_case = *sessionOfOs().cases[0];
  session_case.parts[0].source.mesh = folder.write("m.ply", "this is no mesh");
  EXPECT_EQ(folder.message([&] { (void)loadCase(session_case); }),
            "m.ply: its bytes differ from those of the session: relink the file, or accept it as "
            "it is now");
  EXPECT_EQ(checkInputs(withCase({}, session_case)).front().kind, FindingKind::kChanged);
}

TEST(CaseRun, StrokesAndMaskFileTogetherAreTheMask) {
  const TemporaryFolder folder;
  SessionCase session_case = *sessionOfOs().cases[0];
  std::vector<std::uint8_t> mask(1024 * 1024, 0);
  mask[5] = 1;
  writePng(folder / "m.png", mask, 1024, 1024, 1);
  session_case.ignore = InputFile{folder / "m.png", inputSha256(folder / "m.png")};
  MaskStroke dot;
  dot.radius_px = 0.0;
  dot.points = {{7.0, 0.0}};
  session_case.ignore_strokes = {dot};
  const auto loaded = loadCase(session_case);
  EXPECT_EQ(loaded->ignore->ignored_count, 2);
  EXPECT_TRUE(loaded->problem().ignore->get(5, 0));
  EXPECT_TRUE(loaded->problem().ignore->get(7, 0));
  session_case.ignore->sha256[0] ^= 1;
  EXPECT_THAT(folder.message([&] { (void)loadCase(session_case); }),
              HasSubstr("m.png: its bytes differ from those"));
}

TEST(CaseRun, RunWithChangedOptions_IsRepeatedFromItsRecord) {
  const TemporaryFolder folder;
  Session session = sessionOfOs();
  const std::string id = session.cases[0]->id;
  const std::filesystem::path file = folder / "s.json";
  const auto loaded = loadCase(*session.cases[0]);
  const LocalizationTrace first = runCase(session, *loaded);
  const RunRecord plain = storeRun(session, id, first, file);
  EXPECT_FALSE(plain.rerun.has_value());

  LocalizerOptions other = first.options;
  other.loop.render_again_px = 5.0;
  const RunPlan plan = continuedPlan(first.plan(), 2, other);
  const LocalizationTrace again = runCase(*loaded, plan);
  const Session changed = withOptions(session, "default", other);
  RunRecord record = storeRun(changed, id, again, file, first.digest);
  ASSERT_TRUE(record.rerun.has_value());
  EXPECT_EQ(record.rerun->from, first.digest);
  EXPECT_NE(record.digest, first.digest);

  // Only the session file is left.
  session = withRun(withRun(changed, plain), record);
  writeSessionFile(file, session);
  const Session reread = readSessionFile(file).session;
  EXPECT_EQ(reread, session);
  ASSERT_EQ(reread.runs.size(), 2u);
  EXPECT_FALSE(stalenessOf(reread.runs[1], reread, file).stale());
  EXPECT_TRUE(stalenessOf(reread.runs[0], reread, file).options_changed);
  const RunPlan read = planOf(reread.runs[1], reread, file);
  EXPECT_EQ(runCase(*loaded, read).digest, record.digest);
  EXPECT_THAT(folder.message([&] { (void)planOf(reread.runs[0], reread, file); }),
              HasSubstr("the session's options have changed since the run"));
  RunRecord former = reread.runs[0];
  former.version = "1.0.0";
  EXPECT_THAT(folder.message([&] { (void)planOf(former, reread, file); }),
              HasSubstr("it is from version 1.0.0, whose profiles may differ"));
  const Session elsewhere = withChanged(reread, id, [](SessionCase& changed) {
    changed.camera_from_station_seed.translation_m.x() += 1e-6;
  });
  EXPECT_THAT(folder.message([&] { (void)planOf(reread.runs[1], elsewhere, file); }),
              HasSubstr("have changed since the run"));
}

TEST(CaseRun, StoredRun_IsNamedByItsDigestAndInputs) {
  const TemporaryFolder folder;
  const Session session = sessionOfOs();
  const std::string id = session.cases[0]->id;
  const LocalizationTrace trace = runCase(session, id);
  LocalizerOptions options = defaultProfile();
  options.templates.feature_size_m = session.cases[0]->feature_size_m.value();
  options.search.enabled = false;
  EXPECT_EQ(trace.digest, localize(osExample().problem(), options, RecordLevel::kSummary).digest);
  EXPECT_TRUE(trace.converged());

  const std::filesystem::path file = folder / "s.boresight.json";
  const RunRecord run = storeRun(session, id, trace, file);
  EXPECT_EQ(run.file, folder / "s.boresight.runs" / (trace.digest + ".trace"));
  EXPECT_EQ(run.status, "converged");
  EXPECT_EQ(loadRun(run).digest, trace.digest);
  // Immutable: the same run again leaves the file as it is.
  const std::string name = "s.boresight.runs/" + trace.digest + ".trace";
  const std::string bytes = folder.read(name);
  LocalizationTrace slower = trace;
  slower.seconds.matching += 1.0;
  (void)storeRun(session, id, slower, file);
  EXPECT_EQ(folder.read(name), bytes);
  const Session ran = withRun(withRun(session, run), run);
  EXPECT_EQ(ran.runs.size(), 1u);

  EXPECT_FALSE(stalenessOf(run, ran, file).stale());
  SessionCase nudged = *ran.cases[0];
  nudged.camera_from_station_seed.translation_m.x() += 1e-6;
  EXPECT_TRUE(stalenessOf(run, withCase(ran, nudged), file).inputs_changed);
  LocalizerOptions other = sessionOptions(ran, file);
  other.pnp.seed += 1;
  const Staleness stale = stalenessOf(run, withOptions(ran, "default", other), file);
  EXPECT_TRUE(stale.options_changed && !stale.inputs_changed);

  RunRecord wrong = run;
  wrong.digest[0] ^= 1;
  EXPECT_THAT(folder.message([&] { (void)loadRun(wrong); }), HasSubstr("digest: is"));
  wrong = run;
  wrong.status = "pnp_failed";
  EXPECT_THAT(folder.message([&] { (void)loadRun(wrong); }),
              HasSubstr("status: is converged, but the session states pnp_failed"));
  std::filesystem::remove(run.file);
  EXPECT_THAT(folder.message([&] { (void)loadRun(run); }), HasSubstr("no such file"));
  EXPECT_EQ(checkInputs(ran).size(), 1u);
}

TEST(CaseRun, AStoppedRunIsNotStored) {
  const TemporaryFolder folder;
  const Session session = sessionOfOs();
  const std::string id = session.cases[0]->id;
  std::stop_source stop;
  stop.request_stop();
  const LocalizationTrace trace = runCase(session, id, RecordLevel::kFull, stop.get_token());
  EXPECT_THROW((void)storeRun(session, id, trace, folder / "s.json"), std::logic_error);
  EXPECT_EQ(folder.fileCount(), 0u);
}

/// The archive's notes.
std::vector<std::string> pack(const Session& session, const std::filesystem::path& session_file,
                              const std::filesystem::path& archive) {
  const SessionPack plan = planPack(session, session_file);
  writePack(plan, archive);
  return plan.notes;
}

TEST(SessionPack, OpensAndRunsElsewhereWithTheSameDigest) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  Session session = makeSession(stations / "dataset.json");
  session.options = {{"search.enabled", false}};
  const std::string id = "os-000038";
  const std::filesystem::path file = folder / "here/s.boresight.json";
  std::filesystem::create_directories(folder / "here");
  const LocalizationTrace trace = runCase(session, id);
  session = withRun(session, storeRun(session, id, trace, file));
  EXPECT_THAT(pack(session, file, folder / "s.zip"), IsEmpty());
  const std::string bytes = folder.read("s.zip");
  EXPECT_THAT(pack(session, file, folder / "s.zip"), IsEmpty());
  EXPECT_EQ(folder.read("s.zip"), bytes);
  std::filesystem::remove_all(stations);
  std::filesystem::remove_all(folder / "here");

  unpack(folder / "s.zip", folder / "there");
  const std::filesystem::path unpacked = folder / "there/s.boresight/s.boresight.json";
  const Session again = readSessionFile(unpacked).session;
  EXPECT_THAT(checkInputs(again), IsEmpty());
  ASSERT_EQ(again.runs.size(), 1u);
  EXPECT_FALSE(stalenessOf(again.runs[0], again, unpacked).stale());
  EXPECT_EQ(loadRun(again.runs[0]).digest, trace.digest);
  EXPECT_EQ(runCase(again, id).digest, trace.digest);
}

TEST(SessionPack, ChangedOrOutsideFiles_AreRefused) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  Session session = makeSession(stations / "dataset.json");
  const std::string digest(64, 'd');
  session.runs.push_back({session.cases[0]->id, digest, folder / "gone.trace", "converged", "0.1.0",
                          "2026-01-31T23:59:59Z", digest, digest});
  EXPECT_THAT(pack(session, folder / "s.json", folder / "s.zip"),
              ElementsAre(HasSubstr("is missing and was left out")));
  const std::size_t files = folder.fileCount();
  EXPECT_THAT(
      folder.message([&] { (void)pack(session, folder / "s.json", folder / "none/t.zip"); }),
      HasSubstr("cannot write none/t.zip: no such folder"));
  folder.write("stations/bc/image.png", "another image");
  EXPECT_THAT(folder.message([&] { (void)pack(session, folder / "s.json", folder / "t.zip"); }),
              HasSubstr("bc/image.png: it differs from the session's file"));
  EXPECT_EQ(folder.fileCount(), files);
}

/// A session of the example's os station in its own folder, with a file that is none of its own.
class PackedMembers : public testing::Test {
 protected:
  /// What packing says of the session after an edit of its case; nothing is written.
  std::string refusal(const std::function<void(SessionCase&)>& edit) const {
    SessionCase session_case = *session_.cases[0];
    edit(session_case);
    return refusal(withCase(session_, session_case));
  }
  std::string refusal(const Session& session) const {
    return folder_.message([&] { (void)planPack(session, file()); });
  }
  std::filesystem::path file() const { return folder_ / "s.boresight.json"; }

  static constexpr const char* kLandmarks =
      R"({"format": "boresight-landmarks", "version": 1, "landmarks": []})";
  const TemporaryFolder folder_;
  const std::filesystem::path stations_ = copyOfExamples(folder_);
  const std::filesystem::path secret_ = folder_.write("elsewhere/secret.txt", "root:x:0:0");
  Session session_ = sessionOfOs(stations_);
};

TEST_F(PackedMembers, LandmarksAreLandmarksOfTheSessionsFolders) {
  const auto named = [this](const std::filesystem::path& landmarks) {
    return refusal([&](SessionCase& session_case) { session_case.landmarks = landmarks; });
  };
  EXPECT_EQ(named(folder_.write("stations/os/l.json", kLandmarks)), "(nothing)");
  EXPECT_THAT(named("/etc/passwd"),
              HasSubstr("s.boresight.json: cases[0].landmarks: /etc/passwd: it lies outside the "
                        "session's folder and those of its inputs"));
  EXPECT_THAT(named(folder_.write("stations/os/notes.txt", "root:x:0:0")),
              AllOf(HasSubstr("cases[0].landmarks: "), HasSubstr("notes.txt: ")));
  EXPECT_THAT(named(folder_.write("stations/os/other.json", "{}")), HasSubstr("format: missing"));
  EXPECT_THAT(named(stations_), HasSubstr("not a file"));

  const TemporaryFolder outside;
  outside.write("l.json", kLandmarks);
  EXPECT_THAT(named(outside / "l.json"), HasSubstr("it lies outside"));
  std::filesystem::create_symlink(outside / "l.json", folder_ / "link.json");
  EXPECT_THAT(named(folder_ / "link.json"), HasSubstr("it leads to "));
}

TEST_F(PackedMembers, RunsAreTracesOfTheirDigests) {
  const std::string id = session_.cases[0]->id, sha256(64, 'd');
  session_.runs.push_back(
      {id, sha256, secret_, "converged", "0.1.0", "2026-01-31T23:59:59Z", sha256, sha256});
  EXPECT_THAT(refusal(session_), HasSubstr("s.boresight.json: runs[0].file: elsewhere/secret.txt: "
                                           "not a trace of boresight"));
  session_.runs[0].file = "/etc/passwd";
  EXPECT_THAT(refusal(session_), HasSubstr("runs[0].file: /etc/passwd: it lies outside"));
  const RunRecord run = storeRun(session_, id, runCase(session_, id), file());
  session_.runs[0].file = run.file;
  EXPECT_THAT(refusal(session_), HasSubstr("digest: is " + run.digest));
  session_.runs[0] = run;
  EXPECT_EQ(refusal(session_), "(nothing)");
}

TEST_F(PackedMembers, InputsAreOfTheirKindEvenWhenTheirHashesAreKnown) {
  const InputFile secret = {secret_, inputSha256(secret_)};
  EXPECT_THAT(refusal([&](SessionCase& changed) { changed.image.source = secret; }),
              HasSubstr("cases[0].image: elsewhere/secret.txt: "));
  EXPECT_THAT(refusal([&](SessionCase& changed) { changed.ignore = secret; }),
              HasSubstr("cases[0].ignore: elsewhere/secret.txt: "));
  EXPECT_THAT(refusal([&](SessionCase& changed) { changed.onboard_record = secret; }),
              HasSubstr("cases[0].onboard_record: elsewhere/secret.txt: "));
  EXPECT_THAT(refusal([&](SessionCase& changed) {
                changed.parts[0].source.mesh = folder_.write("elsewhere/secret.ply", "root:x:0:0");
                changed.parts[0].sha256 = secret.sha256;  // of the same bytes
              }),
              HasSubstr("cases[0].parts[0]: elsewhere/secret.ply: "));
}

TEST_F(PackedMembers, AnInputThatIsALinkToElsewhereIsRefused) {
  const TemporaryFolder outside;
  const std::filesystem::path image = session_.cases[0]->image.source.file;
  std::filesystem::rename(image, outside / "image.png");
  std::filesystem::create_symlink(outside / "image.png", image);
  EXPECT_THAT(refusal(session_), HasSubstr("cases[0].image: stations/os/image.png: it leads to "));
  std::filesystem::remove(image);
  std::filesystem::rename(outside / "image.png", folder_ / "kept.png");
  std::filesystem::create_symlink(folder_ / "kept.png", image);
  EXPECT_EQ(refusal(session_), "(nothing)") << "a link within the session's folder";
}

TEST_F(PackedMembers, MeshBuffers_AreStatedAndInTheMeshsFolder) {
  const test::PolygonMesh cube = test::cube();
  std::size_t index_count = 0;
  const std::string buffer = test::gltfBuffer(cube, &index_count);
  const auto withBuffer = [&](const std::string& uri) {
    SessionCase session_case = *session_.cases[0];
    session_case.parts[0].source.mesh = folder_.write(
        "mesh/cube.gltf", test::gltf(cube, R"([{"mesh":0}])", R"("uri":")" + uri + R"(",)"));
    session_case.parts[0].source.mesh_unit = "";
    session_case.parts[0].sha256 = inputSha256(session_case.parts[0].source.mesh);
    return withCase(session_, session_case);
  };
  folder_.write("mesh/cube.bin", buffer);
  const Session session = withBuffer("cube.bin");
  EXPECT_EQ(refusal(session), "(nothing)");
  const SessionPack plan = planPack(session, file());
  const auto named = [](const char* end) {
    return testing::Field(&PackedFile::name, testing::EndsWith(end));
  };
  EXPECT_THAT(plan.files,
              ElementsAre(named("/image.png"), named("/cube.gltf"), named("/cube.bin")));
  folder_.write("mesh/padded.bin", buffer + std::string(3, '\0'));
  EXPECT_EQ(refusal(withBuffer("padded.bin")), "(nothing)") << "to a multiple of four bytes";
  folder_.write("mesh/padded.bin", buffer + std::string(4, '\0'));
  EXPECT_THAT(refusal(withBuffer("padded.bin")), HasSubstr("byteLength: is "));
  folder_.write("mesh/long.bin", buffer + "root:x:0:0");
  EXPECT_THAT(refusal(withBuffer("long.bin")),
              HasSubstr("cases[0].parts[0]: mesh/cube.gltf: buffers[0].byteLength: is "));

  const TemporaryFolder outside;
  const Session linked = withBuffer("cube.bin");
  std::filesystem::remove(folder_ / "mesh/cube.bin");
  std::filesystem::create_symlink(outside.write("cube.bin", buffer), folder_ / "mesh/cube.bin");
  EXPECT_THAT(refusal(linked), HasSubstr("cases[0].parts[0]: mesh/cube.gltf: buffers[0].uri: "
                                         "'cube.bin' is not in the mesh's folder"));
}

TEST_F(PackedMembers, AFileThatChangesWhileItIsPackedIsRefused) {
  const SessionPack plan = planPack(session_, file());
  folder_.write("stations/os/image.png", "root:x:0:0");
  EXPECT_THAT(folder_.message([&] { writePack(plan, folder_ / "s.zip"); }),
              HasSubstr("stations/os/image.png: it changed during packing"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.zip"));
}

}  // namespace
}  // namespace boresight::test
