// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <vector>

#include "sessions/evaluation/results_file.h"
#include "sessions/io/files/errors.h"
#include "tests/app/run_whs.h"

namespace boresight::test {

/// How whs ended that got a signal.
struct EndedWhs {
  int held = 0;    ///< runs that it has stored
  int status = 0;  ///< as waitpid gives it
};

/// Runs whs and sends it a signal as soon as `held()`, its stored runs, is `runs`.
template <class Held>
EndedWhs endWhsWhen(const Arguments& arguments, int signal, const Held& held, int runs) {
  const pid_t child = fork();
  if (child == 0) {
    std::vector<char*> words = {const_cast<char*>(BORESIGHT_WHS)};
    for (const std::string& argument : arguments)
      words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    execv(BORESIGHT_WHS, words.data());
    _exit(127);
  }
  EndedWhs ended;
  while (held() < runs && waitpid(child, &ended.status, WNOHANG) == 0) usleep(2000);
  kill(child, signal);
  waitpid(child, &ended.status, 0);
  ended.held = held();
  return ended;
}

/// As soon as its results file holds `runs` runs.
inline EndedWhs endWhsAfter(const Arguments& arguments, int signal,
                            const std::filesystem::path& results, int runs) {
  const auto held = [&results] {
    try {
      return static_cast<int>(sessions::readResults(results).runs.size());
    } catch (const sessions::FileError&) {
      return 0;  // not there yet
    }
  };
  return endWhsWhen(arguments, signal, held, runs);
}

}  // namespace boresight::test
