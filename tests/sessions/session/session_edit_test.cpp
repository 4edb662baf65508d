// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_edit.h"

#include <gtest/gtest.h>

#include "tests/sessions/session/random_session.h"

namespace boresight::test {
namespace {

using sessions::Session;

TEST(SessionEdit, OnTheSessionThatItWasMadeFor_GivesTheEditedOne) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const Session before = randomSession(random);
    const Session after = coin(random) ? randomEdit(random, before) : randomSession(random);
    EXPECT_EQ(sessions::editBetween(before, after)(before), after);
  }
}

TEST(SessionEdit, OnASessionWithAFurtherRunAndOptions_KeepsThem) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    Session before = randomSession(random);
    before = sessions::withCase(before, randomCase(random, "kept"));
    const Session after =
        sessions::withChanged(before, "kept", [](auto& each) { each.station = "another"; });
    Session now = before;
    now.runs.push_back(randomRun(random, "kept"));
    now.options = {{"search.enabled", false}};
    now = sessions::withCase(now, randomCase(random, "added"));
    const Session next = sessions::editBetween(before, after)(now);
    EXPECT_EQ(next,
              sessions::withChanged(now, "kept", [](auto& each) { each.station = "another"; }));
  }
}

TEST(SessionEdit, DecisionThatWasReplacedByAnother_IsRemoved) {
  Random random(3);
  Session before = sessions::withCase({}, randomCase(random, "a"));
  before.decisions.push_back(randomDecision(random, "a"));
  Session after = before;
  after.decisions.clear();
  after.decisions.push_back(randomDecision(random, "a"));
  Session now = before;
  now.decisions.push_back(randomDecision(random, "a"));
  const Session next = sessions::editBetween(before, after)(now);
  ASSERT_EQ(next.decisions.size(), 2u);
  EXPECT_EQ(next.decisions[0], std::as_const(now).decisions[1]);
  EXPECT_EQ(next.decisions[1], std::as_const(after).decisions[0]);
}

}  // namespace
}  // namespace boresight::test
