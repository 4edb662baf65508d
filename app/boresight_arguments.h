// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <QCoreApplication>

#include "ui/window/screenshot.h"

namespace boresight::app {

/// The command line of the desktop program.
struct Arguments {
  bool self_test = false;
  ui::ScreenshotOrder screenshot;
  bool dark = false;
  std::filesystem::path documents;  ///< where pages of the manual are written, or empty
  std::vector<std::filesystem::path> files;
};

/// False with a message when the arguments make no sense. Ends the program after --help and
/// --version, and at an option that there is not.
bool readArguments(const QCoreApplication& application, Arguments& arguments, std::string& problem);

/// Whether the command line asks for something that needs no display, so that it runs anywhere.
bool wantsNoDisplay(int count, char** values);

/// The manual's page of the command line.
std::string argumentsPage();

}  // namespace boresight::app
