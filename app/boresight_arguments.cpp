// SPDX-License-Identifier: Apache-2.0
#include "app/boresight_arguments.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <QCommandLineOption>
#include <QCommandLineParser>

#include "app/documents/manual_folder.h"

namespace boresight::app {
namespace {

constexpr const char* kDescription =
    "Localization of a station in one image: load, run, step, see, review, export.";
constexpr const char* kFilesHelp =
    "A session, a dataset.json, results of whs evaluate, or an image, a camera (unless the image's "
    "label has one), a mesh and a seed, with transforms where their frames differ";

struct Options {
  QCommandLineOption self_test{
      QStringLiteral("self-test"),
      QStringLiteral("Test the program itself without a display and print N passed, N failed")};
  QCommandLineOption screenshot{
      QStringLiteral("screenshot"),
      QStringLiteral("Write a picture of the session's case and its run, and exit"),
      QStringLiteral("FILE")};
  QCommandLineOption view{QStringLiteral("view"),
                          QStringLiteral("What the picture shows: window, image, or a dock"),
                          QStringLiteral("NAME")};
  QCommandLineOption size{QStringLiteral("size"),
                          QStringLiteral("Size of the window in the picture"),
                          QStringLiteral("WxH"), QStringLiteral("1600x1000")};
  QCommandLineOption iteration{
      QStringLiteral("iteration"),
      QStringLiteral("Iteration that the picture shows, from 0; -1: the seed"),
      QStringLiteral("N")};
  QCommandLineOption rival{QStringLiteral("rival"),
                           QStringLiteral("Row under Rivals that the picture shows, from 1"),
                           QStringLiteral("N")};
  QCommandLineOption mark{
      QStringLiteral("mark"),
      QStringLiteral("Mark that somebody works on in the picture, as when placing it"),
      QStringLiteral("ID")};
  QCommandLineOption dark{QStringLiteral("dark"), QStringLiteral("Dark colours")};

  QList<QCommandLineOption> shown() const {
    return {self_test, screenshot, view, size, iteration, rival, mark, dark};
  }
};

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

}  // namespace

bool readArguments(const QCoreApplication& application, Arguments& arguments,
                   std::string& problem) {
  const Options options;
  const QCommandLineOption documents = documentsOption();
  QCommandLineParser parser;
  parser.setApplicationDescription(QString::fromUtf8(kDescription));
  parser.addHelpOption();
  parser.addVersionOption();
  parser.addPositionalArgument(QStringLiteral("files"), QString::fromUtf8(kFilesHelp),
                               QStringLiteral("[files...]"));
  parser.addOptions(options.shown());
  parser.addOption(documents);
  parser.process(application);
  arguments.self_test = parser.isSet(options.self_test);
  arguments.dark = parser.isSet(options.dark);
  arguments.documents = parser.value(documents).toStdString();
  arguments.screenshot.out = parser.value(options.screenshot).toStdString();
  arguments.screenshot.view = parser.value(options.view);
  arguments.screenshot.mark = parser.value(options.mark);
  if (!readSize(parser.value(options.size), arguments.screenshot)) {
    problem = "--size: WxH from 320x240 to 8192x8192";
    return false;
  }
  ui::ScreenshotOrder& order = arguments.screenshot;
  if (parser.isSet(options.iteration) &&
      !readNumber(parser.value(options.iteration), -1, order.iteration)) {
    problem = "--iteration: a number from -1";
    return false;
  }
  if (parser.isSet(options.rival) && !readNumber(parser.value(options.rival), 1, order.rival)) {
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

bool wantsNoDisplay(int count, char** values) {
  constexpr std::array<std::string_view, 6> kPlain = {"--self-test", "--help",    "-h",
                                                      "--help-all",  "--version", "-v"};
  return std::any_of(values + std::min(1, count), values + count, [&kPlain](const char* text) {
    const std::string_view value = text;
    return std::find(kPlain.begin(), kPlain.end(), value) != kPlain.end() ||
           value.starts_with("--screenshot") || value.starts_with("--documents");
  });
}

std::string argumentsPage() {
  using documents::markdownText;
  std::string text = std::string("# boresight on the command line\n\n") + kDescription +
                     "\n\n| argument | meaning |\n|---|---|\n| `files` | " +
                     markdownText(kFilesHelp) + " |\n";
  for (const QCommandLineOption& option : Options().shown()) {
    const QStringList words = {QStringLiteral("--") + option.names().front(), option.valueName()};
    text += "| `" + words.join(QLatin1Char(' ')).trimmed().toStdString() + "` | " +
            markdownText(option.description().toStdString()) + " |\n";
  }
  return text;
}

}  // namespace boresight::app
