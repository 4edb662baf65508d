// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/guarded_run.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <exception>
#include <stdexcept>

namespace boresight::peers {
namespace {

constexpr char kAnswer = 'a';
constexpr char kException = 'e';
constexpr double kWallFactor = 30.0;

void writeAll(int descriptor, const std::string& text) {
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t count = ::write(descriptor, text.data() + written, text.size() - written);
    if (count <= 0) return;
    written += static_cast<std::size_t>(count);
  }
}

[[noreturn]] void beChild(const std::function<std::string()>& work, int descriptor,
                          double limit_s) {
  const auto whole_s = static_cast<rlim_t>(std::ceil(limit_s));
  const rlimit limit{whole_s, whole_s};
  ::setrlimit(RLIMIT_CPU, &limit);
  const int nowhere = ::open("/dev/null", O_WRONLY);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  std::string text;
  try {
    text = kAnswer + work();
  } catch (const std::exception& error) {
    text = kException + std::string(error.what());
  } catch (...) {
    text = kException + std::string("an exception of unknown kind");
  }
  writeAll(descriptor, text);
  ::_exit(0);
}

/// What the child writes until it closes; false when the time is over before.
bool readUntil(int descriptor, double limit_s, std::string& text) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(limit_s);
  for (;;) {
    const std::chrono::duration<double, std::milli> left = end - std::chrono::steady_clock::now();
    if (left.count() <= 0.0) return false;
    pollfd waited{descriptor, POLLIN, 0};
    if (::poll(&waited, 1, static_cast<int>(left.count()) + 1) <= 0) continue;
    std::array<char, 65536> buffer;
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count <= 0) return true;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

std::string lossText(int status) {
  if (WIFSIGNALED(status)) return "ended by signal " + std::to_string(WTERMSIG(status));
  return "ended with status " + std::to_string(WEXITSTATUS(status)) + " without an answer";
}

}  // namespace

GuardedAnswer runGuarded(const std::function<std::string()>& work, double limit_s) {
  std::array<int, 2> pipe_ends{};
  if (::pipe(pipe_ends.data()) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("no child process");
  if (child == 0) {
    ::close(pipe_ends[0]);
    beChild(work, pipe_ends[1], limit_s);
  }
  ::close(pipe_ends[1]);
  GuardedAnswer guarded;
  std::string text;
  const bool ended = readUntil(pipe_ends[0], kWallFactor * limit_s, text);
  ::close(pipe_ends[0]);
  if (!ended) ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  const bool spent =
      WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL);
  if (!ended || spent)
    guarded.loss = "took more than " + std::to_string(static_cast<int>(limit_s)) + " s";
  else if (text.empty())
    guarded.loss = lossText(status);
  else if (text.front() == kException)
    guarded.loss = text.substr(1);
  else
    guarded.answer = text.substr(1);
  return guarded;
}

}  // namespace boresight::peers
