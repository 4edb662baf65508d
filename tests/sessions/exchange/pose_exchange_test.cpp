// SPDX-License-Identifier: Apache-2.0
#include "sessions/exchange/pose_exchange.h"

#include <fstream>

#include <gmock/gmock.h>

#include "sessions/evaluation/bop_results.h"
#include "sessions/io/errors.h"
#include "sessions/review/decide.h"
#include "sessions/review/handed_pose.h"
#include "tests/sessions/review/judged_case.h"
#include "tests/support/marked_example.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using sessions::Session;
using testing::HasSubstr;

std::string textOf(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Both stations marked, the OS one's marks vouched for.
Session halfValidated() {
  const Session marked = markedExample(0.1);
  const std::string id = caseOfStation(marked, "os");
  const auto subject = reviewSubject(marked, sessions::loadCase(*marked.findCase(id)),
                                     sessions::PoseSource::kAnnotation);
  return validated(marked, subject, {JudgedCase::check("coverage", sessions::CheckState::kPassed)},
                   {}, {"Ada", "right"});
}

TEST(PoseExchange, EveryFileSaysWhoValidatedAndWhatNobodyDid) {
  const TemporaryFolder folder;
  const Session session = halfValidated();
  const std::string os = caseOfStation(session, "os");
  const std::string bc = caseOfStation(session, "bc");
  writeColmapOf(session, folder / "os", posesToHandOver(session, {os}));
  writeColmapOf(session, folder / "bc", posesToHandOver(session, {bc}));
  EXPECT_THAT(textOf(folder / "os" / "images.txt"), HasSubstr("image.png: validated by Ada"));
  EXPECT_THAT(textOf(folder / "bc" / "images.txt"),
              HasSubstr("image.png: NOT VALIDATED: annotated"));
  writeBopOf(session, folder / "bop", posesToHandOver(session, {}));
  const std::string truth = textOf(folder / "bop" / "scene_gt.json");
  EXPECT_THAT(truth, HasSubstr("\"remark\": \"validated by Ada\""));
  EXPECT_THAT(truth, HasSubstr("\"remark\": \"NOT VALIDATED: annotated\""));
}

TEST(PoseExchange, ResultsThatNobodyValidatedNeedANameThatSaysSo) {
  const TemporaryFolder folder;
  const Session session = halfValidated();
  const std::string os = caseOfStation(session, "os");
  EXPECT_THROW(exportBopResults(session, folder / "r.csv", {}, 1), sessions::InputError);
  EXPECT_FALSE(std::filesystem::exists(folder / "r.csv"));
  EXPECT_EQ(exportBopResults(session, folder / "r.csv", {os}, 1).case_ids.size(), 1u);
  EXPECT_EQ(
      exportBopResults(session, folder / "a-NOT-VALIDATED_os-test.csv", {}, 7).case_ids.size(), 2u);
  const auto read = sessions::readBopResults(folder / "a-NOT-VALIDATED_os-test.csv");
  EXPECT_EQ(read[0].scene_id, 7);
  EXPECT_NE(read[0].object_id, read[1].object_id);
}

TEST(PoseExchange, APoseThatItsMarksDoNotGiveIsLeftOut) {
  Session session = halfValidated();
  const std::string os = caseOfStation(session, "os");
  session.decisions.back().pose->camera_from_station.translation_m.z() = 0.5;
  EXPECT_THROW(posesToHandOver(session, {os}), sessions::InputError);
  const sessions::CasePoses others = posesToHandOver(session, {});
  EXPECT_EQ(others.poses.size(), 1u);
  EXPECT_THAT(others.notes, testing::ElementsAre(HasSubstr("another pose comes out")));
}

TEST(PoseExchange, AnotherPoseOfAValidatedCaseIsNotTheValidatedOne) {
  const TemporaryFolder folder;
  const Session session = halfValidated();
  sessions::CasePoses poses = posesToHandOver(session, {caseOfStation(session, "os")});
  poses.poses[0].camera_from_station.translation_m.x() += 1e-9;
  writeColmapOf(session, folder / "os", poses);
  EXPECT_THAT(textOf(folder / "os" / "images.txt"), HasSubstr("NOT VALIDATED: another pose"));
}

}  // namespace
}  // namespace boresight::test
