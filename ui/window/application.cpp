// SPDX-License-Identifier: Apache-2.0
#include "ui/window/application.h"

#include <exception>
#include <filesystem>
#include <ostream>
#include <string>

#include <QtWidgets>

#include "sessions/run/runner.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_maker.h"
#include "sessions/version.h"
#include "ui/scene/scene_canvas.h"
#include "ui/views/image_view.h"
#include "ui/window/main_window.h"

namespace boresight::ui {
namespace {

/// Fusion draws the frame of an empty box in a shade that a dark ground swallows.
class VisibleBoxes : public QProxyStyle {
 public:
  VisibleBoxes() : QProxyStyle(QStyleFactory::create(QStringLiteral("Fusion"))) {}

  void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override {
    QProxyStyle::drawPrimitive(element, option, painter, widget);
    if (element != PE_IndicatorCheckBox) return;
    QColor frame = option->palette.color(QPalette::Text);
    frame.setAlpha(150);
    painter->save();
    painter->setPen(frame);
    painter->setBrush(Qt::NoBrush);
    painter->drawRect(option->rect.adjusted(0, 0, -1, -1));
    painter->restore();
  }
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

void prepareApplication(bool without_display) {
#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
  QCoreApplication::setAttribute(Qt::AA_EnableHighDpiScaling);
  QCoreApplication::setAttribute(Qt::AA_UseHighDpiPixmaps);
#endif
  prepareSceneSurface();
  if (!qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM")) return;
  qputenv("QT_QPA_PLATFORM", without_display ? "offscreen" : "xcb");
}

void nameApplication(QApplication& application) {
  QCoreApplication::setOrganizationName(QStringLiteral("Boresight"));
  QCoreApplication::setApplicationName(QStringLiteral("boresight"));
  QCoreApplication::setApplicationVersion(QString::fromUtf8(sessions::kVersion));
  // What is installed: the entry that docks and task bars know the window by, and its icon.
  QGuiApplication::setDesktopFileName(QStringLiteral("boresight"));
  QApplication::setWindowIcon(QIcon::fromTheme(QStringLiteral("boresight")));
  application.setStyle(new VisibleBoxes);
}

void useDarkColors(QApplication& application) {
  QPalette dark;
  const QColor ground(45, 46, 48);
  const QColor base(32, 33, 35);
  const QColor text(225, 226, 228);
  dark.setColor(QPalette::Window, ground);
  dark.setColor(QPalette::WindowText, text);
  dark.setColor(QPalette::Base, base);
  dark.setColor(QPalette::AlternateBase, QColor(40, 41, 44));
  dark.setColor(QPalette::ToolTipBase, ground);
  dark.setColor(QPalette::ToolTipText, text);
  dark.setColor(QPalette::Text, text);
  dark.setColor(QPalette::Button, ground);
  dark.setColor(QPalette::ButtonText, text);
  dark.setColor(QPalette::BrightText, QColor(255, 255, 255));
  dark.setColor(QPalette::Link, QColor(95, 165, 255));
  dark.setColor(QPalette::Highlight, QColor(60, 120, 215));
  dark.setColor(QPalette::HighlightedText, QColor(255, 255, 255));
  dark.setColor(QPalette::Light, QColor(70, 71, 74));
  dark.setColor(QPalette::Midlight, QColor(58, 59, 62));
  dark.setColor(QPalette::Mid, QColor(38, 39, 41));
  dark.setColor(QPalette::Dark, QColor(24, 25, 27));
  for (const QPalette::ColorRole role :
       {QPalette::WindowText, QPalette::Text, QPalette::ButtonText, QPalette::Link})
    dark.setColor(QPalette::Disabled, role, QColor(125, 126, 128));
  application.setPalette(dark);
}

int runSelfTest(std::ostream& output) {
  struct NamedCheck {
    const char* name;
    std::string (*check)();  ///< what went wrong, or ""
  };
  constexpr NamedCheck kChecks[] = {
      {"the example stations converge", checkRuns},
      {"halting at every stage changes no bit", checkStepping},
      {"an edit survives a program that was killed", checkDocument},
      {"pixels of the image view come back", checkImageView},
      {"the window opens", checkWindow},
  };
  int failed = 0;
  for (const NamedCheck& each : kChecks) {
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
  output << static_cast<int>(std::size(kChecks)) - failed << " passed, " << failed << " failed\n";
  return failed;
}

}  // namespace boresight::ui
