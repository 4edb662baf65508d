// SPDX-License-Identifier: Apache-2.0
// The desktop program.
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <QApplication>
#include <QCommandLineParser>
#include <QTemporaryDir>

#include "app/exit_codes.h"
#include "sessions/version.h"
#include "ui/window/application.h"
#include "ui/window/main_window.h"
#include "ui/window/screenshot.h"
#include "ui/window/self_test.h"

namespace {

using namespace boresight::app;

struct Arguments {
  bool self_test = false;
  boresight::ui::ScreenshotOrder screenshot;
  bool dark = false;
  std::vector<std::filesystem::path> files;
};

int usageError(const std::string& message) {
  std::cerr << "boresight: " << message << "; see boresight --help\n";
  return kUsage;
}

/// False with a message when the arguments make no sense.
bool readArguments(const QCoreApplication& application, Arguments& arguments,
                   std::string& problem) {
  QCommandLineParser parser;
  parser.setApplicationDescription(QStringLiteral(
      "Localization of a station in one image: load, run, step, see, review, export."));
  parser.addHelpOption();
  parser.addVersionOption();
  parser.addPositionalArgument(
      QStringLiteral("files"),
      QStringLiteral(
          "A session, a dataset.json, results of whs evaluate, or an image, a camera, a mesh and "
          "a seed"),
      QStringLiteral("[files...]"));
  const QCommandLineOption self_test(
      QStringLiteral("self-test"),
      QStringLiteral("Test the program itself without a display and print N passed, N failed"));
  const QCommandLineOption screenshot(
      QStringLiteral("screenshot"),
      QStringLiteral("Write a picture of the session's case and its run, and exit"),
      QStringLiteral("file.png"));
  const QCommandLineOption view(QStringLiteral("view"),
                                QStringLiteral("What the picture shows: window, image, or a dock"),
                                QStringLiteral("name"));
  const QCommandLineOption size(QStringLiteral("size"),
                                QStringLiteral("Size of the window in the picture"),
                                QStringLiteral("WxH"), QStringLiteral("1600x1000"));
  const QCommandLineOption iteration(
      QStringLiteral("iteration"),
      QStringLiteral("Iteration that the picture shows, from 0; -1: the seed"),
      QStringLiteral("N"));
  const QCommandLineOption rival(QStringLiteral("rival"),
                                 QStringLiteral("Row under Rivals that the picture shows, from 1"),
                                 QStringLiteral("N"));
  const QCommandLineOption dark(QStringLiteral("dark"), QStringLiteral("Dark colours"));
  const QCommandLineOption mark(
      QStringLiteral("mark"),
      QStringLiteral("Mark that somebody works on in the picture, as when placing it"),
      QStringLiteral("ID"));
  parser.addOptions({self_test, screenshot, view, size, iteration, rival, mark, dark});
  parser.process(application);
  arguments.self_test = parser.isSet(self_test);
  arguments.dark = parser.isSet(dark);
  arguments.screenshot.out = parser.value(screenshot).toStdString();
  arguments.screenshot.view = parser.value(view);
  arguments.screenshot.mark = parser.value(mark);
  const QStringList sides = parser.value(size).split(QLatin1Char('x'));
  bool fine = sides.size() == 2;
  const int width = fine ? sides[0].toInt(&fine) : 0;
  const int height = fine ? sides[1].toInt(&fine) : 0;
  if (!fine || width < 320 || height < 240 || width > 8192 || height > 8192) {
    problem = "--size: WxH from 320x240 to 8192x8192";
    return false;
  }
  arguments.screenshot.size = {width, height};
  if (parser.isSet(iteration)) {
    arguments.screenshot.iteration = parser.value(iteration).toInt(&fine);
    if (!fine || arguments.screenshot.iteration < -1) {
      problem = "--iteration: a number from -1";
      return false;
    }
  }
  if (parser.isSet(rival)) {
    arguments.screenshot.rival = parser.value(rival).toInt(&fine);
    if (!fine || arguments.screenshot.rival < 1) {
      problem = "--rival: a number from 1";
      return false;
    }
  }
  for (const QString& file : parser.positionalArguments())
    arguments.files.emplace_back(file.toStdString());
  if (!arguments.screenshot.out.empty() && arguments.files.size() > 1) {
    problem = "--screenshot takes one session, or none for an empty window";
    return false;
  }
  return true;
}

/// These two need no display, so that they run anywhere.
bool wantsNoDisplay(int count, char** values) {
  for (int i = 1; i < count; ++i) {
    const std::string value = values[i];
    if (value == "--self-test" || value.rfind("--screenshot", 0) == 0) return true;
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  boresight::ui::prepareApplication(wantsNoDisplay(argc, argv));
  QApplication application(argc, argv);
  boresight::ui::nameApplication(application);
  Arguments arguments;
  std::string problem;
  if (!readArguments(application, arguments, problem)) return usageError(problem);
  if (arguments.self_test)
    return boresight::ui::runSelfTest(std::cout) == 0 ? kDone : kInternalFault;
  if (arguments.dark) boresight::ui::useDarkColors(application);
  boresight::ui::MainWindow window;
  if (!arguments.screenshot.out.empty()) {
    window.setQuiet(true);
    const QTemporaryDir folder;
    QString failure;
    if (!arguments.files.empty())
      failure = boresight::ui::openForPictures(window, arguments.files.front(),
                                               folder.path().toStdString());
    if (failure.isEmpty()) failure = boresight::ui::takeScreenshot(window, arguments.screenshot);
    if (failure.isEmpty()) return kDone;
    std::cerr << "boresight: " << failure.toStdString() << "\n";
    return kBadInput;
  }
  window.rememberLayout();
  window.show();
  if (!arguments.files.empty()) {
    window.takeFiles(arguments.files);
  } else {
    window.offerLeftSessions();
  }
  return QApplication::exec();
}
