// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>

#include <QtTest/QTest>
#include <QtWidgets>

#include "sessions/session/session_maker.h"
#include "tests/support/example_case.h"
#include "tests/support/temporary_folder.h"
#include "tests/ui/patience.h"
#include "ui/window/main_window.h"

namespace boresight::test {

/// Whether a text contains a part; a failure shows the text.
inline ::testing::AssertionResult has(const QString& text, const char* part) {
  if (text.contains(QString::fromUtf8(part))) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "no '" << part << "' in: " << text.toStdString();
}

/// The session with runs from the seed alone.
inline sessions::Session withoutSearch(sessions::Session session) {
  session.options = {{"search.enabled", false}};
  return session;
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
class WindowTest : public ::testing::Test {
 protected:
  WindowTest() {
    window_.setQuiet(true);
    window_.resize(1280, 800);
    window_.show();
  }

  static bool wait(const std::function<bool()>& holds) {
    return QTest::qWaitFor(holds, kPatienceMs);
  }
  bool resting() {
    return !window_.tasks().isBusy() && window_.run().state() != ui::RunState::kWorking;
  }
  bool rests() {
    return wait([this] { return resting(); });
  }
  void open(const sessions::Session& session) {
    ASSERT_TRUE(window_.document().create(file_, session));
    ASSERT_TRUE(wait([this] { return window_.state().currentCase() && resting(); }));
  }
  /// Runs the shown case by its key; the session then has this number of runs.
  bool runToTheEnd(std::size_t runs) {
    QTest::keyClick(&window_, Qt::Key_F5);
    return wait([&] { return window_.document().session().runs.size() == runs && resting(); });
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
    const sessions::Session session = sessions::makeSession(exampleFolder() / "dataset.json");
    open(search ? session : withoutSearch(session));
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
  }

  TemporaryFolder folder_;
  OwnSettings settings_{folder_.path()};
  std::filesystem::path file_ = folder_.path() / "one.boresight.json";
  ui::MainWindow window_;
};

}  // namespace boresight::test
