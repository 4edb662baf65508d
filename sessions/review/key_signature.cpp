// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/key_signature.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <system_error>
#include <vector>

#include "sessions/io/files/errors.h"

extern char** environ;

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

/// Exit status of ssh-keygen with `input` as its standard input; without a shell, so that a name is
/// text whatever is in it. Its messages are dropped. Nothing when there is no such program.
std::optional<int> runKeygen(const std::vector<std::string>& arguments, const fs::path& input) {
  std::vector<char*> pointers = {const_cast<char*>("ssh-keygen")};
  for (const std::string& argument : arguments)
    pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, input.c_str(), O_RDONLY, 0);
  for (const int output : {1, 2})
    posix_spawn_file_actions_addopen(&actions, output, "/dev/null", O_WRONLY, 0);
  pid_t process = -1;
  const int failed =
      posix_spawnp(&process, "ssh-keygen", &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return std::nullopt;
  int status = 0;
  while (waitpid(process, &status, 0) < 0)
    if (errno != EINTR) return std::nullopt;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}

/// The signatures of a file: FILE.sig and FILE.*.sig next to it, by name.
std::vector<fs::path> signatureFiles(const fs::path& file) {
  std::vector<fs::path> found;
  std::error_code error;
  const std::string start = file.filename().string() + ".";
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  for (auto entry = fs::directory_iterator(folder, error); !error && entry != fs::end(entry);
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(start) && name.ends_with(".sig")) found.push_back(entry->path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

bool isSignedBy(const std::string& name, const fs::path& file, const fs::path& signers) {
  if (!fs::is_regular_file(signers)) throw InputError(signers, "no such file of allowed signers");
  for (const fs::path& signature : signatureFiles(file)) {
    const auto status = runKeygen({"-Y", "verify", "-n", "boresight", "-f", signers.string(), "-I",
                                   name, "-s", signature.string()},
                                  file);
    if (!status)
      throw InputError(signature, "cannot be checked: install ssh-keygen (package openssh-client)");
    if (*status == 0) return true;
  }
  return false;
}

}  // namespace boresight::sessions
