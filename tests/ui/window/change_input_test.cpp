// SPDX-License-Identifier: Apache-2.0
#include "ui/window/change_input.h"

#include <nlohmann/json.hpp>

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
