// SPDX-License-Identifier: Apache-2.0
// The window of a session in work, drawn in every workspace and size: all is in view and whole.
#include <algorithm>
#include <vector>

#include "tests/support/all_cases.h"
#include "tests/ui/window_test.h"
#include "tests/ui/workspaces/desk.h"
#include "tests/ui/workspaces/layout_faults.h"
#include "ui/review/review_panel.h"
#include "ui/style/theme.h"
#include "ui/style/tokens.h"
#include "ui/window/application.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

using test::Desk;

/// The window is made in the look of the program, as the program does.
struct Look {
  Look() { applyTheme(*qApp, ThemeName::kLight); }
  ~Look() { qApp->setStyleSheet({}); }
};

class WindowFitsTest : private Look, public test::WindowTest {
 protected:
  void openDesk(const Desk& desk) {
    open(desk.withItsRun(file_));
    ASSERT_TRUE(waitUntilResting(window_));
    ASSERT_TRUE(window_.state().snapshot());
  }

  /// What a task brings lays panels out again.
  void settle() {
    for (int round = 0; round < 2; ++round) {
      ASSERT_TRUE(waitUntilResting(window_));
      for (int i = 0; i < 4; ++i) {
        QApplication::processEvents();
        QApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
      }
    }
  }
  void resize(const QSize& size) {
    size_ = size;
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
  /// A scroll bar below a page or a table says that something is cut off.
  void expectNothingScrollsSideways(const QString& where) {
    for (const auto* area : window_.findChildren<QAbstractScrollArea*>())
      // A dock behind another's tab is visible for Qt, but outside the window.
      if (area->isVisible() && !area->visibleRegion().isEmpty() &&
          area->horizontalScrollBar()->isVisible())
        ADD_FAILURE() << where.toStdString() << ": " << area->objectName().toStdString() << " of "
                      << area->parentWidget()->metaObject()->className() << " scrolls sideways";
  }
  /// The workspace as it opens, then with each of its panels in front.
  void expectWorkspaceFits(Workspace workspace, const QString& where) {
    const WorkspaceInfo& info = workspaceInfo(workspace);
    window_.resize(size_);
    window_.workspaces().show(workspace);
    window_.workspaces().arrange();
    expectNoFaults(where);
    expectNothingScrollsSideways(where);
    for (const char* name : info.drawers) {
      QDockWidget* dock = window_.dock(QLatin1String(name));
      dock->show();
      dock->raise();
      expectNoFaults(QStringLiteral("%1, %2 in front").arg(where, QLatin1String(name)));
    }
    window_.workspaces().arrange();
  }
  void expectAllFit(const QSize& size, std::initializer_list<Workspace> workspaces) {
    resize(size);
    for (const Workspace each : workspaces)
      expectWorkspaceFits(each, QStringLiteral("%1, %2 px wide")
                                    .arg(QLatin1String(workspaceInfo(each).name))
                                    .arg(size.width()));
  }

  QSize size_;
};

constexpr auto kAll = {Workspace::kStart,    Workspace::kRun,    Workspace::kDiagnose,
                       Workspace::kAnnotate, Workspace::kReview, Workspace::kOnboard};

/// The layout is of coordinates: the colours of another theme and the pixels of a coordinate change
/// fonts at most, and what fits the least size has room in others.
TEST_F(WindowFitsTest, WorkspacesOfAReviewedCase_AreWholeAtEverySize) {
  openDesk(Desk::converged());
  window_.workspaces().show(Workspace::kReview);
  ASSERT_TRUE(waitUntilResting(window_));
  auto& review = window_.findChild<ReviewPanel*>()->controller();
  ASSERT_TRUE(review.decide(ReviewController::Act::kReject, {"A. Reviewer", "too few edges"}));
  drop(folder_.write("run.whsr", Desk::converged().record));
  ASSERT_TRUE(rests());
  ASSERT_TRUE(window_.onboard().review());
  expectAllFit({1280, 720}, kAll);
  if (window_.devicePixelRatioF() < 1.5 || test::allCases()) expectAllFit({1920, 1080}, kAll);
  if (!test::allCases()) return;
  for (const QSize& size : {QSize(1600, 900), QSize(2560, 1440)}) expectAllFit(size, kAll);
  applyTheme(*qApp, ThemeName::kDark);
  for (const QSize& size : {QSize(1280, 720), QSize(1920, 1080)}) expectAllFit(size, kAll);
}

TEST_F(WindowFitsTest, WorkspacesOfAFailedRun_AreWhole) {
  openDesk(Desk::failed());
  const auto of_run = {Workspace::kRun, Workspace::kDiagnose, Workspace::kReview};
  expectAllFit({1280, 720}, of_run);
  if (test::allCases()) expectAllFit({1920, 1080}, of_run);
}

TEST_F(WindowFitsTest, EmptyWindowIsWhole) { expectAllFit({1280, 720}, kAll); }

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

void expectOneLeftEdge(const QDockWidget& dock) {
  std::vector<const QWidget*> blocks;
  collectBlocks(*dock.widget(), blocks);
  const auto rectOf = [&dock](const QWidget* block) {
    return QRect(block->mapTo(&dock, QPoint()), block->size());
  };
  for (const QWidget* block : blocks) {
    const QRect rect = rectOf(block);
    const bool first = std::none_of(blocks.begin(), blocks.end(), [&](const QWidget* other) {
      const QRect left = rectOf(other);
      return left.right() < rect.left() && left.top() <= rect.bottom() &&
             rect.top() <= left.bottom();
    });
    const bool whole_width = rect.left() == 0 && rect.width() == dock.width();  // a picture
    if (first && !whole_width) {
      EXPECT_EQ(rect.left(), kPanelMargin)
          << dock.objectName().toStdString() << ": " << block->metaObject()->className() << " "
          << block->objectName().toStdString();
    }
  }
}

/// Panels that no workspace places are added by the menu, next to those of the workspace.
TEST_F(WindowFitsTest, AddedPanels_AreWholeWithOneLeftEdgeAndScrollInsideBelow160Pixels) {
  openDesk(Desk::converged());
  for (const QDockWidget* dock : window_.findChildren<QDockWidget*>())
    EXPECT_LE(dock->minimumSizeHint().height(), 160) << dock->objectName().toStdString();
  for (const QSize& size : {QSize(1280, 720), QSize(1920, 1080)}) {
    if (size.width() > 1280 && !test::allCases()) return;
    resize(size);
    window_.workspaces().show(Workspace::kRun);
    for (QDockWidget* dock : window_.findChildren<QDockWidget*>()) {
      window_.workspaces().arrange();
      resize(size);
      dock->show();
      dock->raise();
      expectNoFaults(QStringLiteral("%1 added at %2").arg(dock->objectName()).arg(size.width()));
      expectOneLeftEdge(*dock);
    }
  }
}

TEST_F(WindowFitsTest, ACutLabelIsFound) {
  resize({1280, 720});
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
