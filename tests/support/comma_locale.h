// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <clocale>
#include <cstdlib>
#include <string>

#include "tests/support/temporary_folder.h"

namespace boresight::test {

/// The program has a German locale, with decimal commas, while this lives. `localedef` compiles the
/// locale into a folder of its own, so that no package of the system needs to hold it.
class CommaLocale {
 public:
  CommaLocale() {
    const std::string file = folder_ / "de_DE.UTF-8";
    const std::string compile = "localedef -i de_DE -f UTF-8 '" + file + "' 2> /dev/null";
    if (std::system(compile.c_str()) != 0) return;
    ::setenv("LOCPATH", folder_.path().c_str(), 1);
    const char* const name = std::setlocale(LC_ALL, "de_DE.UTF-8");
    active_ = name != nullptr && *std::localeconv()->decimal_point == ',';
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  ~CommaLocale() {
    std::setlocale(LC_ALL, "C");
    ::unsetenv("LOCPATH");
  }

  /// False where the system lacks `localedef` or the locale's source.
  bool active() const { return active_; }

 private:
  TemporaryFolder folder_;
  bool active_ = false;
};

}  // namespace boresight::test
