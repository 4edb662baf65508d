// SPDX-License-Identifier: Apache-2.0
// The desktop program.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include <QApplication>
#include <QTemporaryDir>

#include "app/boresight_arguments.h"
#include "app/documents/manual_folder.h"
#include "app/exit_codes.h"
#include "app/plain_output.h"
#include "ui/window/application.h"
#include "ui/window/main_window.h"
#include "ui/window/screenshot.h"
#include "ui/window/self_test.h"
#include "ui/window/shortcut_sheet.h"

namespace {

using namespace boresight::app;

/// The manual's page of every key, as the window has them.
std::string keysPage() {
  const boresight::ui::MainWindow window;
  std::string text =
      "# Every key\n\nF1 shows them in the program.\n\n| key | what it does |\n|---|---|\n";
  for (const boresight::ui::KeyRow& row : boresight::ui::keysOf(window))
    text += "| " + boresight::documents::markdownText(row.keys.toStdString()) + " | " +
            boresight::documents::markdownText(row.text.toStdString()) + " |\n";
  return text;
}

int usageError(const std::string& message) {
  std::cerr << "boresight: " << message << "; see boresight --help\n";
  return kUsage;
}

/// The pages of the manual that this program writes.
int writePages(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::ofstream arguments(folder / "boresight.md");
  std::ofstream keys(folder / "keys.md");
  arguments << argumentsPage();
  if (keys) keys << keysPage();  // made from a window: not where it cannot be written
  arguments.close();
  keys.close();
  if (arguments && keys) return kDone;
  std::cerr << "boresight: " << folder.string() << ": pages cannot be written there\n";
  return kBadInput;
}

}  // namespace

int main(int argc, char** argv) {
  const PlainOutput plain_errors(std::cerr);
  boresight::ui::prepareApplication(wantsNoDisplay(argc, argv));
  QApplication application(argc, argv);
  boresight::ui::nameApplication(application);
  Arguments arguments;
  std::string problem;
  if (!readArguments(application, arguments, problem)) return usageError(problem);
  if (arguments.self_test)
    return boresight::ui::runSelfTest(std::cout) == 0 ? kDone : kInternalFault;
  if (!arguments.documents.empty()) return writePages(arguments.documents);
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
