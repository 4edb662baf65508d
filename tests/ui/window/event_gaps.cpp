// SPDX-License-Identifier: Apache-2.0
// Longest time that the window is blocked: event_gaps DATASET CASE opens a case, runs it to the
// end, walks through its iterations, zooms with all layers shown, runs a batch, runs it again and
// stops it at once. It prints the longest times that the event loop was kept by one event, and how
// soon a stop was answered. event_gaps DATASET --cases N edits a session of N cases, two to a rig,
// with the queue and the history shown. Built by: cmake --build build/release --target event_gaps
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <QtWidgets>

#include "sessions/session/session_maker.h"
#include "tests/support/many_cases.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/window/main_window.h"
#include "ui/workspaces/workspaces.h"

using namespace boresight;

namespace {

namespace fs = std::filesystem;

/// How long the event loop was kept by one event, and by what.
struct EventGap {
  double ms = 0.0;
  double cpu_ms = 0.0;  ///< of this thread: what remains on a machine that does nothing else
  QString where;
};

double cpuTime_ms() {
  std::timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// An application that times every event that its loop delivers. While an event is handled the
/// window is blocked: the longest gap is the longest freeze.
class EventClock : public QApplication {
 public:
  using QApplication::QApplication;

  /// From now on.
  void begin() { gaps_.clear(); }
  /// The longest first.
  std::vector<EventGap> longest(std::size_t count) const {
    std::vector<EventGap> sorted = gaps_;
    std::sort(sorted.begin(), sorted.end(),
              [](const EventGap& a, const EventGap& b) { return a.ms > b.ms; });
    sorted.resize(std::min(count, sorted.size()));
    return sorted;
  }

  bool notify(QObject* receiver, QEvent* event) override {
    if (depth_ > 1) return QApplication::notify(receiver, event);
    const QString where = describe(*receiver, *event);
    if (depth_ == 0) inner_ = {};
    ++depth_;
    QElapsedTimer clock;
    clock.start();
    const double cpu_before_ms = cpuTime_ms();
    const bool taken = QApplication::notify(receiver, event);
    --depth_;
    note({static_cast<double>(clock.nsecsElapsed()) * 1e-6, cpuTime_ms() - cpu_before_ms, where});
    return taken;
  }

 private:
  static QString describe(const QObject& receiver, const QEvent& event) {
    const char* type = QMetaEnum::fromType<QEvent::Type>().valueToKey(event.type());
    return QStringLiteral("%1 '%2' %3")
        .arg(QString::fromLatin1(receiver.metaObject()->className()), receiver.objectName(),
             type ? QString::fromLatin1(type) : QString::number(event.type()));
  }

  /// What was sent while another event was handled belongs to that one.
  void note(EventGap gap) {
    if (depth_ > 0) {
      if (gap.ms > inner_.ms) inner_ = gap;
      return;
    }
    if (inner_.ms > 0.5 * gap.ms)
      gap.where +=
          QStringLiteral(", of it %1 ms in %2").arg(inner_.ms, 0, 'f', 1).arg(inner_.where);
    if (gap.ms > 1.0) gaps_.push_back(gap);
  }

  int depth_ = 0;
  EventGap inner_;
  std::vector<EventGap> gaps_;
};

void waitFor(const std::function<bool()>& holds) {
  while (!holds()) QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
}

void print(EventClock& clock, const char* what) {
  std::printf("%s\n", what);
  for (const EventGap& gap : clock.longest(5))
    std::printf("  %7.1f ms, CPU %6.1f ms  %s\n", gap.ms, gap.cpu_ms, qPrintable(gap.where));
  clock.begin();
}

/// What a person does with one case, and what each part of it kept the window from.
class Walk {
 public:
  Walk(EventClock& clock, ui::MainWindow& window) : clock_(clock), window_(window) {}

  void open(const fs::path& file, const sessions::Session& session) {
    measure("opening", [&] {
      window_.document().create(file, session);
      waitFor([this] { return window_.state().currentCase() != nullptr; });
    });
    const auto& image = window_.state().currentCase()->image;
    std::printf("%s, %d x %d\n", session.cases.front()->id.c_str(), image.width, image.height);
  }

  void run(const char* what = "running") {
    measure(what, [this] { window_.cases().advance(sessions::StepUntil::kEnd); });
  }

  void runInFrontOf(const QString& dock) {
    window_.workspaces().reveal(dock);
    run(qPrintable(QStringLiteral("running with %1 in front").arg(dock)));
  }

  void scrub() {
    measure("going through the iterations", [this] {
      const int count = static_cast<int>(window_.state().snapshot()->iterations.size());
      for (int i = -1; i < count; ++i) {
        // By an event, as from a key.
        QTimer::singleShot(0, &window_, [this, i] {
          window_.state().setCursor({i, Stage::kFinished});
        });
        QCoreApplication::processEvents();
        waitFor([this] { return rests(); });
      }
    });
  }

  /// All layers of the first iteration, which has templates and matches: shown, then zoomed.
  void zoom() {
    window_.state().setCursor({0, Stage::kFinished});
    ui::ImagePanel& image = window_.image();
    measure("showing all layers", [&] {
      for (int i = 0; i < ui::kLayerCount; ++i) {
        const auto id = static_cast<ui::LayerId>(i);
        ui::LayerStyle style = image.style(id);
        style.visible = true;
        image.setStyle(id, style);
      }
    });
    for (int i = 0; i < 24; ++i) {
      const QPointF place(0.4 * image.view().width(), 0.4 * image.view().height());
      const QPoint turn(0, i < 12 ? 120 : -120);
      auto* wheel = new QWheelEvent(place, image.view().mapToGlobal(place.toPoint()), QPoint(),
                                    turn, Qt::NoButton, Qt::NoModifier, Qt::NoScrollPhase, false);
      QCoreApplication::postEvent(&image.view(), wheel);
      QCoreApplication::processEvents();
      waitFor([&] { return rests() && image.view().isDrawn(); });
    }
    print(clock_, "zooming with all layers");
  }

  /// Further cases in the background, as other seeds of the same image.
  void batch() {
    sessions::Session session = window_.document().session();
    QStringList ids = {QString::fromStdString(session.cases.front()->id)};
    for (int i = 1; i < 4; ++i) {
      sessions::SessionCase more = *session.cases.front();
      more.id += "-" + std::to_string(i);
      more.camera_from_station_seed.translation_m.x() += 1e-3 * i;
      ids << QString::fromStdString(more.id);
      session = sessions::withCase(session, more);
    }
    window_.document().edit(session, QStringLiteral("Add cases"));
    measure("running a batch of 4", [&] {
      window_.cases().runAll(ids);
      waitFor([this] { return !window_.cases().batch(); });
    });
  }

  /// Edits of one case and of the whole session: CPU time of this thread until nothing is left to
  /// do, and in the edit itself.
  void edit() {
    window_.workspaces().show(ui::Workspace::kReview);
    for (const char* dock : {"queue", "history"}) window_.dock(QLatin1String(dock))->show();
    waitFor([this] { return rests(); });
    const auto report = [this](const char* what,
                               const std::function<void(sessions::Session&)>& change) {
      settle();
      sessions::Session session = window_.document().session();
      change(session);
      const double before_ms = cpuTime_ms();
      window_.document().edit(session, QString::fromLatin1(what));
      const double edited_ms = cpuTime_ms();
      clock_.begin();
      settle();
      std::printf("%s: CPU %.1f ms, and %.1f ms in the next second, of which at most:\n", what,
                  edited_ms - before_ms, cpuTime_ms() - edited_ms);
      for (const EventGap& gap : clock_.longest(2))
        std::printf("    CPU %6.1f ms  %s\n", gap.cpu_ms, qPrintable(gap.where));
    };
    const auto move = [](sessions::Session& session, std::size_t i) {
      const std::string id = std::as_const(session).cases[i]->id;
      session = sessions::withChanged(session, id, [](auto& changed) {
        changed.camera_from_station_seed.translation_m.y() += 1e-7;
      });
    };
    for (int i = 0; i < 3; ++i) {
      report("moving the seed of the shown case", [&](auto& session) { move(session, 0); });
      report("moving the seed of another case", [&](auto& session) { move(session, 999); });
    }
    report("changing an option", [](auto& session) {
      session.options = {{"search.enabled", false}};
    });
    report("changing a limit", [](auto& session) {
      session.review.limits = {{"check.inlier_count", 8.0}};
    });
  }

  void stop() {
    double worst_ms = 0.0;
    for (int i = 0; i < 10; ++i) {
      window_.cases().reset();
      window_.cases().advance(sessions::StepUntil::kEnd);
      QElapsedTimer running;
      running.start();
      waitFor([&] { return running.elapsed() > 40 * i || !working(); });
      if (!working()) continue;
      QElapsedTimer asked;
      asked.start();
      window_.cases().stop();
      waitFor([this] { return !working(); });
      worst_ms = std::max(worst_ms, static_cast<double>(asked.nsecsElapsed()) * 1e-6);
    }
    std::printf("a stop was answered within %.1f ms\n", worst_ms);
    print(clock_, "stopping");
  }

 private:
  bool working() { return window_.run().state() == ui::RunState::kWorking; }
  bool rests() { return !window_.tasks().isBusy() && !window_.store().isStoring() && !working(); }
  static void settle() {
    QElapsedTimer clock;
    clock.start();
    waitFor([&clock] { return clock.elapsed() > 1000; });
  }
  /// From a window at rest to a window at rest.
  void measure(const char* what, const std::function<void()>& act) {
    waitFor([this] { return rests(); });
    QCoreApplication::processEvents();
    clock_.begin();
    act();
    waitFor([this] { return rests(); });
    print(clock_, what);
  }

  EventClock& clock_;
  ui::MainWindow& window_;
};

sessions::Session inRigsOfTwo(sessions::Session session) {
  for (std::size_t i = 0; i < session.cases.size(); ++i) {
    sessions::SessionCase session_case = *std::as_const(session).cases[i];
    session_case.rig = sessions::Rig{"rig-" + std::to_string(i / 2), Pose()};
    session.cases.replace(i, session_case);
  }
  return session;
}

}  // namespace

int main(int argc, char** argv) {
  const bool many = argc == 4 && std::string_view(argv[2]) == "--cases";
  if (argc != 3 && !many) {
    std::fprintf(stderr, "event_gaps DATASET CASE | DATASET --cases N\n");
    return 2;
  }
  if (!qEnvironmentVariableIsSet("QT_QPA_PLATFORM")) qputenv("QT_QPA_PLATFORM", "offscreen");
  EventClock clock(argc, argv);
  QStandardPaths::setTestModeEnabled(true);
  const QTemporaryDir q_temporary_dir;
  const fs::path folder = q_temporary_dir.path().toStdString();
  QTimer wake;  // so that waiting ends although nothing happens
  wake.start(5);
  ui::MainWindow window;
  window.setQuiet(true);
  window.resize(1920, 1200);
  window.show();
  Walk walk(clock, window);
  if (many) {
    walk.open(folder / "many.boresight.json",
              inRigsOfTwo(test::manyCases(sessions::makeSession(argv[1]), std::atoll(argv[3]))));
    walk.edit();
    return 0;
  }
  walk.open(folder / "gaps.boresight.json", sessions::makeSession(argv[1], {argv[2]}));
  walk.run();
  for (const char* dock : {"iterations", "inspector", "scene", "review", "queue"})
    walk.runInFrontOf(QLatin1String(dock));
  walk.scrub();
  walk.zoom();
  walk.batch();
  walk.stop();
  return 0;
}
