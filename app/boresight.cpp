// SPDX-License-Identifier: Apache-2.0
// The desktop program.
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include <QApplication>
#include <QCommandLineOption>
#include <QCommandLineParser>
#include <QTemporaryDir>

#include "app/exit_codes.h"
#include "app/plain_output.h"
#include "app/written_pages.h"
#include "ui/window/application.h"
#include "ui/window/main_window.h"
#include "ui/window/screenshot.h"
#include "ui/window/shortcut_sheet.h"

namespace boresight::app {
namespace {

/// The command line of the desktop program.
struct Arguments {
  bool self_test = false;
  ui::ScreenshotOrder screenshot;
  bool dark = false;
  std::filesystem::path documents;  ///< where pages of the manual are written, or empty
  std::vector<std::filesystem::path> files;
};

constexpr const char* kDescription =
    "Localization of a station in one image: load, run, step, see, review, export.";
constexpr const char* kFilesHelp =
    "A session, a dataset.json, results of whs evaluate, or an image, a camera (unless the image's "
    "label has one), a mesh and a seed, with transforms where their frames differ";

struct OptionRow {
  const char* name;
  const char* help;
  const char* value = nullptr;  ///< what it is called; of a flag: none
  const char* initial = nullptr;
};

constexpr OptionRow kOptions[] = {
    {"self-test", "Test the program itself without a display and print N passed, N failed"},
    {"screenshot", "Write a picture of the session's case and its run, and exit", "FILE"},
    {"view", "What the picture shows: window, image, or a dock", "NAME"},
    {"size", "Size of the window in the picture", "WxH", "1600x1000"},
    {"iteration", "Iteration that the picture shows, from 0; -1: the seed", "N"},
    {"rival", "Row under Rivals that the picture shows, from 1", "N"},
    {"mark", "Mark that somebody works on in the picture, as when placing it", "ID"},
    {"dark", "Dark colours"}};

/// For those who build packages.
QCommandLineOption documentsOption() {
  QCommandLineOption option(QStringLiteral("documents"),
                            QStringLiteral("Write pages of the manual"), QStringLiteral("DIR"));
  option.setFlags(QCommandLineOption::HiddenFromHelp);
  return option;
}

/// A whole number from `least` on.
bool readNumber(const QString& text, int least, int& number) {
  bool fine = false;
  number = text.toInt(&fine);
  return fine && number >= least;
}

bool readSize(const QString& text, ui::ScreenshotOrder& order) {
  const QStringList sides = text.split(QLatin1Char('x'));
  bool fine = sides.size() == 2;
  const int width = fine ? sides[0].toInt(&fine) : 0;
  const int height = fine ? sides[1].toInt(&fine) : 0;
  if (!fine || width < 320 || height < 240 || width > 8192 || height > 8192) return false;
  order.size = {width, height};
  return true;
}

/// False with a message when the arguments make no sense. Ends the program after --help and
/// --version, and at an option that there is not.
bool readArguments(const QCoreApplication& application, Arguments& arguments,
                   std::string& problem) {
  const QCommandLineOption documents = documentsOption();
  QCommandLineParser parser;
  parser.setApplicationDescription(QString::fromUtf8(kDescription));
  parser.addHelpOption();
  parser.addVersionOption();
  parser.addPositionalArgument(QStringLiteral("files"), QString::fromUtf8(kFilesHelp),
                               QStringLiteral("[files...]"));
  for (const OptionRow& row : kOptions)
    parser.addOption({QString::fromUtf8(row.name), QString::fromUtf8(row.help),
                      QString::fromUtf8(row.value), QString::fromUtf8(row.initial)});
  parser.addOption(documents);
  parser.process(application);
  arguments.self_test = parser.isSet(QStringLiteral("self-test"));
  arguments.dark = parser.isSet(QStringLiteral("dark"));
  arguments.documents = parser.value(documents).toStdString();
  arguments.screenshot.out = parser.value(QStringLiteral("screenshot")).toStdString();
  arguments.screenshot.view = parser.value(QStringLiteral("view"));
  arguments.screenshot.mark = parser.value(QStringLiteral("mark"));
  if (!readSize(parser.value(QStringLiteral("size")), arguments.screenshot)) {
    problem = "--size: WxH from 320x240 to 8192x8192";
    return false;
  }
  ui::ScreenshotOrder& order = arguments.screenshot;
  if (parser.isSet(QStringLiteral("iteration")) &&
      !readNumber(parser.value(QStringLiteral("iteration")), -1, order.iteration)) {
    problem = "--iteration: a number from -1";
    return false;
  }
  if (parser.isSet(QStringLiteral("rival")) &&
      !readNumber(parser.value(QStringLiteral("rival")), 1, order.rival)) {
    problem = "--rival: a number from 1";
    return false;
  }
  for (const QString& file : parser.positionalArguments())
    arguments.files.emplace_back(file.toStdString());
  if (!arguments.screenshot.out.empty() && arguments.files.size() > 1) {
    problem =
        "--screenshot takes one session (whs new makes one of files), or none for an empty "
        "window";
    return false;
  }
  return true;
}

/// Whether the command line asks for something that needs no display, so that it runs anywhere.
bool wantsNoDisplay(int count, char** values) {
  constexpr std::array<std::string_view, 6> kPlain = {"--self-test", "--help",    "-h",
                                                      "--help-all",  "--version", "-v"};
  return std::any_of(values + std::min(1, count), values + count, [&kPlain](const char* text) {
    const std::string_view value = text;
    return std::find(kPlain.begin(), kPlain.end(), value) != kPlain.end() ||
           value.starts_with("--screenshot") || value.starts_with("--documents");
  });
}

/// The manual's page of the command line.
std::string argumentsPage() {
  std::string text = std::string("# boresight on the command line\n\n") + kDescription +
                     "\n\n| argument | meaning |\n|---|---|\n| `files` | " +
                     markdownText(kFilesHelp) + " |\n";
  for (const OptionRow& row : kOptions)
    text += std::string("| `--") + row.name +
            (row.value == nullptr ? std::string() : std::string(" ") + row.value) + "` | " +
            markdownText(row.help) + " |\n";
  return text;
}

/// The manual's page of every key, as the window has them.
std::string keysPage() {
  const ui::MainWindow window;
  std::string text =
      "# Every key\n\nF1 shows them in the program.\n\n| key | what it does |\n|---|---|\n";
  for (const ui::KeyRow& row : ui::keysOf(window))
    text += "| " + markdownText(row.keys.toStdString()) + " | " +
            markdownText(row.text.toStdString()) + " |\n";
  return text;
}

int usageError(const std::string& message) {
  std::cerr << "boresight: " << message << "; see boresight --help\n";
  return kUsage;
}

int runProgram(int argc, char** argv) {
  const PlainOutput plain_errors(std::cerr);
  ui::prepareApplication(wantsNoDisplay(argc, argv));
  QApplication application(argc, argv);
  ui::nameApplication(application);
  Arguments arguments;
  std::string problem;
  if (!readArguments(application, arguments, problem)) return usageError(problem);
  if (arguments.self_test) return ui::runSelfTest(std::cout) == 0 ? kDone : kInternalFault;
  if (!arguments.documents.empty())
    return writePages(arguments.documents,
                      {{"boresight.md", argumentsPage()}, {"keys.md", keysPage()}});
  if (arguments.dark) ui::useDarkColors(application);
  ui::MainWindow window;
  if (!arguments.screenshot.out.empty()) {
    window.setQuiet(true);
    const QTemporaryDir folder;
    QString failure;
    if (!arguments.files.empty())
      failure = ui::openForPictures(window, arguments.files.front(), folder.path().toStdString());
    if (failure.isEmpty()) failure = ui::takeScreenshot(window, arguments.screenshot);
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

}  // namespace
}  // namespace boresight::app

int main(int argc, char** argv) { return boresight::app::runProgram(argc, argv); }
