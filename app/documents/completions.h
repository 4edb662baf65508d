// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "app/documents/program.h"

namespace boresight::documents {

// Scripts that complete the program's commands, options, choices and files in a shell.

/// For /usr/share/bash-completion/completions/NAME; needs nothing of that package.
std::string bashCompletion(const Program& program);
/// For /usr/share/zsh/vendor-completions/_NAME.
std::string zshCompletion(const Program& program);
/// For /usr/share/fish/vendor_completions.d/NAME.fish.
std::string fishCompletion(const Program& program);

}  // namespace boresight::documents
