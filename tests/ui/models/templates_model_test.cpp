// SPDX-License-Identifier: Apache-2.0
#include "ui/models/templates_model.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <QAbstractItemModelTester>

#include "tests/support/example_run.h"

namespace boresight::ui {
namespace {

using Tester = QAbstractItemModelTester;
using Show = TemplatesModel::Show;

const sessions::IterationTrace& firstIteration() {
  return *test::exampleRunOfSeed()->iterations.front();
}

class TemplatesModelTest : public testing::Test {
 protected:
  TemplatesModelTest() { filter_.setSourceModel(&model_); }

  QString text(int row, int column) const { return model_.index(row, column).data().toString(); }
  int countOf(Show show) {
    filter_.setCondition([this, show](int row) { return model_.isShown(row, show); });
    return filter_.rowCount();
  }

  TemplatesModel model_;
  RowsFilter filter_;
  Tester model_tester_{&model_, Tester::FailureReportingMode::Fatal};
  Tester filter_tester_{&filter_, Tester::FailureReportingMode::Fatal};
};

TEST_F(TemplatesModelTest, HasARowPerTemplate) {
  model_.setIteration(&firstIteration());
  EXPECT_EQ(model_.rowCount(), firstIteration().template_count);
  EXPECT_EQ(text(0, TemplatesModel::kNumber), QStringLiteral("1"));
  const auto details = sessions::matchDetails(firstIteration());
  for (int row = 0; row < model_.rowCount(); ++row) {
    const auto& one = details[static_cast<std::size_t>(row)];
    EXPECT_NEAR(text(row, TemplatesModel::kDepth_m).toDouble(), one.depth_m, 5.1e-4);
    if (!one.searched) continue;
    EXPECT_NEAR(text(row, TemplatesModel::kDx_px).toDouble(), one.moved_px().x(), 5.1e-3);
    EXPECT_NEAR(text(row, TemplatesModel::kScore).toDouble(), one.score, 5.1e-4);
    EXPECT_EQ(text(row, TemplatesModel::kVerdict) == QStringLiteral("inlier"), one.inlier);
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
  const auto at_border = std::count_if(iteration.matches.begin(), iteration.matches.end(),
                                       [](const Match& match) { return match.at_border; });
  EXPECT_EQ(countOf(Show::kAtBorder), at_border);
  int low = 0;
  for (const Match& match : iteration.matches) {
    const auto best = static_cast<double>(whsComparable(match.peak.counts, match.norms));
    const auto second = static_cast<double>(whsComparable(match.peak.second_counts, match.norms));
    low += match.searched && match.peak.has_second && second > 0.95 * best ? 1 : 0;
  }
  EXPECT_EQ(countOf(Show::kLowMargin), low);
  EXPECT_GT(low, 0);
}

TEST_F(TemplatesModelTest, WhatWasNotSearchedIsNoOutlier) {
  sessions::IterationTrace early = firstIteration();
  early.matches[2].searched = false;
  early.reached = Stage::kMatch;  // nothing is solved yet
  model_.setIteration(&early);
  EXPECT_EQ(countOf(Show::kNotSearched), 1);
  EXPECT_EQ(countOf(Show::kOutliers), 0);
  EXPECT_EQ(countOf(Show::kInliers), 0);
  EXPECT_EQ(text(2, TemplatesModel::kVerdict), QStringLiteral("not searched"));
  EXPECT_EQ(text(3, TemplatesModel::kVerdict), QStringLiteral("found"));
}

TEST_F(TemplatesModelTest, SortsByNumberAndPutsTheUnknownLast) {
  sessions::IterationTrace iteration = firstIteration();
  iteration.matches[2].searched = false;
  model_.setIteration(&iteration);
  for (const auto order : {Qt::AscendingOrder, Qt::DescendingOrder}) {
    filter_.sort(TemplatesModel::kScore, order);
    const int last = filter_.rowCount() - 1;
    EXPECT_EQ(filter_.mapToSource(filter_.index(last, 0)).row(), 2);
    const auto score = [&](int row) {
      return filter_.index(row, TemplatesModel::kScore).data(kSortRole).toDouble();
    };
    for (int row = 1; row < last; ++row)
      EXPECT_TRUE(order == Qt::AscendingOrder ? score(row - 1) <= score(row)
                                              : score(row - 1) >= score(row));
  }
}

TEST_F(TemplatesModelTest, SaysNothingOfMatchesBeforeTheyAreThere) {
  sessions::IterationTrace early = firstIteration();
  early.reached = Stage::kTemplates;
  early.matches.clear();
  model_.setIteration(&early);
  EXPECT_EQ(text(0, TemplatesModel::kVerdict), QString());
  EXPECT_EQ(text(0, TemplatesModel::kScore), QString());
  EXPECT_NE(text(0, TemplatesModel::kX_px), QString());
}

}  // namespace
}  // namespace boresight::ui
