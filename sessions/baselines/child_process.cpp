// SPDX-License-Identifier: Apache-2.0
#include "sessions/baselines/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "sessions/io/files/errors.h"

namespace boresight::sessions {
namespace {

constexpr std::size_t kKeptErrors = 2000;

/// A pipe that closes its ends unless they were taken over.
struct Pipe {
  std::array<int, 2> end{-1, -1};

  Pipe() {
    if (pipe2(end.data(), O_CLOEXEC) != 0)
      throw ChildError(std::string("cannot have a pipe: ") + std::strerror(errno));
  }
  ~Pipe() {
    for (const int one : end)
      if (one >= 0) close(one);
  }
  int take(std::size_t which) {
    const int taken = end[which];
    end[which] = -1;
    fcntl(taken, F_SETFL, O_NONBLOCK);
    return taken;
  }
};

/// While it lives, writing to a process that has gone is an error and not the end of this one.
class BrokenPipeBlock {
 public:
  BrokenPipeBlock() {
    sigemptyset(&broken_pipe_);
    sigaddset(&broken_pipe_, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &broken_pipe_, &before_);
  }
  ~BrokenPipeBlock() {
    const int error = errno;
    const timespec now{0, 0};
    if (sigismember(&before_, SIGPIPE) == 0) sigtimedwait(&broken_pipe_, nullptr, &now);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    errno = error;
  }

 private:
  sigset_t broken_pipe_, before_;
};

/// In a process group of its own, so that its children end with it; no signal blocked or ignored.
pid_t spawnShell(const std::string& command, const Pipe& in, const Pipe& out, const Pipe& err) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.end[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.end[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err.end[1], STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::string shell = "sh", option = "-c", text = command;
  char* const arguments[] = {shell.data(), option.data(), text.data(), nullptr};
  pid_t pid = -1;
  const int error = posix_spawn(&pid, "/bin/sh", &actions, &attributes, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) throw ChildError(std::string("cannot be started: ") + std::strerror(error));
  return pid;
}

/// A shell ends with 128 + n when what it ran died of signal n.
std::string howItEnded(int status) {
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return code > 128 ? "died of signal " + std::to_string(code - 128)
                    : "ended with status " + std::to_string(code);
}

}  // namespace

ChildProcess::ChildProcess(const std::string& command) {
  Pipe in, out, err;
  pid_ = spawnShell(command, in, out, err);
  input_ = in.take(1);
  output_ = out.take(0);
  errors_ = err.take(0);
}

ChildProcess::~ChildProcess() {
  for (const int one : {input_, output_, errors_})
    if (one >= 0) close(one);
  if (pid_ <= 0) return;
  kill(-pid_, SIGKILL);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

/// Waits until data can be written or read; reads the child's standard error meanwhile.
void ChildProcess::wait(bool to_write, Clock::time_point deadline, const std::stop_token& stop) {
  for (;;) {
    if (stop.stop_requested()) throw ChildError("was stopped");
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0)
      throw ChildError(to_write ? "did not take its input in time" : "did not answer in time");
    std::array<pollfd, 2> polled{
        pollfd{to_write ? input_ : output_, static_cast<short>(to_write ? POLLOUT : POLLIN), 0},
        pollfd{errors_, POLLIN, 0}};
    poll(polled.data(), polled.size(), static_cast<int>(std::min<long long>(left, 50)));
    if (polled[1].revents != 0) drainErrors();
    if (polled[0].revents != 0) return;
  }
}

void ChildProcess::drainErrors() {
  std::array<char, 4096> part;
  for (;;) {
    const ssize_t got = ::read(errors_, part.data(), part.size());
    if (got <= 0) {
      if (got == 0) {  // closed: not to be polled again
        close(errors_);
        errors_ = -1;
      }
      return;
    }
    last_errors_.append(part.data(), static_cast<std::size_t>(got));
    if (last_errors_.size() > kKeptErrors) last_errors_.erase(0, last_errors_.size() - kKeptErrors);
  }
}

void ChildProcess::write(std::span<const std::uint8_t> bytes, Clock::time_point deadline,
                         const std::stop_token& stop) {
  const BrokenPipeBlock block;
  while (!bytes.empty()) {
    wait(true, deadline, stop);
    const ssize_t written = ::write(input_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    } else if (errno != EAGAIN && errno != EINTR) {
      died();
    }
  }
}

/// What there is; false when the child has closed its output.
bool ChildProcess::receive() {
  std::array<std::uint8_t, 65536> part;
  const ssize_t got = ::read(output_, part.data(), part.size());
  if (got > 0) received_.insert(received_.end(), part.data(), part.data() + got);
  return got > 0 || (got < 0 && (errno == EAGAIN || errno == EINTR));
}

std::string ChildProcess::readLine(std::size_t most, Clock::time_point deadline,
                                   const std::stop_token& stop) {
  for (;;) {
    const auto end = std::find(received_.begin(), received_.end(), std::uint8_t{'\n'});
    if (static_cast<std::size_t>(end - received_.begin()) > most)
      throw ChildError("wrote a line of more than " + std::to_string(most) + " bytes");
    if (end != received_.end()) {
      std::string line(received_.begin(), end);
      received_.erase(received_.begin(), end + 1);
      return line;
    }
    wait(false, deadline, stop);
    if (!receive()) died();
  }
}

std::vector<std::uint8_t> ChildProcess::read(std::size_t count, Clock::time_point deadline,
                                             const std::stop_token& stop) {
  while (received_.size() < count) {
    wait(false, deadline, stop);
    if (!receive()) died();
  }
  const auto end = received_.begin() + static_cast<std::ptrdiff_t>(count);
  std::vector<std::uint8_t> bytes(received_.begin(), end);
  received_.erase(received_.begin(), end);
  return bytes;
}

/// It has closed a pipe: gone, or about to go.
void ChildProcess::died() {
  int status = 0;
  pid_t ended = 0;
  for (int i = 0; i < 200 && ended == 0; ++i) {
    if (i > 0) usleep(10000);
    ended = waitpid(pid_, &status, WNOHANG);
  }
  if (errors_ >= 0) drainErrors();
  std::string reason = "closed its pipes";
  if (ended == pid_) {
    kill(-pid_, SIGKILL);  // its remaining children
    pid_ = -1;
    reason = howItEnded(status);
  }
  while (!last_errors_.empty() && last_errors_.back() == '\n') last_errors_.pop_back();
  const std::size_t start = last_errors_.rfind('\n');
  const std::string said =
      oneLine(start == std::string::npos ? last_errors_ : last_errors_.substr(start + 1));
  throw ChildError(said.empty() ? reason : reason + ", saying: " + said);
}

}  // namespace boresight::sessions
