// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/atomic_folder.h"

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

std::string reasonOf(int error) { return std::generic_category().message(error); }

/// A folder beside another one, removed unless it has got that one's name.
class FolderBeside {
 public:
  explicit FolderBeside(const fs::path& target) : target_(target) {
    static std::atomic<unsigned> counter{0};
    const fs::path name = target.parent_path() / (".boresight-" + std::to_string(::getpid()) + "-" +
                                                  std::to_string(counter.fetch_add(1)) + ".tmp");
    if (::mkdir(name.c_str(), 0777) != 0) throw OutputError(target, reasonOf(errno));
    path_ = name;
  }
  FolderBeside(const FolderBeside&) = delete;
  FolderBeside& operator=(const FolderBeside&) = delete;
  ~FolderBeside() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }

  const fs::path& path() const { return path_; }

  void takeName() {
    moveIntoPlace(path_, target_);
    path_.clear();
  }

 private:
  fs::path target_;
  fs::path path_;
};

}  // namespace

void writeFolderAtomically(const fs::path& folder,
                           const std::function<void(const fs::path&)>& write) {
  if (folder.empty()) throw OutputError("(no name)", "a folder name is empty");
  fs::path target = fs::absolute(folder).lexically_normal();
  if (!target.has_filename()) target = target.parent_path();  // written with a slash at its end
  std::error_code error;
  const fs::file_status status = fs::symlink_status(target, error);
  const bool there = fs::exists(status);
  if (there && !(fs::is_directory(status) && fs::is_empty(target, error)))
    throw OutputError(folder, "there is something of this name already; name a new folder");
  FolderBeside beside(target);
  write(beside.path());
  beside.takeName();
}

}  // namespace boresight::sessions
