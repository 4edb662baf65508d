// SPDX-License-Identifier: Apache-2.0
#include "ui/window/application.h"

#include <cstdio>

#include "tests/ui/window_test.h"
#include "ui/style/theme.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

/// In the look of the program, whose fonts and rows take more room than those of plain tests.
class ImageShareTest : public test::WindowTest {
 protected:
  void SetUp() override { applyTheme(*qApp, ThemeName::kLight); }
  void TearDown() override { qApp->setStyleSheet({}); }

  double shareOf(Workspace workspace, const QSize& size) {
    window_.resize(size);
    QApplication::processEvents();
    window_.workspaces().show(workspace);
    QApplication::processEvents();
    window_.image().view().fit();
    QApplication::processEvents();
    EXPECT_TRUE(wait([&] { return window_.size() == size; }))
        << workspaceInfo(workspace).name << ": panels need more room: " << window_.width() << " x "
        << window_.height() << ", at least " << window_.minimumSizeHint().width() << " x "
        << window_.minimumSizeHint().height();
    return imageShare(window_);
  }
};

TEST_F(ImageShareTest, ImageTakesItsPartOfTheScreen) {
  openRun();
  for (const auto& [size, least] :
       {std::pair(QSize(1920, 1080), 0.30), std::pair(QSize(1280, 800), 0.40)})
    for (const Workspace workspace : {Workspace::kRun, Workspace::kDiagnose, Workspace::kReview}) {
      const double share = shareOf(workspace, size);
      std::printf("%-9s %4d x %4d: %.1f %%\n", workspaceInfo(workspace).name, size.width(),
                  size.height(), 100.0 * share);
      EXPECT_GE(share, least) << workspaceInfo(workspace).name << " at " << size.width();
    }
}

}  // namespace
}  // namespace boresight::ui
