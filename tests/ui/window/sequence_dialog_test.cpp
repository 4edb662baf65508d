// SPDX-License-Identifier: Apache-2.0
#include "ui/window/sequence_dialog.h"

#include <fstream>

#include "sessions/evaluation/results_file.h"
#include "tests/support/approach_files.h"
#include "tests/ui/window_test.h"
#include "ui/views/image_view.h"
#include "ui/widgets/widgets.h"
#include "ui/window/window_frame.h"
#include "ui/workspaces/job_strip.h"

namespace boresight::ui {
namespace {

class SequenceDialogTest : public test::WindowTest {
 protected:
  void SetUp() override {
    open(test::withoutSearch(
        sessions::withCase({}, sessions::makeCase(test::approachFiles()).made)));
    find<QAction>("runSequence").trigger();
    dialog_ = window_.findChild<SequenceDialog*>();
    ASSERT_NE(dialog_, nullptr);
    dialog_->setResults(results_);
  }
  /// Runs these images to the end, or until this number of frames is there.
  void follow(const std::filesystem::path& images, int stop_at = -1) {
    dialog_->setImages(images);
    dialog_->start();
    ASSERT_TRUE(wait([&] {
      if (stop_at >= 0 && rows() >= stop_at) find<QPushButton>("sequenceCancel").click();
      return find<QPushButton>("sequenceRun").isEnabled();
    }));
  }
  int rows() const { return dialog_->table().model()->rowCount(); }
  QString cell(int row, int column) const {
    return dialog_->table().model()->index(row, column).data().toString();
  }
  QString banner() { return find<Banner>("sequenceBanner").text(); }

  std::filesystem::path results_ = folder_.path() / "approach.sqlite";
  SequenceDialog* dialog_ = nullptr;
};

TEST_F(SequenceDialogTest, Folder_GivesAStoredRowAFrame_WhichShowsItsImageAndOutline) {
  follow(test::approachFolder() / "frames");
  ASSERT_EQ(rows(), test::kApproachFrames) << banner().toStdString();
  EXPECT_TRUE(test::has(banner(), "6 of 6 frames accepted."));
  EXPECT_TRUE(test::has(find<QLabel>("sequenceProgress").text(), "6 of 6 frames; "));
  EXPECT_FALSE(dialog_->table().horizontalScrollBar()->isVisible()) << "all columns are in sight";
  for (int i = 0; i < rows(); ++i) {
    EXPECT_EQ(cell(i, 0), QString::number(i + 1));
    EXPECT_EQ(cell(i, 1), QStringLiteral("%1.png").arg(i));
    EXPECT_EQ(cell(i, 2), QStringLiteral("✓ accepted"));
  }
  EXPECT_NEAR(cell(3, 4).toDouble(), 4.4, 0.5) << "mm from one picture to the next";
  EXPECT_EQ(sessions::readResults(results_).runs.size(), 6u);
  EXPECT_TRUE(window_.document().session().runs.empty()) << "the session has no part in it";
  dialog_->table().selectRow(4);
  ASSERT_TRUE(wait([&] { return dialog_->picture().imageSize() == QSize(512, 512); }));
  const Layer& edges = dialog_->picture().layer(LayerId::kIterationEdges);
  EXPECT_FALSE(edges.empty());
  EXPECT_TRUE(edges.style.visible);
}

TEST_F(SequenceDialogTest, FieldOfResults_CanBeEmptied_UntilOtherImagesAreChosen) {
  dialog_->setImages(test::approachFolder() / "frames");
  auto& results = find<QLineEdit>("sequenceResults");
  results.setFocus();
  results.selectAll();
  QTest::keyClick(&results, Qt::Key_Delete);
  EXPECT_EQ(results.text(), QString());
  EXPECT_FALSE(find<QPushButton>("sequenceRun").isEnabled());
  QTest::keyClicks(&results, QStringLiteral("/x.sqlite"));
  EXPECT_EQ(results.text(), QStringLiteral("/x.sqlite"));
  results.selectAll();
  QTest::keyClick(&results, Qt::Key_Delete);
  dialog_->setImages(test::approachFolder() / "other");
  EXPECT_TRUE(results.text().endsWith(QStringLiteral("other.sqlite")));
}

TEST_F(SequenceDialogTest, Cancel_KeepsTheFramesAndRunGoesOn) {
  std::filesystem::create_directory(folder_.path() / "long");
  for (int i = 0; i < 12; ++i)
    std::filesystem::create_symlink(
        test::approachFolder() / ("frames/" + std::to_string(std::min(i, 5)) + ".png"),
        folder_.path() / "long" / (std::to_string(i) + ".png"));
  follow(folder_.path() / "long", 2);
  const int kept = rows();
  EXPECT_GE(kept, 2);
  EXPECT_LT(kept, 12);
  EXPECT_TRUE(test::has(banner(), "Cancelled; Run continues."));
  EXPECT_EQ(sessions::readResults(results_).runs.size(), static_cast<std::size_t>(kept));
  follow(folder_.path() / "long");
  EXPECT_EQ(rows(), 12);
  EXPECT_EQ(sessions::readResults(results_).runs.size(), 12u);
}

TEST_F(SequenceDialogTest, WhatRuns_IsInTheJobStripAndStopsThere) {
  dialog_->setImages(test::approachFolder() / "frames");
  dialog_->start();
  ASSERT_TRUE(wait([&] { return window_.frame().jobs().job().done > 0; }));
  EXPECT_EQ(window_.frame().jobs().job().name, QStringLiteral("Running a sequence"));
  EXPECT_EQ(window_.frame().jobs().job().of, 6);
  window_.frame().jobs().stop().click();
  EXPECT_TRUE(wait([&] { return find<QPushButton>("sequenceRun").isEnabled(); }));
  EXPECT_FALSE(window_.frame().jobs().job().runs);
}

TEST_F(SequenceDialogTest, BadInput_IsOneSentence) {
  std::filesystem::create_directory(folder_.path() / "empty");
  follow(folder_.path() / "empty");
  EXPECT_TRUE(test::has(banner(), "empty: has no image; images end in .png"));
  EXPECT_EQ(rows(), 0);
  follow(folder_.path() / "none");
  EXPECT_TRUE(test::has(banner(), "none: there is no such folder or file"));
  EXPECT_FALSE(std::filesystem::exists(results_));
}

TEST_F(SequenceDialogTest, FramesThatCannotBeUsed_SayWhy) {
  const auto small = folder_.path() / "small";
  std::filesystem::create_directory(small);
  sessions::writePng(small / "0.png", std::vector<std::uint8_t>(64 * 48, 9), 64, 48, 1);
  std::ofstream(small / "1.png") << "truncated";
  follow(small);
  ASSERT_EQ(rows(), 2);
  EXPECT_EQ(cell(0, 2), QStringLiteral("✗ lost"));
  EXPECT_TRUE(test::has(cell(0, 7), "is 64 x 48, but the camera is"));
  EXPECT_TRUE(test::has(cell(1, 7), "1.png: "));
  EXPECT_TRUE(test::has(banner(), "0 of 2 frames accepted, 2 lost"));
  EXPECT_TRUE(test::has(banner(), "is 64 x 48, but the camera is")) << "no row must be searched";
  dialog_->table().selectRow(1);
  ASSERT_TRUE(wait([&] { return dialog_->picture().hint().contains(QLatin1String("1.png: ")); }));
}

}  // namespace
}  // namespace boresight::ui
