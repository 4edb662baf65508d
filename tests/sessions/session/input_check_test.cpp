// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/input_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "sessions/session/case_run.h"
#include "tests/sessions/session/example_session.h"

namespace boresight::test {
namespace {

using sessions::Finding;
using sessions::FindingKind;
using sessions::Session;
using testing::AllOf;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

auto finding(FindingKind kind, const std::string& what, const std::string& text) {
  return AllOf(Field(&Finding::kind, kind), Field(&Finding::what, what),
               Field(&Finding::text, HasSubstr(text)));
}

TEST(InputCheck, ReportsWhatIsMissingOrChanged) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  const Session session = sessions::makeSession(stations / "dataset.json");
  EXPECT_THAT(sessions::checkInputs(session), IsEmpty());
  std::filesystem::remove(stations / "bc/image.png");
  std::ofstream(stations / "bc/model.ply", std::ios::app) << "\n";
  folder.write("stations/os/image.png", "");
  EXPECT_THAT(sessions::checkInputs(session),
              ElementsAre(finding(FindingKind::kMissing, "image", "image.png: no such file"),
                          finding(FindingKind::kChanged, "parts[0]", "is not the file"),
                          finding(FindingKind::kUnreadable, "image", "the file is empty")));
  std::filesystem::copy(stations / "os/model.ply", stations / "bc/model.ply",
                        std::filesystem::copy_options::overwrite_existing);
  for (const auto& one : session.cases)
    EXPECT_NE(folder.message([&] { (void)sessions::loadCase(*one); }), "(nothing)");
}

TEST(InputCheck, ACaseOfChangedInputsIsNotLoadedBeforeSomebodyAcceptsThem) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  const Session session = sessions::makeSession(stations / "dataset.json");
  const sessions::SessionCase& bc = *session.cases[0];
  std::filesystem::copy(stations / "os/image.png", stations / "bc/image.png",
                        std::filesystem::copy_options::overwrite_existing);
  std::filesystem::copy(stations / "os/model.ply", stations / "bc/model.ply",
                        std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(folder.message([&] { (void)sessions::loadCase(bc); }),
              HasSubstr("bc/image.png: its bytes are not those that the session was made with"));
  const Session accepted = sessions::acceptingInputs(session, bc.id);
  EXPECT_THAT(sessions::checkInputs(accepted), IsEmpty());
  EXPECT_NO_THROW((void)sessions::loadCase(*accepted.cases[0]));
  EXPECT_NE(sessions::inputsDigest(*accepted.cases[0]), sessions::inputsDigest(bc));
  sessions::SessionCase half = bc;
  half.image = accepted.cases[0]->image;
  EXPECT_THAT(folder.message([&] { (void)sessions::loadCase(half); }),
              HasSubstr("bc/model.ply: its bytes are not those"));
}

TEST(InputCheck, FindsMovedFilesByNameAndHash) {
  const TemporaryFolder folder;
  const std::filesystem::path stations = copyOfExamples(folder);
  const Session session = sessions::makeSession(stations / "dataset.json");
  // The session lies elsewhere now, its inputs partly in other folders, beside a false friend.
  const std::filesystem::path other = folder / "other";
  std::filesystem::create_directories(other / "deep/er");
  std::filesystem::rename(stations / "bc", other / "deep/er/bc");
  std::filesystem::create_directories(other / "os");
  std::filesystem::rename(stations / "os/image.png", other / "os/image.png");
  std::filesystem::rename(stations / "os/model.ply", folder / "unreachable.ply");
  folder.write("other/bc/image.png", "false friend");
  const auto relinks = sessions::findMissing(session, other / "s.json");
  const Session found = sessions::relinked(session, relinks);
  EXPECT_EQ(found.cases[0]->image.source.file, other / "deep/er/bc/image.png");
  EXPECT_EQ(found.cases[0]->parts[0].source.mesh, other / "deep/er/bc/model.ply");
  EXPECT_EQ(found.cases[1]->image.source.file, other / "os/image.png");
  EXPECT_THAT(sessions::checkInputs(found),
              ElementsAre(finding(FindingKind::kMissing, "parts[0]", "model.ply: no such file")));
}

}  // namespace
}  // namespace boresight::test
