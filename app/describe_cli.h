// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "app/documents/program.h"

namespace boresight::app {

/// What the declarations of a command line say, without what is hidden from its help.
documents::Program describe(const CLI::App& app);

}  // namespace boresight::app
