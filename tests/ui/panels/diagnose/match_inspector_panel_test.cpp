// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/diagnose/match_inspector_panel.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <QtTest/QTest>
#include <QtWidgets>

#include "tests/support/example_run.h"
#include "tests/ui/models/tested_model.h"
#include "ui/panels/diagnose/match_view.h"
#include "ui/panels/diagnose/pixel_picture.h"
#include "ui/plots/plot_colors.h"
#include "ui/plots/plots.h"

namespace boresight::ui {
namespace {

using Show = TemplatesModel::Show;

class MatchInspectorPanelTest : public testing::Test {
 protected:
  MatchInspectorPanelTest() {
    panel_.resize(1200, 420);
    panel_.show();
    view_.setSnapshot(test::exampleRun());
    view_.setCursor({0, Stage::kFinished});
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

  ViewState view_;
  MatchInspectorPanel panel_{view_};
  QTableView* table_ = panel_.findChild<QTableView*>(QStringLiteral("templates"));
  ScoreMapView* map_ = panel_.findChild<ScoreMapView*>();
};

TEST_F(MatchInspectorPanelTest, AClickChoosesATemplate) {
  EXPECT_EQ(view_.selectedTemplate(), -1);
  clickRow(3);
  EXPECT_EQ(view_.selectedTemplate(), 3);
  const auto* places = panel_.findChild<QLabel*>(QStringLiteral("places"));
  EXPECT_TRUE(places->text().contains(QStringLiteral("Template 4")));
  for (PixelPicture* picture : panel_.findChildren<PixelPicture*>()) {
    if (picture == map_) continue;  // it comes later, in its own size
    EXPECT_EQ(picture->picture().width(), view_.iteration()->template_side_px);
  }
}

TEST_F(MatchInspectorPanelTest, SelectionInAnotherView_IsShown) {
  view_.selectTemplate(7);
  EXPECT_EQ(panel_.filter().mapToSource(table_->currentIndex()).row(), 7);
  choose(TemplatesModel::Show::kNotSearched);
  EXPECT_EQ(view_.selectedTemplate(), 7) << "a filter does not choose";
  EXPECT_FALSE(table_->currentIndex().isValid());
  choose(TemplatesModel::Show::kAll);
  EXPECT_EQ(panel_.filter().mapToSource(table_->currentIndex()).row(), 7);
}

TEST_F(MatchInspectorPanelTest, TheScoreMapIsOfTheLatestChosen_ItsPeakIsTheBrightestPlace) {
  for (const int chosen : {1, 2, 5}) view_.selectTemplate(chosen);
  ASSERT_TRUE(QTest::qWaitFor([this] { return map_->map() != nullptr; }, 20000));
  const auto expected = sessions::scoreMap(*view_.snapshot()->edges, *view_.iteration(), 5);
  ASSERT_TRUE(expected);
  EXPECT_EQ(map_->map()->counts, expected->counts);
  const Match& match = view_.iteration()->matches[5];
  const WhsPeak& peak = match.peak;
  EXPECT_EQ(map_->picture().pixel(peak.x - match.window.x_min, peak.y - match.window.y_min),
            qRgb(253, 231, 37));
  const QString text = map_->textAt(map_->toWidget(peak.x, peak.y));
  EXPECT_TRUE(text.contains(
      QStringLiteral("S+/c+ = %1/%2").arg(peak.counts.edge_hits).arg(match.norms.edges)))
      << text.toStdString();
  EXPECT_TRUE(map_->textAt({0.0, 0.0}).isEmpty());
  view_.selectTemplate(-1);
  EXPECT_EQ(map_->map(), nullptr);
}

TEST_F(MatchInspectorPanelTest, ARefinementShowsItsEdges) {
  const auto last = static_cast<int>(view_.snapshot()->iterations.size()) - 1;
  view_.setCursor({last, Stage::kFinished});
  auto* histogram = panel_.findChild<HistogramPlot*>();
  ASSERT_TRUE(histogram->isVisible());
  EXPECT_EQ(histogram->allCount(), view_.iteration()->refinement.found_count);
  auto* table = panel_.findChild<QTableWidget*>(QStringLiteral("edges"));
  EXPECT_EQ(table->item(0, 1)->text(), QString::number(view_.iteration()->refinement.sample_count));
  const auto* directions = panel_.findChild<QTableWidget*>(QStringLiteral("directions"));
  ASSERT_EQ(directions->rowCount(), 4);
  const Matrix6d& covariance = view_.iteration()->refinement.covariance;
  EXPECT_EQ(directions->item(0, 2)->text(),
            QStringLiteral("%1 mm").arg(1e3 * std::sqrt(covariance(5, 5)), 0, 'f', 3));
  panel_.findChild<QPushButton*>(QStringLiteral("showMatches"))->click();
  EXPECT_LT(view_.cursor().iteration, last);
  EXPECT_FALSE(view_.iteration()->templates.empty());
  EXPECT_TRUE(table_->isVisible());
}

TEST_F(MatchInspectorPanelTest, WithoutMatches_ReportsTheReason) {
  view_.setCursor({-1, Stage::kFinished});
  EXPECT_FALSE(table_->isVisible());
  view_.setCase(nullptr);
  EXPECT_FALSE(table_->isVisible());
  const auto labels = panel_.findChildren<QLabel*>();
  EXPECT_TRUE(std::any_of(labels.begin(), labels.end(), [](const QLabel* label) {
    return label->isVisible() && label->text() == QStringLiteral("No run yet.");
  }));
}

/// A binary image from rows of text: '#' is set.
struct Bits {
  explicit Bits(const std::vector<const char*>& rows)
      : words(rows.size()), width(static_cast<int>(std::string(rows.front()).size())) {
    for (std::size_t y = 0; y < rows.size(); ++y)
      for (int x = 0; x < width; ++x)
        if (rows[y][x] == '#') words[y] |= std::uint64_t{1} << x;
  }
  BitImage view() { return {words, width, static_cast<int>(words.size()), 1}; }

  std::vector<std::uint64_t> words;
  int width;
};

Bits edges({"......", "..#...", "..#...", "......"});
Bits mask({".####.", ".####.", ".####.", "......"});
Bits seen({"......", "......", "...#..", "..##..", "......"});

TEST(PatchPictures, ShowEdgesOverMask) {
  const QImage picture = templatePicture(edges.view(), mask.view(), {2, 2, 4});
  ASSERT_EQ(picture.size(), QSize(4, 4));
  for (const QPoint& edge : {QPoint(2, 1), QPoint(2, 2)})
    EXPECT_EQ(picture.pixel(edge), patch_colors::kEdge);
  EXPECT_EQ(picture.pixel(1, 1), patch_colors::kMask);
  for (const QPoint& ground : {QPoint(0, 0), QPoint(1, 3)})
    EXPECT_EQ(picture.pixel(ground), patch_colors::kGround);
}

TEST(PatchPictures, Colours_SeparateRenderedAndSeenEdges) {
  // The template's centre (2, 2) lies at (3, 3) of what was seen.
  const QImage picture =
      agreementPicture(edges.view(), mask.view(), {2, 2, 4}, seen.view(), {3, 3, 4});
  EXPECT_EQ(picture.pixel(2, 1), patch_colors::kEdge);
  EXPECT_EQ(picture.pixel(2, 2), patch_colors::kEdge);
  EXPECT_EQ(picture.pixel(1, 2), patch_colors::kOnlySeen);
  const QImage moved =
      agreementPicture(edges.view(), mask.view(), {2, 2, 4}, seen.view(), {3, 4, 4});
  EXPECT_EQ(moved.pixel(2, 2), patch_colors::kOnlyRendered);
}

TEST(PatchPictures, GroundLiesOutsideTheImage) {
  const QImage picture = seenPicture(seen.view(), {0, 0, 4});
  EXPECT_EQ(picture.pixel(0, 0), patch_colors::kGround);
  EXPECT_EQ(seenPicture(seen.view(), {3, 3, 4}).pixel(2, 1), patch_colors::kEdge);
}

TEST(PixelPlace, EnlargesByWholeDevicePixelsWhereItCan) {
  EXPECT_EQ(pixelPlace({10, 10}, {0, 0, 47, 99}, 1.0).size(), QSizeF(40, 40));
  EXPECT_EQ(pixelPlace({10, 10}, {0, 0, 47, 99}, 2.0).size(), QSizeF(45, 45));
  EXPECT_EQ(pixelPlace({100, 10}, {0, 0, 50, 50}, 1.0), QRectF(0, 23, 50, 5));
}

TEST(HeatColors, LightnessIncreasesMonotonically) {
  double before = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const QRgb color = heatColor(0.01 * i).rgb();
    const double light = 0.2126 * qRed(color) + 0.7152 * qGreen(color) + 0.0722 * qBlue(color);
    EXPECT_GT(light, before) << i;
    before = light;
  }
  EXPECT_EQ(heatColor(-1.0), heatColor(0.0));
  EXPECT_EQ(heatColor(2.0), heatColor(1.0));
}

const sessions::IterationTrace& firstIteration() {
  return *test::exampleRunOfSeed()->iterations.front();
}

using TemplatesModelTest = test::TestedModel<TemplatesModel>;

TEST_F(TemplatesModelTest, HasARowPerTemplate) {
  model_.setIteration(&firstIteration());
  EXPECT_EQ(model_.rowCount(), firstIteration().template_count);
  EXPECT_EQ(text(0, TemplatesModel::kNumber), QStringLiteral("1"));
  const auto details = sessions::matchDetails(firstIteration());
  for (int row = 0; row < model_.rowCount(); ++row) {
    const auto& value = details[static_cast<std::size_t>(row)];
    EXPECT_NEAR(text(row, TemplatesModel::kDepth_m).toDouble(), value.depth_m, 5.1e-4);
    if (!value.searched) continue;
    EXPECT_NEAR(text(row, TemplatesModel::kDx_px).toDouble(), value.moved_px().x(), 5.1e-3);
    EXPECT_NEAR(text(row, TemplatesModel::kScore).toDouble(), value.score, 5.1e-4);
    EXPECT_EQ(text(row, TemplatesModel::kVerdict) == QStringLiteral("inlier"), value.inlier);
  }
  model_.setIteration(nullptr);
  EXPECT_EQ(model_.rowCount(), 0);
}

TEST_F(TemplatesModelTest, FiltersByWhatBecameOfATemplate) {
  const sessions::IterationTrace& iteration = firstIteration();
  model_.setIteration(&iteration);
  EXPECT_EQ(countOf(Show::kAll), iteration.template_count);
  EXPECT_EQ(countOf(Show::kInliers), iteration.pnp.inlier_count);
  EXPECT_EQ(countOf(Show::kOutliers), iteration.correspondence_count - iteration.pnp.inlier_count);
  EXPECT_EQ(countOf(Show::kNotSearched), iteration.template_count - iteration.searched_count);
  int at_border = 0;
  int low = 0;
  for (const Match& match : iteration.matches) {
    at_border += match.at_border ? 1 : 0;
    const auto best = static_cast<double>(whsComparable(match.peak.counts, match.norms));
    const auto second = static_cast<double>(whsComparable(match.peak.second_counts, match.norms));
    low += match.searched && match.peak.has_second && second > 0.95 * best ? 1 : 0;
  }
  EXPECT_EQ(countOf(Show::kAtBorder), at_border);
  EXPECT_EQ(countOf(Show::kLowMargin), low);
  EXPECT_GT(low, 0);
}

TEST_F(TemplatesModelTest, WhatWasNotSearchedIsNoOutlier_NothingIsSaidBeforeTheMatches) {
  sessions::IterationTrace early = firstIteration();
  early.matches[2].searched = false;
  early.reached = Stage::kMatch;  // nothing is solved yet
  model_.setIteration(&early);
  EXPECT_EQ(countOf(Show::kNotSearched), 1);
  EXPECT_EQ(countOf(Show::kOutliers), 0);
  EXPECT_EQ(countOf(Show::kInliers), 0);
  EXPECT_EQ(text(2, TemplatesModel::kVerdict), QStringLiteral("not searched"));
  EXPECT_EQ(text(3, TemplatesModel::kVerdict), QStringLiteral("found"));
  early.reached = Stage::kTemplates;
  early.matches.clear();
  model_.setIteration(&early);
  EXPECT_EQ(text(0, TemplatesModel::kVerdict), QString());
  EXPECT_EQ(text(0, TemplatesModel::kScore), QString());
  EXPECT_NE(text(0, TemplatesModel::kX_px), QString());
}

}  // namespace
}  // namespace boresight::ui
