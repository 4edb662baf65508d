// SPDX-License-Identifier: Apache-2.0
// usage: peak_memory LIMIT_BYTES PROGRAM ARGUMENT...
// What a program's work takes of the memory that it can write, seen from outside: the private pages
// that the operating system has given it when it ends, less those when it is started without
// arguments and only says how it is used. (It must give nothing back before its end, as the flight
// driver does: static memory and stack.) Ends with 1 when the work fails or takes more than LIMIT.
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

struct Ended {
  long private_bytes = -1;
  int exit_code = -1;
};

/// From the kernel's table of a process' pages; -1 when it cannot be read.
long privateBytes(pid_t process) {
  const std::string file = "/proc/" + std::to_string(process) + "/smaps_rollup";
  std::FILE* table = std::fopen(file.c_str(), "r");
  if (table == nullptr) return -1;
  char line[256];
  long kilobytes = -1;
  while (std::fgets(line, sizeof line, table) != nullptr)
    if (std::sscanf(line, "Anonymous: %ld kB", &kilobytes) == 1) break;
  std::fclose(table);
  return kilobytes < 0 ? -1 : kilobytes * 1024;
}

void becomeTraced(char* const* command, bool silent) {
  if (silent && std::freopen("/dev/null", "w", stderr) == nullptr) _exit(126);
  ptrace(PTRACE_TRACEME, 0, nullptr, nullptr);
  execvp(command[0], command);
  _exit(127);
}

/// Stops the program when it has begun and when it is about to end.
Ended run(char* const* command, bool silent) {
  const pid_t child = fork();
  if (child < 0) return {};
  if (child == 0) becomeTraced(command, silent);
  Ended ended;
  int status = 0;
  while (waitpid(child, &status, 0) == child && WIFSTOPPED(status)) {
    const int signal = WSTOPSIG(status);
    const bool at_exit = status >> 8 == (SIGTRAP | (PTRACE_EVENT_EXIT << 8));
    if (at_exit) ended.private_bytes = privateBytes(child);
    ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_TRACEEXIT);
    ptrace(PTRACE_CONT, child, nullptr, signal == SIGTRAP ? 0 : signal);
  }
  if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
  return ended;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: peak_memory LIMIT_BYTES PROGRAM ARGUMENT...\n");
    return 2;
  }
  const long limit = std::strtol(argv[1], nullptr, 10);
  char* idle_command[] = {argv[2], nullptr};
  const Ended idle = run(idle_command, true);
  const Ended worked = run(argv + 2, false);
  if (idle.private_bytes < 0 || worked.private_bytes < 0) {
    std::printf("SKIPPED: another program's memory may not be looked at here\n");
    return 77;
  }
  const long taken = worked.private_bytes - idle.private_bytes;
  std::printf("private memory: %ld bytes idle, %ld at the end, %ld for the work (at most %ld)\n",
              idle.private_bytes, worked.private_bytes, taken, limit);
  return worked.exit_code == 0 && taken > 0 && taken <= limit ? 0 : 1;
}
