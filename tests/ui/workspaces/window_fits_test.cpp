// SPDX-License-Identifier: Apache-2.0
// The window of a session in work, drawn in every workspace and size: all is in view and whole.
#include <algorithm>
#include <vector>

#include "core/record/record_writer.h"
#include "sessions/run/runner.h"
#include "sessions/session/case_run.h"
#include "sessions/session/session_document.h"
#include "tests/support/all_cases.h"
#include "tests/ui/window_test.h"
#include "tests/ui/workspaces/layout_faults.h"
#include "ui/review/review_panel.h"
#include "ui/style/theme.h"
#include "ui/style/tokens.h"
#include "ui/window/application.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// An example with a run of its first case, and the onboard record of the same run.
struct Desk {
  sessions::Session session;
  sessions::LocalizationTrace trace;
  Bytes record = Bytes(65536);

  explicit Desk(const char* example) {
    const auto file = std::filesystem::path(BORESIGHT_EXAMPLES) / example;
    session = sessions::SessionDocument::open(file, sessions::Access::kReadOnly).session();
    const auto loaded = sessions::loadCase(*session.cases.front());
    RecordWriter writer(record);
    sessions::RunSettings settings;
    settings.onboard_record = &writer;
    const sessions::RunPlan plan(sessions::caseOptions(session, *session.cases.front(), {}));
    trace = sessions::localize(loaded->problem(), plan, settings);
    record.resize(writer.bytes().size());
  }
  /// Annotated, and with a result.
  static const Desk& converged() {
    static const Desk desk("annotated.boresight.json");
    return desk;
  }
  static const Desk& failed() {
    static const Desk desk("turned.boresight.json");
    return desk;
  }
};

/// The window is made in the look of the program, as the program does.
struct Look {
  Look() { applyTheme(*qApp, ThemeName::kLight); }
  ~Look() { qApp->setStyleSheet({}); }
};

class WindowFitsTest : private Look, public test::WindowTest {
 protected:
  void openDesk(const Desk& desk) {
    const std::string& id = desk.session.cases.front()->id;
    open(sessions::withRun(desk.session, sessions::storeRun(desk.session, id, desk.trace, file_)));
    ASSERT_TRUE(waitUntilResting(window_));
    ASSERT_TRUE(window_.state().snapshot());
  }
  void reject() {
    window_.workspaces().show(Workspace::kReview);
    ASSERT_TRUE(waitUntilResting(window_));
    auto& review = window_.findChild<ReviewPanel*>()->controller();
    ASSERT_TRUE(review.decide(ReviewController::Act::kReject, {"A. Reviewer", "too few edges"}));
  }

  void settle() {
    for (int i = 0; i < 4; ++i) {
      QApplication::processEvents();
      QApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
    }
    ASSERT_TRUE(waitUntilResting(window_));
  }
  void resize(const QSize& size) {
    window_.resize(size);
    settle();
  }
  void expectNoFaults(const QString& where) {
    settle();
    EXPECT_EQ(window_.size(), size_) << where.toStdString() << ": panels need more room";
    const QStringList faults = test::layoutFaults(window_);
    EXPECT_TRUE(faults.isEmpty()) << where.toStdString() << ":\n"
                                  << faults.join(QLatin1Char('\n')).toStdString();
  }
  /// The workspace as it opens, then with each of its panels in front.
  void expectWorkspaceFits(Workspace workspace, const QString& where) {
    const WorkspaceInfo& info = workspaceInfo(workspace);
    window_.resize(size_);
    window_.workspaces().show(workspace);
    window_.workspaces().arrange();
    expectNoFaults(where);
    EXPECT_FALSE(window_.grab().isNull());
    for (const char* name : info.drawers) {
      QDockWidget* dock = window_.dock(QLatin1String(name));
      dock->show();
      dock->raise();
      expectNoFaults(QStringLiteral("%1, %2 in front").arg(where, QLatin1String(name)));
    }
    window_.workspaces().arrange();
  }
  void expectAllFit(const QSize& size, std::initializer_list<Workspace> workspaces) {
    size_ = size;
    resize(size);
    for (const Workspace each : workspaces)
      expectWorkspaceFits(each, QStringLiteral("%1 at %2 x %3")
                                    .arg(QLatin1String(workspaceInfo(each).name))
                                    .arg(size.width())
                                    .arg(size.height()));
  }

  QSize size_;
};

constexpr auto kAll = {Workspace::kStart,    Workspace::kRun,    Workspace::kDiagnose,
                       Workspace::kAnnotate, Workspace::kReview, Workspace::kOnboard};

class ThemedWindowFitsTest : public WindowFitsTest,
                             public ::testing::WithParamInterface<ThemeName> {};

TEST_P(ThemedWindowFitsTest, WorkspacesOfAReviewedCase_AreWholeAtEverySize) {
  applyTheme(*qApp, GetParam());
  openDesk(Desk::converged());
  reject();
  drop(folder_.write("run.whsr", Desk::converged().record));
  ASSERT_TRUE(rests());
  ASSERT_TRUE(window_.onboard().review());
  // The layout is of coordinates: colours and the pixels of a coordinate change fonts at most, and
  // what fits the least size has room in others.
  const bool light = GetParam() == ThemeName::kLight && window_.devicePixelRatioF() < 1.5;
  expectAllFit({1280, 720}, kAll);
  if (light || test::allCases()) expectAllFit({1920, 1080}, kAll);
  if (light && test::allCases())
    for (const QSize& size : {QSize(1600, 900), QSize(2560, 1440)}) expectAllFit(size, kAll);
}

INSTANTIATE_TEST_SUITE_P(Themes, ThemedWindowFitsTest,
                         ::testing::Values(ThemeName::kLight, ThemeName::kDark),
                         [](const auto& info) {
                           return info.param == ThemeName::kLight ? "light" : "dark";
                         });

TEST_F(WindowFitsTest, WorkspacesOfAFailedRun_AreWhole) {
  openDesk(Desk::failed());
  for (const QSize& size : {QSize(1280, 720), QSize(1920, 1080)})
    expectAllFit(size, {Workspace::kRun, Workspace::kDiagnose, Workspace::kReview});
}

TEST_F(WindowFitsTest, EmptyWindowIsWhole) { expectAllFit({1280, 720}, kAll); }

/// Panels that no workspace places are added by the menu, next to those of the workspace.
TEST_F(WindowFitsTest, AddedPanelsAreWhole) {
  openDesk(Desk::converged());
  for (const QSize& size : {QSize(1280, 720), QSize(1920, 1080)}) {
    size_ = size;
    resize(size);
    window_.workspaces().show(Workspace::kRun);
    for (QDockWidget* dock : window_.findChildren<QDockWidget*>()) {
      window_.workspaces().arrange();
      resize(size);
      dock->show();
      dock->raise();
      expectNoFaults(QStringLiteral("%1 added at %2").arg(dock->objectName()).arg(size.width()));
    }
  }
}

/// The widgets that the layouts of a panel place, without those that only hold others.
void collectBlocks(const QWidget& holder, std::vector<const QWidget*>& blocks) {
  const auto* area = qobject_cast<const QScrollArea*>(&holder);
  const QObjectList children = area ? QObjectList{area->widget()} : holder.children();
  for (QObject* child : children) {
    const auto* widget = qobject_cast<const QWidget*>(child);
    if (!widget || !widget->isVisible() || qobject_cast<const QSplitterHandle*>(widget)) continue;
    const auto* frame = qobject_cast<const QFrame*>(widget);
    const bool framed = (frame && frame->frameShape() != QFrame::NoFrame) ||
                        widget->property("card").toBool() || qobject_cast<const QGroupBox*>(widget);
    const bool holds = qobject_cast<const QSplitter*>(widget) ||
                       qobject_cast<const QStackedWidget*>(widget) ||
                       qobject_cast<const QScrollArea*>(widget) || (widget->layout() && !framed);
    if (holds)
      collectBlocks(*widget, blocks);
    else
      blocks.push_back(widget);
  }
}

TEST_F(WindowFitsTest, PanelsHaveOneLeftEdge) {
  openDesk(Desk::converged());
  for (QDockWidget* dock : window_.findChildren<QDockWidget*>()) {
    window_.workspaces().arrange();
    dock->show();
    dock->raise();
    settle();
    std::vector<const QWidget*> blocks;
    collectBlocks(*dock->widget(), blocks);
    const auto rectOf = [dock](const QWidget* block) {
      return QRect(block->mapTo(dock, QPoint()), block->size());
    };
    for (const QWidget* block : blocks) {
      const QRect rect = rectOf(block);
      const bool first = std::none_of(blocks.begin(), blocks.end(), [&](const QWidget* other) {
        const QRect left = rectOf(other);
        return left.right() < rect.left() && left.top() <= rect.bottom() &&
               rect.top() <= left.bottom();
      });
      const bool whole_width = rect.left() == 0 && rect.width() == dock->width();  // a picture
      if (first && !whole_width) {
        EXPECT_EQ(rect.left(), kPanelMargin)
            << dock->objectName().toStdString() << ": " << block->metaObject()->className() << " "
            << block->objectName().toStdString();
      }
    }
  }
}

TEST_F(WindowFitsTest, PanelsScrollInsideBelow160Pixels) {
  openDesk(Desk::converged());
  constexpr int kLeastHeight = 160;
  for (const QDockWidget* dock : window_.findChildren<QDockWidget*>())
    EXPECT_LE(dock->minimumSizeHint().height(), kLeastHeight) << dock->objectName().toStdString();
}

TEST_F(WindowFitsTest, ACutLabelIsFound) {
  size_ = QSize(1280, 720);
  resize(size_);
  QLabel label(QStringLiteral("12.4 mm, 3.1 mrad"), window_.centralWidget());
  label.resize(label.sizeHint());
  label.show();
  const auto faults = [this] { return test::layoutFaults(window_).join(QLatin1Char('\n')); };
  EXPECT_FALSE(test::has(faults(), "12.4 mm"));
  label.resize(label.sizeHint() - QSize(4, 0));
  EXPECT_TRUE(test::has(faults(), "12.4 mm"));
  label.resize(label.sizeHint());
  label.move(window_.centralWidget()->width() - 10, 0);
  EXPECT_TRUE(test::has(faults(), "outside"));
}

}  // namespace
}  // namespace boresight::ui
