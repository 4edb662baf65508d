// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/sessions/session/example_session.h"

namespace boresight::sessions {
namespace {

/// A run of every case as it is, without running it.
Session asIfRun(Session session) {
  for (const auto& one : session.cases) {
    RunRecord run;
    run.case_id = one->id;
    run.inputs_sha256 = inputsDigest(*one);
    run.options_sha256 = optionsDigest(caseOptions(session, *one, {}));
    session.runs.push_back(run);
  }
  return session;
}

Session withRandomEdit(const Session& session, Random& random) {
  const auto at = static_cast<std::size_t>(
      random.uniform(0.0, static_cast<double>(session.cases.size()) - 1e-9));
  SessionCase one = *session.cases[at];
  LocalizerOptions options = sessionOptions(session, {});
  switch (static_cast<int>(random.uniform(0.0, 5.0))) {
    case 0:
      one.camera_from_station_seed.translation_m.x() += 0.01;
      return withCase(session, one);
    case 1:
      one.feature_size_m = random.uniform(0.001, 0.004);
      return withCase(session, one);
    case 2:
      one.tags.push_back("seen");  // no input of a run
      return withCase(session, one);
    case 3:
      options.pnp.seed += 1;
      return withOptions(session, session.profile, options);
    default:
      return withOptions(session, session.profile == "paper" ? "default" : "paper", options);
  }
}

TEST(StaleRuns, SaysAsStalenessWhateverIsEditedAndUndone) {
  Random random(5);
  StaleRuns known;
  std::vector<Session> history = {asIfRun(makeSession(test::exampleFolder() / "dataset.json"))};
  int stale_count = 0, fresh_count = 0;
  for (int edit = 0; edit < 200; ++edit) {
    const double chance = random.uniform(0.0, 1.0);
    if (chance < 0.1)
      history.resize(1);
    else if (chance < 0.5 && history.size() > 1)
      history.pop_back();
    else
      history.push_back(withRandomEdit(history.back(), random));
    const Session& session = history.back();
    for (const auto& one : session.cases) {
      const RunRecord& run = *session.lastRunOf(one->id);
      const bool stale = stalenessOf(run, session, {}).stale();
      EXPECT_EQ(known.isStale(run, one, session, {}), stale) << edit;
      ++(stale ? stale_count : fresh_count);
    }
  }
  EXPECT_GT(stale_count, 50);
  EXPECT_GT(fresh_count, 20);
}

}  // namespace
}  // namespace boresight::sessions
