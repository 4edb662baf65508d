// SPDX-License-Identifier: Apache-2.0
// The desktop program.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <QApplication>
#include <QTemporaryDir>

#include "app/add_option.h"
#include "app/display.h"
#include "app/exit_codes.h"
#include "app/log_option.h"
#include "app/plain_output.h"
#include "app/written_pages.h"
#include "sessions/version.h"
#include "ui/style/theme.h"
#include "ui/window/application.h"
#include "ui/window/main_window.h"
#include "ui/window/shortcut_sheet.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::app {
namespace {

constexpr const char* kDescription =
    "Localization of a station in one image: load, run, step, see, review, export.";

constexpr int kMostRows = 100000;  ///< of iterations and hypotheses

/// The command line of the desktop program.
struct Arguments {
  bool self_test = false;
  ui::ScreenshotOrder screenshot;
  std::string theme;  ///< "": as on the last day
  std::string workspace;
  std::string out, view, size = "1600x1000", annotation;  ///< of the screenshot
  std::string documents;  ///< where pages of the manual are written, or empty
  std::vector<std::string> files;

  void addTo(CLI::App& app);
  /// CLI::ValidationError.
  void check();
};

void Arguments::addTo(CLI::App& app) {
  addFile(app, "files", files,
          "A session, a dataset.json, results of whs evaluate, or an image, a camera "
          "(unless the image's label has one), a mesh and a seed, with transforms where "
          "their frames differ");
  app.add_flag("--self-test", self_test,
               "Test the program itself without a display and print N passed, N failed");
  addFile(app, "--screenshot", out, "Write a picture of the session's case and its run, and exit");
  addOption(app, "--view", "NAME", view, "Content of the picture: window, image, or a dock");
  addOption(app, "--size", "WxH", size, "Size of the window in the picture")->capture_default_str();
  addOption(app, "--iteration", "N", screenshot.iteration,
            "Iteration in the picture, from 0; -1: the seed")
      ->check(CLI::Range(-1, kMostRows));
  addOption(app, "--hypothesis", "N", screenshot.hypothesis,
            "Row under Hypotheses in the picture, from 1")
      ->check(CLI::Range(1, kMostRows));
  addOption(app, "--annotation", "ID", annotation, "Annotation that is edited in the picture");
  addOption(app, "--workspace", "NAME", workspace,
            "Workspace in the picture, or to begin in; a picture prints the image's share of "
            "the window")
      ->check(CLI::IsMember({"start", "run", "diagnose", "annotate", "review", "onboard"},
                            CLI::ignore_case));
  addLogLevel(app);
  addChoice(app, "--theme", theme, {"light", "dark"}, "Light or dark colours");
  app.add_option("--documents", documents, "Write pages of the manual")->group("");
}

void Arguments::check() {
  int width = 0;
  int height = 0;
  char rest = 0;
  if (std::sscanf(size.c_str(), "%5dx%5d%c", &width, &height, &rest) != 2 || width < 320 ||
      height < 240 || width > 8192 || height > 8192)
    throw CLI::ValidationError("--size", "WxH from 320x240 to 8192x8192");
  screenshot.size = {width, height};
  screenshot.out = out;
  screenshot.view = QString::fromStdString(view);
  screenshot.annotation = QString::fromStdString(annotation);
  screenshot.workspace = ui::workspaceNamed(QString::fromStdString(workspace));
  if (!out.empty() && files.size() > 1)
    throw CLI::ValidationError(
        "--screenshot",
        "takes one session (whs new makes one from files), or none for an empty window");
}

/// Whether the command line requests an action that needs no display, so that it runs anywhere.
bool wantsNoDisplay(int count, char** values) {
  constexpr std::array<std::string_view, 5> kPlain = {"--self-test", "--help", "-h", "--version",
                                                      "-v"};
  return std::any_of(values + std::min(1, count), values + count, [&kPlain](const char* text) {
    const std::string_view value = text;
    return std::find(kPlain.begin(), kPlain.end(), value) != kPlain.end() ||
           value.starts_with("--screenshot") || value.starts_with("--documents");
  });
}

/// The platform that QApplication will take.
std::string platformOf(int count, char** values) {
  for (int i = 1; i + 1 < count; ++i)
    if (const std::string_view value = values[i]; value == "-platform" || value == "--platform")
      return values[i + 1];
  return qEnvironmentVariable("QT_QPA_PLATFORM").toStdString();
}

/// The manual's page of every key, as the window has them.
std::string keysPage() {
  const ui::MainWindow window;
  std::string text =
      "# Every key\n\nF1 shows them in the program.\n\n| key | action |\n|---|---|\n";
  for (const ui::KeyRow& row : ui::keysOf(window))
    text += "| " + markdownText(row.keys.toStdString()) + " | " +
            markdownText(row.text.toStdString()) + " |\n";
  return text;
}

int runProgram(int argc, char** argv) {
  const PlainOutput plain_errors(std::cerr, PlainOutput::Lines::kMessages);
  ui::prepareApplication(wantsNoDisplay(argc, argv));
  if (!displayAnswers(platformOf(argc, argv))) {
    std::cerr << "boresight: there is no display: connect with ssh -X, or use whs\n";
    return kBadInput;
  }
  QApplication application(argc, argv);
  ui::nameApplication(application);
  CLI::App app(kDescription, "boresight");
  app.set_version_flag("--version,-v", std::string("boresight ") + sessions::kVersion);
  Arguments arguments;
  arguments.addTo(app);
  try {
    app.parse(argc, argv);
    arguments.check();
  } catch (const CLI::Error& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  }
  if (arguments.self_test) return ui::runSelfTest(std::cout) == 0 ? kDone : kInternalFault;
  if (!arguments.documents.empty())
    return writePages(arguments.documents,
                      {{"boresight.md", "# boresight on the command line\n\n" + commandText(app)},
                       {"keys.md", keysPage()}});
  const bool picture = !arguments.screenshot.out.empty();
  const ui::ThemeName unstated = picture ? ui::ThemeName::kLight : ui::rememberedTheme();
  ui::applyTheme(application, arguments.theme == "dark"    ? ui::ThemeName::kDark
                              : arguments.theme == "light" ? ui::ThemeName::kLight
                                                           : unstated);
  if (!picture) beginLog("boresight");
  ui::MainWindow window;
  if (picture) {
    window.setQuiet(true);
    const QTemporaryDir folder;
    QString failure;
    if (!arguments.files.empty())
      failure = ui::openForPictures(window, arguments.files.front(), folder.path().toStdString());
    double share = 0.0;
    arguments.screenshot.share = &share;
    if (failure.isEmpty()) failure = ui::takeScreenshot(window, arguments.screenshot);
    if (failure.isEmpty()) {
      if (arguments.screenshot.workspace)
        std::printf("%s %s: the image takes %.1f %% of the window\n", arguments.workspace.c_str(),
                    arguments.size.c_str(), 100.0 * share);
      return kDone;
    }
    std::cerr << "boresight: " << failure.toStdString() << "\n";
    return kBadInput;
  }
  window.rememberLayout();
  window.show();
  if (arguments.screenshot.workspace) window.workspaces().show(*arguments.screenshot.workspace);
  if (!arguments.files.empty()) window.takeFiles({arguments.files.begin(), arguments.files.end()});
  const int exit_code = QApplication::exec();
  const bool ended = ui::endTasks();
  endLog("boresight", exit_code);
  if (ended) return exit_code;
  window.document().close();  // and its lock with it
  std::_Exit(exit_code);
}

}  // namespace
}  // namespace boresight::app

int main(int argc, char** argv) { return boresight::app::runProgram(argc, argv); }
