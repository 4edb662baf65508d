// SPDX-License-Identifier: Apache-2.0
#include "ui/window/screenshot.h"

#include <exception>
#include <functional>

#include <QtWidgets>

#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"
#include "ui/panels/hypotheses_panel.h"
#include "ui/panels/match_view.h"
#include "ui/review/queue_panel.h"
#include "ui/review/review_panel.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/window/input_findings.h"
#include "ui/window/main_window.h"

namespace boresight::ui {
namespace {

constexpr int kPatienceMs = 120'000;
constexpr double kMarkScale = 2.0;  // of the image round a mark that somebody works on

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
  return !window.tasks().isBusy() && !(queue && queue->controller().isBusy()) &&
         !(review && review->controller().isBusy()) && !window.annotation().stale() &&
         !window.findings().isBusy() && window.run().state() != RunState::kWorking &&
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

/// As somebody has it who places this mark: the desk in front, the mark magnified. False when there
/// is no such mark.
bool workOn(MainWindow& window, const QString& mark) {
  AnnotationController& annotation = window.annotation();
  annotation.setMode(PlaceMode::kPoint);
  annotation.select(mark.toStdString());
  if (QDockWidget* dock = window.dock(QStringLiteral("annotation"))) dock->raise();
  const sessions::PointPair* point = annotation.selectedPoint();
  if (point && point->pixel)
    window.image().view().centreOn({point->pixel->x(), point->pixel->y()}, kMarkScale);
  return !annotation.selected().empty();
}

}  // namespace

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
  if (order.iteration > -2) {
    RunCursor cursor;
    cursor.iteration = order.iteration;
    window.state().setCursor(cursor);
  }
  auto* hypotheses = window.findChild<HypothesesPanel*>();
  if (order.hypothesis > hypotheses->model().rowCount())
    return QObject::tr("the shown run has %1 competing poses, candidates and rolled hypotheses")
        .arg(hypotheses->model().rowCount());
  if (order.hypothesis > 0) hypotheses->choose(order.hypothesis - 1);
  const auto* iteration = window.state().iteration();
  if (iteration && !iteration->templates.empty() && window.state().selectedTemplate() < 0)
    window.state().selectTemplate(0);
  window.image().view().fit();
  if (!order.mark.isEmpty() && !workOn(window, order.mark))
    return QObject::tr("the shown case has no mark '%1'").arg(order.mark);
  waitUntil(resting);
  QApplication::processEvents();
  try {
    sessions::requireWritable(order.out);
  } catch (const sessions::FileError& error) {
    return QString::fromUtf8(error.what());
  }
  const QPixmap picture = shown->grab();
  if (picture.isNull() || !picture.save(QString::fromStdString(order.out.string()), "PNG"))
    return QObject::tr("cannot write %1").arg(QString::fromStdString(order.out.string()));
  return {};
}

}  // namespace boresight::ui
