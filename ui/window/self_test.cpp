// SPDX-License-Identifier: Apache-2.0
#include "ui/window/self_test.h"

#include <exception>
#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include <QTemporaryDir>

#include "sessions/run/runner.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_maker.h"
#include "ui/views/image_view.h"
#include "ui/window/main_window.h"

namespace boresight::ui {
namespace {

/// What went wrong, or "".
using Check = std::function<std::string()>;
struct NamedCheck {
  const char* name;
  Check check;
};

sessions::Session exampleSession() {
  return sessions::makeSession(sessions::examplesFolder() / "stations" / "dataset.json");
}

std::string checkRuns() {
  const sessions::Session session = exampleSession();
  for (const auto& one : session.cases) {
    const sessions::LocalizationTrace trace =
        sessions::runCase(session, one->id, sessions::RecordLevel::kSummary);
    if (!trace.converged()) return one->id + " did not converge";
  }
  return {};
}

std::string checkStepping() {
  const sessions::Session session = exampleSession();
  const auto loaded = sessions::loadCase(*session.cases.front());
  const LocalizerOptions options = sessions::caseOptions(session, *session.cases.front(), {});
  const std::string whole =
      sessions::runCase(session, *loaded, sessions::RecordLevel::kSummary).digest;
  sessions::Runner stepped(loaded->problem(), options);
  while (!stepped.finished()) stepped.advance(sessions::StepUntil::kStage);
  return stepped.trace().digest == whole ? "" : "stage by stage gave another digest";
}

std::string checkDocument() {
  const QTemporaryDir folder;
  if (!folder.isValid()) return "no temporary folder";
  const std::filesystem::path file =
      std::filesystem::path(folder.path().toStdString()) / "test.boresight.json";
  const sessions::Session session = exampleSession();
  {
    auto document = sessions::SessionDocument::create(file, session);
    document.apply(sessions::withoutCase(session, session.cases.front()->id), "Remove a case");
  }
  auto document = sessions::SessionDocument::open(file);
  if (!document.recovery()) return "an edit that was not saved is not offered";
  document.acceptRecovery();
  return document.session().cases.size() + 1 == session.cases.size() ? "" : "an edit was lost";
}

std::string checkImageView() {
  ImageView view;
  view.resize(400, 300);
  view.setImage(QImage(200, 100, QImage::Format_Grayscale8));
  view.fit();
  const QPointF pixel(12.25, 70.5);
  const QPointF back = view.transform().toPixel(view.transform().toWidget(pixel));
  return (back - pixel).manhattanLength() < 1e-9 ? "" : "pixels do not come back";
}

std::string checkWindow() {
  MainWindow window;
  window.setQuiet(true);
  window.show();
  const QImage picture = window.grab().toImage();
  return picture.isNull() ? "the window cannot be drawn" : "";
}

}  // namespace

int runSelfTest(std::ostream& output) {
  const std::vector<NamedCheck> checks = {
      {"the example stations converge", checkRuns},
      {"halting at every stage changes no bit", checkStepping},
      {"an edit survives a program that was killed", checkDocument},
      {"pixels of the image view come back", checkImageView},
      {"the window opens", checkWindow},
  };
  int failed = 0;
  for (const NamedCheck& each : checks) {
    std::string problem;
    try {
      problem = each.check();
    } catch (const std::exception& error) {
      problem = error.what();
    }
    if (!problem.empty()) ++failed;
    output << (problem.empty() ? "passed  " : "FAILED  ") << each.name
           << (problem.empty() ? "" : ": " + problem) << "\n";
  }
  output << static_cast<int>(checks.size()) - failed << " passed, " << failed << " failed\n";
  return failed;
}

}  // namespace boresight::ui
