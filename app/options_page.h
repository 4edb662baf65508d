// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "sessions/io/option_value.h"

namespace boresight::app {

/// "0 .. 10", or the choices.
std::string rangeText(const sessions::OptionDescription& option);

/// The manual's page of every option: of a run, of the methods beside WHS, and the limits of the
/// checks, as they are declared, with their values in each profile and preset.
std::string optionsPage();

}  // namespace boresight::app
