// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "app/commands.h"
#include "sessions/baselines/methods.h"

namespace boresight::app {

/// --method and --matcher: how to localize.
struct MethodArguments {
  std::vector<std::string> methods = {sessions::kWhs};
  std::string matcher;

  /// Names that do not exist are refused with those that do.
  void addTo(CLI::App& command, bool several);
  bool needsSetup() const;
  /// With the options of the methods among `options`. InputError, CLI::ValidationError.
  sessions::MethodSetup setup(const OptionArguments& options) const;
  /// What differs from their defaults, of methods that are not WHS.
  sessions::OptionList changedOptions(const sessions::MethodOptions& options) const;
};

}  // namespace boresight::app
