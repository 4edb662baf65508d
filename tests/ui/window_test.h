// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>

#include <QtTest/QTest>
#include <QtWidgets>

#include "sessions/session/case_run.h"
#include "sessions/session/session_maker.h"
#include "tests/support/example_case.h"
#include "tests/support/temporary_folder.h"
#include "tests/ui/patience.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/window/main_window.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::test {

/// Whether a text contains a part; a failure shows the text.
inline ::testing::AssertionResult has(const QString& text, const char* part) {
  if (text.contains(QString::fromUtf8(part))) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "no '" << part << "' in: " << text.toStdString();
}

/// The example with images of half the size, which take less time, and what they allow to require;
/// made once.
inline const std::filesystem::path& smallExampleFolder() {
  static const TemporaryFolder folder;
  static const std::filesystem::path stations = [] {
    std::filesystem::copy(exampleFolder(), folder / "stations",
                          std::filesystem::copy_options::recursive);
    const QString dataset = QString::fromStdString(folder.read("stations/dataset.json"))
                                .replace(QStringLiteral("_mm\": 0.4"), QStringLiteral("_mm\": 1"))
                                .replace(QStringLiteral(": 1024"), QStringLiteral(": 512"))
                                .replace(QStringLiteral(": 1552.5"), QStringLiteral(": 776.25"))
                                .replace(QStringLiteral(": 514.65"), QStringLiteral(": 257.075"))
                                .replace(QStringLiteral(": 509.15"), QStringLiteral(": 254.325"));
    folder.write("stations/dataset.json", dataset.toStdString());
    for (const char* name : {"stations/bc/image.png", "stations/os/image.png"}) {
      const QString file = QString::fromStdString((folder / name).string());
      const QImage half = QImage(file).scaledToWidth(512, Qt::SmoothTransformation);
      EXPECT_TRUE(half.convertToFormat(QImage::Format_Grayscale8).save(file));
    }
    return folder / "stations";
  }();
  return stations;
}

/// A program whose tests need all pixels sets this before its first test.
inline bool& needsAllPixels() {
  static bool needs = false;
  return needs;
}

/// The example's two cases; read once.
inline const sessions::Session& exampleSession() {
  static const sessions::Session session = sessions::makeSession(
      (needsAllPixels() ? exampleFolder() : smallExampleFolder()) / "dataset.json");
  return session;
}

/// The session with runs from the seed alone.
inline sessions::Session withoutSearch(sessions::Session session) {
  session.options = {{"search.enabled", false}};
  return session;
}

/// The session, without a search, with the run of the example's first case, which it has; the
/// localization is done once.
inline sessions::Session withRunOfSeed(const sessions::Session& session,
                                       const std::filesystem::path& session_file) {
  const std::string& id = exampleSession().cases.front()->id;
  static const sessions::LocalizationTrace trace =
      sessions::runCase(withoutSearch(exampleSession()), id);
  const sessions::Session plain = withoutSearch(session);
  return sessions::withRun(plain, sessions::storeRun(plain, id, trace, session_file));
}

/// Settings of its own, empty before and after: tests run side by side.
class OwnSettings {
 public:
  explicit OwnSettings(const std::filesystem::path& folder) {
    QStandardPaths::setTestModeEnabled(true);
    QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope,
                       QString::fromStdString((folder / "settings").string()));
    QSettings().clear();
  }
  ~OwnSettings() { QSettings().clear(); }
};

/// The whole window, quiet, with a folder for its session.
struct WindowDesk {
  WindowDesk() {
    window.setQuiet(true);
    window.resize(1280, 800);
    window.show();
  }

  std::optional<sessions::Session> first;  ///< of a shared window: as it was opened
  TemporaryFolder folder;
  OwnSettings settings{folder.path()};
  ui::MainWindow window;
};

class WindowTest : public ::testing::Test {
 protected:
  explicit WindowTest(std::shared_ptr<WindowDesk> desk = std::make_shared<WindowDesk>())
      : desk_(std::move(desk)) {}

  static bool wait(const std::function<bool()>& holds) {
    return QTest::qWaitFor(holds, kPatienceMs);
  }
  bool resting() {
    return !window_.tasks().isBusy() && !window_.store().isStoring() &&
           window_.run().state() != ui::RunState::kWorking;
  }
  bool rests() {
    return wait([this] { return resting(); });
  }
  void open(const sessions::Session& session) {
    newFile();
    ASSERT_TRUE(window_.document().create(file_, session));
    ASSERT_TRUE(wait([this] { return window_.state().currentCase() && resting(); }));
  }
  /// Runs the shown case by its key; the session then has this number of runs.
  bool runToTheEnd(std::size_t runs) {
    QTest::keyClick(&window_, Qt::Key_F5);
    return wait([&] { return window_.document().session().runs.size() == runs && resting(); });
  }
  /// Whether this case is shown, with all that belongs to it. Until it is read, none is.
  bool showsCase(const std::string& id) {
    return wait([&] {
      const auto& shown = window_.state().currentCase();
      return shown && shown->source.id == id && resting();
    });
  }
  /// Closes the session without saving, and opens it again.
  bool reopen() {
    window_.document().close();
    return window_.openSession(file_) &&
           wait([this] { return window_.state().currentCase() && resting(); });
  }
  /// An edit as the pose panel orders it.
  void moveSeed(double x_m) {
    Pose moved = window_.state().currentCase()->source.camera_from_station_seed;
    moved.translation_m.x() += x_m;
    window_.cases().useAsSeed(moved);
  }
  /// Runs of the example take a third of the time without a search.
  void openExample(bool search = false) {
    open(search ? exampleSession() : withoutSearch(exampleSession()));
  }
  /// The example, or a session with its first case, as if the first case had been run before.
  void openRun(const sessions::Session& session = exampleSession()) {
    newFile();
    open(withRunOfSeed(session, file_));
    ASSERT_TRUE(wait([this] { return window_.state().snapshot() && resting(); }));
  }
  template <class Widget>
  Widget& find(const char* name) {
    return *window_.findChild<Widget*>(QString::fromUtf8(name));
  }
  /// As the desktop does when an operator drops a file.
  void drop(const std::filesystem::path& file) {
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(QString::fromStdString(file.string()))});
    QDragEnterEvent enter(QPoint(600, 300), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&window_, &enter);
    EXPECT_TRUE(enter.isAccepted());
    QDropEvent event(QPointF(600, 300), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QCoreApplication::sendEvent(&window_, &event);
    EXPECT_TRUE(event.isAccepted());
    QCoreApplication::processEvents();  // the files are taken after the event
  }

  /// A name for another session next to those that there are.
  void newFile() {
    for (int i = 2; std::filesystem::exists(file_); ++i)
      file_ = folder_.path() / (std::to_string(i) + ".boresight.json");
  }

  std::shared_ptr<WindowDesk> desk_;
  const TemporaryFolder& folder_ = desk_->folder;
  std::filesystem::path file_ = folder_.path() / "one.boresight.json";
  ui::MainWindow& window_ = desk_->window;
};

/// One window and one session for all tests of a suite; each begins with the session as it was
/// opened, in workspace Run.
class SharedWindowTest : public WindowTest {
 protected:
  SharedWindowTest() : WindowTest(sharedDesk()) {}
  static void TearDownTestSuite() { sharedDesk(true); }

  void SetUp() override {
    ui::Document& document = window_.document();
    while (document.canUndo()) document.undo();
    const bool as_at_first = desk_->first && document.isOpen() && !document.isModified() &&
                             document.session() == *desk_->first;
    if (!as_at_first) open(desk_->first ? *desk_->first : firstSession());
    desk_->first = document.session();
    file_ = document.file();
    ASSERT_TRUE(rests());
    const QString first_case = QString::fromStdString(desk_->first->cases.front()->id);
    if (window_.cases().caseId() != first_case) window_.cases().chooseCase(first_case);
    window_.workspaces().show(ui::Workspace::kRun);
    window_.image().view().fit();
    window_.activateWindow();
    ASSERT_TRUE(wait([&] { return window_.cases().caseId() == first_case && resting(); }));
  }
  virtual sessions::Session firstSession() { return withoutSearch(exampleSession()); }

 private:
  static std::shared_ptr<WindowDesk> sharedDesk(bool ends = false) {
    static std::shared_ptr<WindowDesk> desk;
    if (ends)
      desk.reset();
    else if (!desk)
      desk = std::make_shared<WindowDesk>();
    return desk;
  }
};

}  // namespace boresight::test
