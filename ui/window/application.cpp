// SPDX-License-Identifier: Apache-2.0
#include "ui/window/application.h"

#include <clocale>
#include <exception>
#include <functional>
#include <ostream>
#include <string>
#include <utility>

#include <QtWidgets>

#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/run/runner.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_maker.h"
#include "sessions/version.h"
#include "ui/panels/case/trends_panel.h"
#include "ui/panels/diagnose/hypotheses_panel.h"
#include "ui/panels/diagnose/match_view.h"
#include "ui/panels/run/runs_panel.h"
#include "ui/review/queue_panel.h"
#include "ui/review/review_panel.h"
#include "ui/scene/scene_canvas.h"
#include "ui/style/icons.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/widgets/wait_box.h"
#include "ui/window/input_findings.h"
#include "ui/window/main_window.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

/// Fusion with the icons of the program. Fusion draws the frame of an empty box in a shade that a
/// dark ground swallows.
class ProgramStyle : public QProxyStyle {
 public:
  ProgramStyle() : QProxyStyle(QStyleFactory::create(QStringLiteral("Fusion"))) {}

  /// Message boxes and heads of panels have the icons of the bars, in the colours of the theme.
  QIcon standardIcon(StandardPixmap which, const QStyleOption* option,
                     const QWidget* widget) const override {
    struct Own {
      StandardPixmap which;
      Icon icon;
      QRgb Theme::*color;
    };
    static constexpr Own kOwn[] = {
        {SP_MessageBoxInformation, Icon::kInfo, &Theme::accent},
        {SP_MessageBoxQuestion, Icon::kHelp, &Theme::accent},
        {SP_MessageBoxWarning, Icon::kWarning, &Theme::warning_text},
        {SP_MessageBoxCritical, Icon::kCross, &Theme::failure_text},
        {SP_TitleBarCloseButton, Icon::kCross, &Theme::text2},
        {SP_TitleBarNormalButton, Icon::kFloat, &Theme::text2},
    };
    for (const Own& own : kOwn)
      if (own.which == which) return iconOf(own.icon, own.color);
    return QProxyStyle::standardIcon(which, option, widget);
  }

  /// Buttons of dialogs are words, as everywhere else.
  int styleHint(StyleHint hint, const QStyleOption* option, const QWidget* widget,
                QStyleHintReturn* details) const override {
    if (hint == SH_DialogButtonBox_ButtonsHaveIcons) return 0;
    return QProxyStyle::styleHint(hint, option, widget, details);
  }

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
  for (const auto& session_case : session.cases) {
    const sessions::LocalizationTrace trace =
        sessions::runCase(session, session_case->id, sessions::RecordLevel::kSummary);
    if (!trace.converged()) return session_case->id + " did not converge";
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
  if (!document.recovery()) return "an unsaved edit is not recovered";
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
  return (back - pixel).manhattanLength() < 1e-9 ? "" : "pixels are not read back";
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
  std::setlocale(LC_NUMERIC, "C");  // QApplication takes the user's: numbers keep the point
  QLocale::setDefault(QLocale::c());
  QCoreApplication::setOrganizationName(QStringLiteral("Boresight"));
  QCoreApplication::setApplicationName(QStringLiteral("boresight"));
  QCoreApplication::setApplicationVersion(QString::fromUtf8(sessions::kVersion));
  // Installed files: the desktop entry by which docks and task bars identify the window, and its
  // icon.
  QGuiApplication::setDesktopFileName(QStringLiteral("boresight"));
  QApplication::setWindowIcon(QIcon::fromTheme(QStringLiteral("boresight")));
  application.setStyle(new ProgramStyle);
}

int runSelfTest(std::ostream& output) {
  struct NamedCheck {
    const char* name;
    std::string (*problem)();  ///< "": passed
  };
  constexpr NamedCheck kChecks[] = {
      {"the example stations converge", checkRuns},
      {"pausing at every stage changes no bit", checkStepping},
      {"an edit survives a killed program", checkDocument},
      {"pixels of the image view are read back", checkImageView},
      {"the window opens", checkWindow},
  };
  int failed = 0;
  for (const NamedCheck& check : kChecks) {
    std::string problem;
    try {
      problem = check.problem();
    } catch (const std::exception& error) {
      problem = error.what();
    }
    if (!problem.empty()) ++failed;
    output << (problem.empty() ? "passed  " : "FAILED  ") << check.name
           << (problem.empty() ? "" : ": " + problem) << "\n";
  }
  output << static_cast<int>(std::size(kChecks)) - failed << " passed, " << failed << " failed\n";
  return failed;
}

namespace {

constexpr int kPatienceMs = 120'000;
/// Scale of the image around an annotation that the operator works on.
constexpr double kAnnotationScale = 2.0;

/// Lets the event loop run until something holds; false when it takes too long.
bool waitUntil(const std::function<bool()>& holds) {
  QElapsedTimer watch;
  watch.start();
  while (!holds()) {
    if (watch.elapsed() > kPatienceMs) return false;
    QEventLoop loop;
    QTimer::singleShot(20, &loop, &QEventLoop::quit);
    loop.exec();
  }
  return true;
}

bool isResting(MainWindow& window) {
  const auto* match = window.findChild<MatchView*>();
  auto* queue = window.findChild<QueuePanel*>();
  auto* review = window.findChild<ReviewPanel*>();
  const auto* trends = window.findChild<TrendsPanel*>();
  const auto* runs = window.findChild<RunsPanel*>();
  return !window.tasks().isBusy() && !window.store().isStoring() &&
         !(queue && queue->controller().isBusy()) && !(review && review->controller().isBusy()) &&
         !window.annotation().stale() && !window.findings().isBusy() &&
         !(trends && trends->isBusy()) && !(runs && runs->isBusy()) &&
         window.image().view().isDrawn() && window.run().state() != RunState::kWorking &&
         !(match && match->isComputing());
}

QWidget* widgetOf(MainWindow& window, const QString& view) {
  if (view.isEmpty() || view == QLatin1String("window")) return &window;
  if (view == QLatin1String("image")) return &window.image();
  QDockWidget* dock = window.dock(view);
  return dock ? dock->widget() : nullptr;
}

QString knownViews(const MainWindow& window) {
  QStringList names = {QStringLiteral("window"), QStringLiteral("image")};
  for (const QDockWidget* dock : window.findChildren<QDockWidget*>()) names << dock->objectName();
  return names.join(QStringLiteral(", "));
}

/// As an operator has it who places this annotation: the desk in front, the annotation magnified.
/// False when there is no such annotation.
bool workOn(MainWindow& window, const QString& annotation) {
  AnnotationController& annotator = window.annotation();
  annotator.setMode(PlaceMode::kPoint);
  annotator.select(annotation.toStdString());
  if (QDockWidget* dock = window.dock(QStringLiteral("annotation"))) dock->raise();
  const sessions::PointPair* point = annotator.selectedPoint();
  if (point && point->pixel)
    window.image().view().centreOn({point->pixel->x(), point->pixel->y()}, kAnnotationScale);
  return !annotator.selected().empty();
}

}  // namespace

bool endTasks() {
  TaskRunner::endAll();
  return waitOrLeave(nullptr,
                     QObject::tr("Boresight waits for the end of a file that is being read or "
                                 "written. Its folder may not answer."),
                     QObject::tr("Close without waiting"), &TaskRunner::allEnded);
}

double imageShare(MainWindow& window) {
  ImageView& view = window.image().view();
  if (!view.isVisible() || !window.state().currentCase()) return 0.0;
  const auto& image = window.state().currentCase()->image;
  const QPointF first = view.transform().toWidget({-0.5, -0.5});
  const QPointF last = view.transform().toWidget({image.width - 0.5, image.height - 0.5});
  const QRectF shown = QRectF(first, last).intersected(QRectF(view.rect()));
  return shown.width() * shown.height() / (1.0 * window.width() * window.height());
}

QString openForPictures(MainWindow& window, const std::filesystem::path& session,
                        const std::filesystem::path& folder) {
  try {
    const auto document = sessions::SessionDocument::open(session, sessions::Access::kReadOnly);
    const auto& recovery = document.recovery();
    if (window.document().create(folder / session.filename(),
                                 recovery ? recovery->session : document.session()))
      return {};
    return window.lastMessage();
  } catch (const std::exception& error) {
    return QString::fromUtf8(error.what());
  }
}

bool waitUntilResting(MainWindow& window) {
  return waitUntil([&window] { return isResting(window); });
}

QString takeScreenshot(MainWindow& window, const ScreenshotOrder& order) {
  QWidget* shown = widgetOf(window, order.view);
  if (!shown)
    return QObject::tr("there is no view '%1'; there are %2").arg(order.view, knownViews(window));
  window.resize(order.size);
  window.show();
  QApplication::processEvents();  // the panels are arranged
  if (QDockWidget* dock = window.dock(order.view)) {
    dock->show();
    dock->raise();
  }
  if (order.workspace) window.workspaces().show(*order.workspace);
  const auto resting = [&window] { return isResting(window); };
  // What cannot be shown or run is drawn as the window has it, with its warnings.
  const auto refused = [&window] { return !window.lastMessage().isEmpty(); };
  const bool empty = window.document().session().cases.empty();
  const auto shown_case = [&] { return empty || window.state().currentCase() || refused(); };
  if (!waitUntil([&] { return shown_case() && resting(); }))
    return QObject::tr("the session's case could not be shown");
  if (window.state().currentCase() && !window.state().snapshot()) {
    window.cases().advance(sessions::StepUntil::kEnd);
    if (!waitUntil([&] { return (window.state().snapshot() || refused()) && resting(); }))
      return QObject::tr("the run did not end");
  }
  if (order.iteration > -2) window.state().setCursor({.iteration = order.iteration});
  auto* hypotheses = window.findChild<HypothesesPanel*>();
  if (order.hypothesis > hypotheses->model().rowCount())
    return QObject::tr("the shown run has %1 competing poses, candidates and rolled hypotheses")
        .arg(hypotheses->model().rowCount());
  if (order.hypothesis > 0) hypotheses->choose(order.hypothesis - 1);
  const auto iteration = window.state().iteration();
  if (order.workspace) window.workspaces().show(*order.workspace);  // opening chose another one
  if (iteration && !iteration->templates.empty() && window.state().selectedTemplate() < 0)
    window.state().selectTemplate(0);
  window.image().view().fit();
  if (!order.annotation.isEmpty() && !workOn(window, order.annotation))
    return QObject::tr("the shown case has no annotation '%1'").arg(order.annotation);
  waitUntil(resting);
  QApplication::processEvents();
  try {
    sessions::requireWritable(order.out);
  } catch (const sessions::FileError& error) {
    return QString::fromUtf8(error.what());
  }
  if (order.share) *order.share = imageShare(window);
  const QPixmap picture = shown->grab();
  if (picture.isNull() || !picture.save(QString::fromStdString(order.out.string()), "PNG"))
    return QObject::tr("cannot write %1").arg(QString::fromStdString(order.out.string()));
  return {};
}

}  // namespace boresight::ui
