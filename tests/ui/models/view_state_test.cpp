// SPDX-License-Identifier: Apache-2.0
#include "ui/state/view_state.h"

#include <gtest/gtest.h>

#include "tests/support/example_run.h"
#include "tests/support/loaded_example.h"

namespace boresight::ui {
namespace {

class ViewStateTest : public testing::Test {
 protected:
  ViewStateTest() {
    QObject::connect(&state_, &ViewState::changed,
                     [this](ViewChanges what) { told_.push_back(what); });
  }
  /// What was told since the last time.
  std::vector<ViewChanges> told() { return std::exchange(told_, {}); }

  ViewState state_;
  std::vector<ViewChanges> told_;
};

using Told = std::vector<ViewChanges>;

TEST_F(ViewStateTest, EachChangeIsOneSignal_UnchangedStateNone) {
  state_.setCase(test::loadedExample("os"));
  EXPECT_EQ(told(), Told{ViewChange::kAll});
  state_.setSnapshot(test::exampleRun());
  EXPECT_EQ(told(), Told{ViewChange::kSnapshot | ViewChange::kCursor | ViewChange::kTemplate});
  state_.setCursor(state_.cursor());
  state_.selectTemplate(-1);
  state_.setAlternative(std::nullopt);
  EXPECT_EQ(told(), Told{});
  state_.setCursor({0, Stage::kMatch});
  EXPECT_EQ(told(), Told{ViewChange::kCursor | ViewChange::kTemplate});
  state_.setCursor({0, Stage::kRender});
  EXPECT_EQ(told(), Told{ViewChange::kCursor});
  state_.selectTemplate(1);
  EXPECT_EQ(told(), Told{ViewChange::kTemplate});
  state_.setNudgedPose(Pose());
  EXPECT_EQ(told(), Told{ViewChange::kNudgedPose});
  state_.replaceCase(state_.currentCase());
  EXPECT_EQ(told(), Told{ViewChange::kCase | ViewChange::kCursor | ViewChange::kNudgedPose});
  state_.setAlternative(sessions::Alternative());
  EXPECT_EQ(told(), Told{ViewChange::kAlternative});
}

TEST_F(ViewStateTest, AReceiverIsCalledOnceForSeveralThingsThatChangedTogether) {
  int calls = 0;
  QObject receiver;
  state_.onChange(ViewChange::kCase | ViewChange::kSnapshot | ViewChange::kCursor, &receiver,
                  [&calls] { ++calls; });
  state_.setCase(test::loadedExample("os"));
  EXPECT_EQ(calls, 1);
  state_.setNudgedPose(Pose());
  EXPECT_EQ(calls, 1) << "it asked for other things";
}

}  // namespace
}  // namespace boresight::ui
