// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/changed_cases.h"

#include <gmock/gmock.h>

#include "tests/sessions/session/random_session.h"

namespace boresight::test {
namespace {

using sessions::changedCases;
using sessions::Session;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(ChangedCases, NamesThoseThatSomebodyEdited) {
  Random random = randomFor("ChangedCases");
  Session before;
  for (const char* id : {"a", "b", "c"}) before = withCase(before, randomCase(random, id));
  before = withAnnotation(before, "b", randomAnnotation(random));
  EXPECT_THAT(changedCases(before, before), IsEmpty());

  sessions::SessionCase moved = *before.findCase("c");
  moved.camera_from_station_seed.translation_m.x() += 0.01;
  EXPECT_THAT(changedCases(before, withCase(before, moved)), ElementsAre("c"));
  EXPECT_THAT(changedCases(before, withAnnotation(before, "b", {})), ElementsAre("b"));
  EXPECT_THAT(changedCases(before, withAnnotation(before, "a", randomAnnotation(random))),
              ElementsAre("a"));
  EXPECT_THAT(changedCases(before, withCase(before, randomCase(random, "d"))), ElementsAre("d"));
  EXPECT_THAT(changedCases(before, withoutCase(before, "a")), IsEmpty());

  Session decided = before;
  decided.decisions.push_back({"a", sessions::Verdict::kValidated, "Ada", "", "", ""});
  EXPECT_THAT(changedCases(before, decided), ElementsAre("a"));
  Session looked = before;
  looked.view.case_id = "b";
  EXPECT_THAT(changedCases(before, looked), IsEmpty());
}

}  // namespace
}  // namespace boresight::test
