// SPDX-License-Identifier: Apache-2.0
#include "tests/ui/window_test.h"
#include "ui/window/window_frame.h"
#include "ui/workspaces/verdict_bar.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

/// The annotated example without its seeds.
sessions::Session withoutSeeds() {
  const auto file = sessions::examplesFolder() / "annotated.boresight.json";
  sessions::Session session =
      sessions::SessionDocument::open(file, sessions::Access::kReadOnly).session();
  for (const std::string& id : {session.cases[0]->id, session.cases[1]->id})
    session = sessions::withChanged(session, id, [](sessions::SessionCase& one) {
      one.has_seed = false;
      one.camera_from_station_seed = Pose();
    });
  return session;
}

class SeedlessTest : public test::WindowTest {
 protected:
  VerdictBar& bar() { return window_.frame().verdict(); }
};

TEST_F(SeedlessTest, IsNotRunWithTheReason_UntilTheAnnotationsGiveASeed) {
  open(withoutSeeds());
  auto* run = window_.findChild<QAction*>(QStringLiteral("runToEnd"));
  EXPECT_FALSE(run->isEnabled());
  EXPECT_TRUE(test::has(run->toolTip(), "no seed"));
  EXPECT_FALSE(poseOf(window_.state(), PoseRole::kSeed).has_value());
  EXPECT_EQ(window_.lastMessage(), QString());
  EXPECT_EQ(bar().verdict().head, QStringLiteral("No seed yet."));
  ASSERT_TRUE(wait([&] { return bar().verdict().step == Step::kSeedFromAnnotation; }))
      << bar().text().toStdString();
  QTest::mouseClick(&bar().action(), Qt::LeftButton);
  ASSERT_TRUE(rests());
  EXPECT_TRUE(window_.document().session().cases[0]->has_seed);
  ASSERT_TRUE(runToTheEnd(1));
  EXPECT_TRUE(window_.state().snapshot()->converged());
  EXPECT_FALSE(window_.document().session().cases[1]->has_seed);
}

}  // namespace
}  // namespace boresight::ui
