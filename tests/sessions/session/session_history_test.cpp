// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session_document.h"

#include <gtest/gtest.h>

#include "tests/sessions/session/random_session.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using sessions::Session;
using sessions::SessionDocument;
using sessions::SessionHistory;

TEST(SessionHistory, UndoesAndRedoesEveryStep) {
  Random random = randomFor("SessionHistory");
  const TemporaryFolder folder;
  SessionDocument document = SessionDocument::create(folder / "s.json", randomSession(random));
  SessionHistory history(document);
  std::vector<Session> states = {document.session()};
  for (int i = 0; i < 30; ++i) {
    history.perform(randomEdit(random, document.session()), "Edit " + std::to_string(i));
    if (states.size() <= history.done()) states.push_back(document.session());
  }
  const Session& end = document.session();
  const auto expectEdits = [&](std::size_t i) {
    ASSERT_TRUE(keepingRuns(states[i], {}) == keepingRuns(document.session(), {})) << i;
  };
  const std::size_t count = history.done();
  ASSERT_EQ(states.size(), count + 1);
  for (std::size_t i = count; i > 0; --i) {
    expectEdits(i);
    EXPECT_TRUE(history.canUndo());
    history.undo();
  }
  expectEdits(0);
  EXPECT_FALSE(history.canUndo());
  history.undo();
  for (std::size_t i = 1; i <= count; ++i) {
    history.redo();
    expectEdits(i);
  }
  EXPECT_FALSE(history.canRedo());
  EXPECT_TRUE(keepingRuns(end, {}) == keepingRuns(states.back(), {}));
}

TEST(SessionHistory, ANewEditForgetsWhatWasUndone) {
  Random random = randomFor("forget");
  const TemporaryFolder folder;
  SessionDocument document = SessionDocument::create(folder / "s.json", {});
  SessionHistory history(document);
  history.perform(withCase(document.session(), randomCase(random, "a")), "Add a");
  history.perform(withCase(document.session(), randomCase(random, "b")), "Add b");
  history.perform(document.session(), "Nothing");
  EXPECT_EQ(history.undoText(), "Add b");
  history.undo();
  EXPECT_EQ(history.redoText(), "Add b");
  history.perform(withCase(document.session(), randomCase(random, "c")), "Add c");
  EXPECT_EQ(history.redoText(), "");
  EXPECT_EQ(document.session().cases.size(), 2u);
}

TEST(SessionHistory, RunsAndTheViewAreNotUndone) {
  Random random = randomFor("runs");
  const TemporaryFolder folder;
  SessionDocument document =
      SessionDocument::create(folder / "s.json", withCase({}, randomCase(random, "a")));
  SessionHistory history(document);
  history.perform(withAnnotation(document.session(), "a", randomAnnotation(random)), "Mark");
  Session ran = document.session();
  ran.runs.push_back({"a", randomSha256(random), folder / "x", "converged", "0.1.0",
                      "2026-01-31T23:59:59Z", randomSha256(random), randomSha256(random)});
  ran.view.case_id = "a";
  document.apply(ran, "Run a");
  history.undo();
  EXPECT_TRUE(document.session().annotations.empty());
  EXPECT_EQ(document.session().runs.size(), 1u);
  EXPECT_EQ(document.session().view.case_id, "a");
}

TEST(SessionHistory, AStepThatCannotBeWrittenHasNotHappened) {
  Random random = randomFor("unwritten");
  const TemporaryFolder folder;
  { SessionDocument::create(folder / "s.json", withCase({}, randomCase(random, "a"))); }
  SessionDocument document = SessionDocument::open(folder / "s.json", sessions::Access::kReadOnly);
  SessionHistory history(document);
  EXPECT_NE(folder.message([&] {
    history.perform(withAnnotation(document.session(), "a", randomAnnotation(random)), "Mark");
  }),
            "(nothing)");
  EXPECT_FALSE(history.canUndo());
  EXPECT_TRUE(document.session().annotations.empty());
}

}  // namespace
}  // namespace boresight::test
