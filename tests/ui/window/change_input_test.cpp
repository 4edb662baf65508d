// SPDX-License-Identifier: Apache-2.0
#include "ui/window/change_input.h"

#include <nlohmann/json.hpp>

#include "sessions/session/ignore_strokes.h"
#include "tests/ui/window_test.h"
#include "ui/window/case_controller.h"
#include "ui/window/window_frame.h"
#include "ui/workspaces/verdict_bar.h"

namespace boresight::ui {
namespace {

using sessions::InputKind;

class ChangeInputTest : public test::SharedWindowTest {
 protected:
  const Verdict& verdict() { return window_.frame().verdict().verdict(); }
  const sessions::SessionCase& shown() {
    return *window_.document().session().findCase(window_.cases().caseId().toStdString());
  }
  void change(InputKind kind, const std::filesystem::path& file, const char* unit = "") {
    window_.cases().changeInput(window_.cases().caseId(), kind, file, unit);
  }
};

TEST_F(ChangeInputTest, WrongUnit_IsSaidBeforeTheRunAndPutRight) {
  ASSERT_TRUE(wait([&] { return verdict().head == QStringLiteral("Ready to run."); }));
  change(InputKind::kMesh, shown().parts.front().source.mesh, "mm");
  ASSERT_TRUE(wait([&] { return verdict().head == QStringLiteral("Not ready to run."); }))
      << verdict().head.toStdString();
  EXPECT_EQ(verdict().step, Step::kChangeInput);
  EXPECT_EQ(verdict().step_text, QStringLiteral("Unit of the mesh..."));
  EXPECT_FALSE(find<QAction>("runToEnd").isEnabled());
  find<QAction>("undo").trigger();
  ASSERT_TRUE(wait([&] { return verdict().head == QStringLiteral("Ready to run."); }));
  EXPECT_EQ(shown().parts.front().source.mesh_unit, "m");
}

TEST_F(ChangeInputTest, AnotherCamera_IsTakenAndNamesItsMisfit) {
  nlohmann::ordered_json camera = {{"format", "boresight-camera"}, {"version", 1}};
  Camera small = shown().camera;
  small.width = 640;
  small.height = 480;
  camera.update(sessions::toJson(small));
  change(InputKind::kCamera, folder_.write("camera.json", camera.dump()));
  ASSERT_TRUE(wait([&] { return verdict().head == QStringLiteral("Not ready to run."); }));
  EXPECT_EQ(verdict().sentence,
            QStringLiteral("The camera is for 640 x 480 px, the image is 512 x 512 px."));
  EXPECT_EQ(verdict().step_text, QStringLiteral("Choose camera..."));
}

/// Reading takes a while; nothing is disabled meanwhile.
TEST_F(ChangeInputTest, EditsAndOtherInputsDuringTheReading_AreKept) {
  nlohmann::ordered_json camera = {{"format", "boresight-camera"}, {"version", 1}};
  Camera longer = shown().camera;
  longer.fx += 1.0;
  camera.update(sessions::toJson(longer));
  const std::filesystem::path mesh = shown().parts.front().source.mesh;
  change(InputKind::kCamera, folder_.write("camera.json", camera.dump()));
  change(InputKind::kMesh, mesh, "mm");
  sessions::MaskStroke stroke;
  stroke.kind = sessions::StrokeKind::kSaturation;
  stroke.level = 250;
  const std::string id = shown().id;
  ASSERT_TRUE(window_.document().edit(
      sessions::withStroke(window_.document().session(), id, stroke), QStringLiteral("Stroke")));
  ASSERT_TRUE(wait([&] { return shown().parts.front().source.mesh_unit == "mm" && resting(); }));
  EXPECT_EQ(shown().camera.fx, longer.fx) << "chosen before the mesh";
  EXPECT_EQ(shown().ignore_strokes.size(), 1u);
}

TEST_F(ChangeInputTest, AnotherSessionDuringTheReading_DoesNotGetTheCase) {
  const std::filesystem::path mesh = shown().parts.front().source.mesh;
  change(InputKind::kMesh, mesh, "mm");
  const sessions::Session other = test::withoutSearch(test::exampleSession());
  newFile();
  ASSERT_TRUE(window_.document().create(file_, other));
  ASSERT_TRUE(wait([&] { return window_.lastMessage().contains(QLatin1String("not used")); }));
  ASSERT_TRUE(rests());
  EXPECT_TRUE(window_.document().session() == other);
}

TEST_F(ChangeInputTest, SameInputChosenInAnotherSession_DoesNotDropTheReportOnTheFirst) {
  const std::filesystem::path mesh = shown().parts.front().source.mesh;
  change(InputKind::kMesh, mesh, "mm");
  newFile();
  ASSERT_TRUE(window_.document().create(file_, test::withoutSearch(test::exampleSession())));
  change(InputKind::kMesh, mesh, "mm");
  EXPECT_TRUE(wait([&] { return window_.lastMessage().contains(QLatin1String("not used")); }));
  EXPECT_TRUE(wait([&] { return shown().parts.front().source.mesh_unit == "mm" && resting(); }));
}

TEST_F(ChangeInputTest, UnreadableFile_ChangesNothing) {
  const auto before = window_.document().session();
  change(InputKind::kSeed, folder_.write("no.json", "{"));
  ASSERT_TRUE(wait([&] { return window_.lastMessage().contains(QLatin1String("no.json")); }));
  EXPECT_TRUE(window_.document().session() == before);
}

TEST_F(ChangeInputTest, EditMenu_HasEachInputAndTheUnit) {
  QStringList names;
  for (const QAction* action : find<QMenu>("changeMenu").actions()) names << action->text();
  EXPECT_EQ(names, (QStringList{QStringLiteral("Image..."), QStringLiteral("Camera..."),
                                QStringLiteral("Mesh..."), QStringLiteral("Seed..."),
                                QStringLiteral("Unit of the mesh...")}));
}

}  // namespace
}  // namespace boresight::ui
