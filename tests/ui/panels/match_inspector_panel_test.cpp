// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/match_inspector_panel.h"

#include <gtest/gtest.h>
#include <QtTest/QTest>
#include <QtWidgets>

#include "tests/support/example_run.h"
#include "ui/panels/pixel_picture.h"
#include "ui/panels/score_map_view.h"
#include "ui/plots/histogram_plot.h"

namespace boresight::ui {
namespace {

class MatchInspectorPanelTest : public testing::Test {
 protected:
  MatchInspectorPanelTest() {
    panel_.resize(1200, 420);
    panel_.show();
    view_.setSnapshot(test::exampleRun());
    view_.setCursor({0, Stage::kFinished});
    table_ = panel_.findChild<QTableView*>(QStringLiteral("templates"));
    map_ = panel_.findChild<ScoreMapView*>();
  }

  void clickRow(int row) {
    const QModelIndex index = table_->model()->index(row, 1);
    table_->scrollTo(index);
    QTest::mouseClick(table_->viewport(), Qt::LeftButton, Qt::NoModifier,
                      table_->visualRect(index).center());
  }
  void choose(TemplatesModel::Show show) {
    panel_.findChild<QComboBox*>()->setCurrentIndex(static_cast<int>(show));
  }
  const Match& match(int index) const {
    return view_.iteration()->matches[static_cast<std::size_t>(index)];
  }

  ViewState view_;
  MatchInspectorPanel panel_{view_};
  QTableView* table_ = nullptr;
  ScoreMapView* map_ = nullptr;
};

TEST_F(MatchInspectorPanelTest, AClickChoosesATemplate) {
  EXPECT_EQ(view_.selectedTemplate(), -1);
  clickRow(3);
  EXPECT_EQ(view_.selectedTemplate(), 3);
  EXPECT_TRUE(panel_.findChild<QLabel*>(QStringLiteral("places"))
                  ->text()
                  .contains(QStringLiteral("Template 4")));
  for (PixelPicture* picture : panel_.findChildren<PixelPicture*>()) {
    if (picture == map_) continue;  // it comes later, in its own size
    EXPECT_EQ(picture->picture().width(), view_.iteration()->template_side_px);
  }
}

TEST_F(MatchInspectorPanelTest, AChoiceElsewhereShowsHere) {
  view_.selectTemplate(7);
  EXPECT_EQ(panel_.filter().mapToSource(table_->currentIndex()).row(), 7);
  choose(TemplatesModel::Show::kNotSearched);
  EXPECT_EQ(view_.selectedTemplate(), 7) << "a filter does not choose";
  EXPECT_FALSE(table_->currentIndex().isValid());
  choose(TemplatesModel::Show::kAll);
  EXPECT_EQ(panel_.filter().mapToSource(table_->currentIndex()).row(), 7);
}

TEST_F(MatchInspectorPanelTest, TheScoreMapComesAndIsTheLatestChosen) {
  view_.selectTemplate(1);
  view_.selectTemplate(2);
  view_.selectTemplate(5);
  ASSERT_TRUE(QTest::qWaitFor([this] { return map_->map() != nullptr; }, 20000));
  const auto expected = sessions::scoreMap(*view_.snapshot()->edges, *view_.iteration(), 5);
  ASSERT_TRUE(expected);
  EXPECT_EQ(map_->map()->counts, expected->counts);
  view_.selectTemplate(-1);
  EXPECT_EQ(map_->map(), nullptr);
}

TEST_F(MatchInspectorPanelTest, ThePeakIsTheBrightestPlaceOfTheMap) {
  view_.selectTemplate(5);
  ASSERT_TRUE(QTest::qWaitFor([this] { return map_->map() != nullptr; }, 20000));
  const WhsPeak& peak = match(5).peak;
  const SearchWindow& window = match(5).window;
  EXPECT_EQ(map_->picture().pixel(peak.x - window.x_min, peak.y - window.y_min),
            qRgb(253, 231, 37));
  const QString text = map_->textAt(map_->toWidget(peak.x, peak.y));
  EXPECT_TRUE(text.contains(
      QStringLiteral("S+/c+ = %1/%2").arg(peak.counts.edge_hits).arg(match(5).norms.edges)))
      << text.toStdString();
  EXPECT_TRUE(map_->textAt({0.0, 0.0}).isEmpty());
}

TEST_F(MatchInspectorPanelTest, ADestroyedPanelDropsWhatItAskedFor) {
  auto other = std::make_unique<MatchInspectorPanel>(view_);
  view_.selectTemplate(8);
  other.reset();
  QTest::qWait(20);
}

TEST_F(MatchInspectorPanelTest, ARefinementShowsItsEdges) {
  const auto last = static_cast<int>(view_.snapshot()->iterations.size()) - 1;
  view_.setCursor({last, Stage::kFinished});
  auto* histogram = panel_.findChild<HistogramPlot*>();
  ASSERT_TRUE(histogram->isVisible());
  EXPECT_EQ(histogram->allCount(), view_.iteration()->refinement.found_count);
  auto* table = panel_.findChild<QTableWidget*>();
  EXPECT_EQ(table->item(0, 1)->text(), QString::number(view_.iteration()->refinement.sample_count));
}

TEST_F(MatchInspectorPanelTest, SaysWhyThereIsNothing) {
  view_.setCursor({-1, Stage::kFinished});
  EXPECT_FALSE(table_->isVisible());
  view_.setCase(nullptr);
  EXPECT_FALSE(table_->isVisible());
  bool said = false;
  for (const QLabel* label : panel_.findChildren<QLabel*>())
    said |= label->isVisible() && label->text() == QStringLiteral("Nothing has run yet.");
  EXPECT_TRUE(said);
}

}  // namespace
}  // namespace boresight::ui
