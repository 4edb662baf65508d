// SPDX-License-Identifier: Apache-2.0
// A person at work, for the test that kills them: scripted_edits SESSION SEED opens the session in
// the whole window, takes what an earlier one left, and then edits, undoes, runs and saves without
// end. After each action, when it is in the journal and drawn, it prints the SHA-256 of the session
// that the window shows, and the number of edits in the journal; before it undoes: "undo".
#include <cstdio>
#include <filesystem>

#include <QtWidgets>

#include "core/base/random.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_file.h"
#include "ui/window/main_window.h"

using namespace boresight;

namespace {

class Operator {
 public:
  Operator(ui::MainWindow& window, std::uint64_t seed) : window_(window), random_(seed) {}

  /// One action of a person; false when there was nothing to do.
  bool act() {
    const auto choice = random_.below(15);
    if (choice == 0) return undo();
    if (choice == 1) return window_.document().redo();
    if (choice == 2) return window_.document().save();
    if (choice == 3) return changeOptions();
    if (choice == 4) return paintMask();
    if (choice == 5) return random_.below(4) == 0 && run();
    return choice <= 8 ? annotate() : moveSeed();
  }

  /// The window is drawn as it is now before anything is confirmed.
  void confirm() {
    QCoreApplication::processEvents();
    window_.repaint();
    const std::string text =
        sessions::sessionText(window_.document().session(), window_.document().file());
    const std::filesystem::path journal = sessions::journalFileOf(window_.document().file());
    const std::size_t edits =
        std::filesystem::exists(journal)
            ? sessions::readJournal(journal, sessions::readSessionFile(window_.document().file()))
                  .edits.size()
            : 0;
    std::printf("%s %zu\n", sessions::sha256Text(text).c_str(), edits);
    std::fflush(stdout);
  }

 private:
  bool undo() {
    std::printf("undo\n");
    std::fflush(stdout);
    return window_.document().undo();
  }

  const sessions::SessionCase& shownCase() {
    return *window_.document().session().findCase(window_.cases().caseId().toStdString());
  }

  bool moveSeed() {
    Pose pose = shownCase().camera_from_station_seed;
    pose.translation_m.x() += random_.uniform(-1e-3, 1e-3);
    window_.cases().useAsSeed(pose);
    return true;
  }

  bool changeOptions() {
    LocalizerOptions options;
    options.search.enabled = false;
    options.pnp.seed = 1 + random_.below(1000);
    window_.cases().setOptions(QStringLiteral("default"), options);
    return true;
  }

  bool paintMask() {
    sessions::SessionCase session_case = shownCase();
    sessions::MaskStroke stroke;
    stroke.radius_px = random_.uniform(1.0, 9.0);
    stroke.points.emplace_back(random_.uniform(0.0, 900.0), random_.uniform(0.0, 900.0));
    session_case.ignore_strokes.push_back(stroke);
    return window_.document().edit(
        sessions::withCase(window_.document().session(), std::move(session_case)),
        QStringLiteral("Paint"));
  }

  /// Half-made pairs, whole ones, moves by keys, and now and then a pass that is put aside.
  bool annotate() {
    ui::AnnotationController& annotator = window_.annotation();
    const Eigen::Vector2d pixel(random_.uniform(0.0, 900.0), random_.uniform(0.0, 900.0));
    const auto choice = random_.below(5);
    if (choice == 0)
      return !annotator.placeOnStation(1e-4 * Eigen::Vector3d(pixel.x(), pixel.y(), 10.0)).empty();
    if (choice == 1) {
      const bool moved = annotator.nudge({0.1, 0.0});
      annotator.finishMove();
      return moved;
    }
    if (choice > 2) return !annotator.placeInImage(pixel).empty();
    if (random_.below(4) != 0 || annotator.annotations().empty()) return false;
    annotator.putAside(QStringLiteral("Ada"));
    return true;
  }

  /// A run that ends is an action, too: it is in the session when it is confirmed.
  bool run() {
    const auto rests = [this] {
      return !window_.tasks().isBusy() && !window_.store().isStoring() &&
             window_.run().state() != ui::RunState::kWorking && window_.state().currentCase();
    };
    while (!rests()) QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
    window_.cases().advance(sessions::StepUntil::kEnd);
    while (!rests()) QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
    return true;
  }

  ui::MainWindow& window_;
  Random random_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const QApplication application(argc, argv);
  QStandardPaths::setTestModeEnabled(true);
  ui::MainWindow window;
  window.setQuiet(true);
  window.show();
  if (!window.openSession(argv[1])) {
    std::fprintf(stderr, "%s\n", qPrintable(window.lastMessage()));
    return 3;
  }
  if (window.document().recovery()) window.document().acceptRecovery();
  Operator person(window, std::strtoull(argv[2], nullptr, 10));
  person.confirm();
  while (window.lastMessage().isEmpty()) {
    if (person.act()) person.confirm();
  }
  std::fprintf(stderr, "%s\n", qPrintable(window.lastMessage()));
  return 4;
}
