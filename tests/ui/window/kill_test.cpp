// SPDX-License-Identifier: Apache-2.0
// The whole program killed during an edit: nothing that it had shown as done is lost, and
// the session always opens. A handful of moments; fifty with BORESIGHT_ALL set.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include <QProcess>

#include "core/base/random.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_file.h"
#include "tests/support/all_cases.h"
#include "tests/ui/window_test.h"

namespace boresight::ui {
namespace {

using test::kPatienceMs;

/// What the disk has: the saved state, and that of the journal after its edits.
struct StatesOnDisk {
  std::string saved;
  std::string latest;
  std::size_t edits = 0;
};

StatesOnDisk statesOnDisk(const std::filesystem::path& file) {
  StatesOnDisk states;
  states.saved = sessions::sha256Text(sessions::readFileBytes(file, SIZE_MAX));
  states.latest = states.saved;
  const std::filesystem::path journal = sessions::journalFileOf(file);
  if (!std::filesystem::exists(journal)) return states;
  const sessions::Recovery left = sessions::readJournal(journal, sessions::readSessionFile(file));
  states.latest = sessions::sha256Text(sessions::sessionText(left.session, file));
  states.edits = left.edits.size();
  return states;
}

struct Reported {
  std::string confirmed;    ///< "": it had not come so far
  bool is_undoing = false;  ///< and what follows is not confirmed

  void add(const std::string& line) {
    is_undoing = line == "undo";
    if (!is_undoing) confirmed = line;
  }
};

/// Starts the program, kills it after some reports and a moment, and returns the last ones.
Reported lastReported(const std::filesystem::path& file, int round, Random& random) {
  QProcess program;
  program.setProcessChannelMode(QProcess::ForwardedErrorChannel);
  program.start(QStringLiteral(BORESIGHT_SCRIPTED_EDITS),
                {QString::fromStdString(file.string()), QString::number(round)});
  EXPECT_TRUE(program.waitForStarted(kPatienceMs));
  Reported reported;
  int left = static_cast<int>(random.below(test::allCases() ? 40 : 12));
  while (left > 0 && program.state() == QProcess::Running) {
    if (!program.canReadLine()) program.waitForReadyRead(kPatienceMs);
    while (left > 0 && program.canReadLine()) {
      reported.add(program.readLine().trimmed().toStdString());
      --left;
    }
  }
  std::this_thread::sleep_for(std::chrono::microseconds(random.below(30000)));
  EXPECT_EQ(program.state(), QProcess::Running) << "it ended by itself";
  program.kill();  // SIGKILL
  EXPECT_TRUE(program.waitForFinished(kPatienceMs));
  while (program.canReadLine()) reported.add(program.readLine().trimmed().toStdString());
  EXPECT_EQ(program.exitStatus(), QProcess::CrashExit);
  return reported;
}

TEST(KillProgram, NothingConfirmedIsLost) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "one.boresight.json";
  sessions::SessionDocument::create(file, test::withoutSearch(test::exampleSession()));
  const int rounds = test::allCases() ? 50 : 3;
  Random random(2026);
  int confirmed_rounds = 0;
  for (int round = 0; round < rounds; ++round) {
    SCOPED_TRACE(round);
    const auto [confirmed, is_undoing] = lastReported(file, round, random);
    const StatesOnDisk states = statesOnDisk(file);
    if (!confirmed.empty()) {
      ++confirmed_rounds;
      const std::size_t space = confirmed.find(' ');
      const std::string state = confirmed.substr(0, space);
      const std::size_t edits = std::stoul(confirmed.substr(space + 1));
      // One more action, an edit or a save, may have come to the disk without being confirmed; an
      // undo to the saved state leaves no edits there.
      EXPECT_TRUE(state == states.latest || state == states.saved || states.edits == edits + 1 ||
                  (is_undoing && states.edits == 0))
          << "a confirmed state is not on the disk: " << confirmed << ", " << states.edits
          << " edits there";
    }
    const auto document = sessions::SessionDocument::open(file);
    ASSERT_FALSE(document.readOnly()) << document.readOnlyReason();
    for (const std::string& notice : document.notices())
      EXPECT_EQ(notice.find("set aside"), std::string::npos) << notice;
    const sessions::Session& session =
        document.recovery() ? document.recovery()->session : document.session();
    EXPECT_EQ(sessions::sha256Text(sessions::sessionText(session, file)), states.latest)
        << "what is offered is the latest that the disk has";
  }
  EXPECT_GT(confirmed_rounds, rounds / 2);
}

}  // namespace
}  // namespace boresight::ui
