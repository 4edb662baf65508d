// SPDX-License-Identifier: Apache-2.0
// A program that is killed at any moment loses nothing that it had confirmed.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <thread>

#include "sessions/session/session_document.h"
#include "tests/sessions/session/random_session.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using sessions::Session;
using sessions::SessionDocument;

/// The number of the last edit is kept in the session's view; the rest is random.
Session numberedEdit(Random& random, const Session& session, std::int32_t number) {
  Session next = random.below(4) == 0 ? randomEdit(random, session) : session;
  next.view.iteration = number;
  return next;
}

/// Opens, recovers, edits in a loop and confirms each edit on the pipe; saves now and then.
[[noreturn]] void editForEver(const std::filesystem::path& file, int confirm, std::uint64_t round) {
  Random random = randomFor("kill " + std::to_string(round));
  SessionDocument document = SessionDocument::open(file);
  document.acceptRecovery();
  for (std::int32_t number = document.session().view.iteration + 1;; ++number) {
    document.apply(numberedEdit(random, document.session(), number), "Edit");
    if (::write(confirm, &number, sizeof(number)) != sizeof(number)) ::_exit(1);
    if (random.below(8) == 0) document.save();
  }
}

TEST(Kill, NothingConfirmedIsLost) {
  const TemporaryFolder folder;
  Random random = randomFor("Kill");
  { SessionDocument::create(folder / "s.json", randomSession(random)); }
  std::int32_t confirmed = -1;
  for (std::uint64_t round = 0; round < 50; ++round) {
    int pipe_ends[2];
    ASSERT_EQ(::pipe(pipe_ends), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      ::close(pipe_ends[0]);
      try {
        editForEver(folder / "s.json", pipe_ends[1], round);
      } catch (const std::exception& error) {
        ::_exit(2);
      }
    }
    ::close(pipe_ends[1]);
    const auto read = [&] { return ::read(pipe_ends[0], &confirmed, sizeof(confirmed)) > 0; };
    for (std::uint32_t left = random.below(30); left > 0; --left) ASSERT_TRUE(read());
    std::this_thread::sleep_for(std::chrono::microseconds(random.below(6000)));
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    while (read()) {
    }
    ::close(pipe_ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << "it ended by itself, with " << WEXITSTATUS(status);

    const SessionDocument document = SessionDocument::open(folder / "s.json");
    ASSERT_FALSE(document.readOnly());
    const Session& session =
        document.recovery() ? document.recovery()->session : document.session();
    // The last edit may be on the disk although it was not confirmed any more.
    ASSERT_GE(session.view.iteration, confirmed) << "round " << round;
    ASSERT_LE(session.view.iteration, confirmed + 1) << "round " << round;
    for (const std::string& notice : document.notices())
      EXPECT_EQ(notice.find("set aside"), std::string::npos) << notice;
  }
  EXPECT_GT(confirmed, 50);
}

}  // namespace
}  // namespace boresight::test
