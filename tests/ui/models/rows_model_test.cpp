// SPDX-License-Identifier: Apache-2.0
#include "ui/models/rows_model.h"

#include <limits>
#include <memory>
#include <tuple>

#include <gtest/gtest.h>

#include "ui/models/annotations_model.h"
#include "ui/models/text.h"
#include "ui/panels/case/cases_panel.h"
#include "ui/panels/diagnose/hypotheses_panel.h"
#include "ui/panels/diagnose/iterations_panel.h"
#include "ui/panels/diagnose/match_view.h"
#include "ui/panels/diagnose/options_table.h"
#include "ui/review/queue_panel.h"
#include "ui/review/review_panel.h"

namespace boresight::ui {
namespace {

TEST(RowsModels, EveryColumnSaysWhatItMeans) {
  const std::tuple<AlternativesModel, CasesModel, ChecksModel, DifferencesModel, IterationsModel,
                   OptionsModel, AnnotationsModel, QueueModel, TemplatesModel>
      models;
  const auto list = std::apply(
      [](const auto&... each) { return std::vector<const QAbstractItemModel*>{&each...}; }, models);
  for (const QAbstractItemModel* model : list) {
    SCOPED_TRACE(model->metaObject()->className());
    EXPECT_GE(model->columnCount(), 3);
    for (int column = 0; column < model->columnCount(); ++column) {
      EXPECT_FALSE(model->headerData(column, Qt::Horizontal).toString().isEmpty());
      EXPECT_GE(model->headerData(column, Qt::Horizontal, Qt::ToolTipRole).toString().size(), 9);
    }
    EXPECT_FALSE(model->headerData(model->columnCount(), Qt::Horizontal).isValid());
  }
}

TEST(RowsModels, HeadsStandAboveTheirFigures) {
  IterationsModel iterations;
  iterations.setSnapshot(std::make_shared<sessions::LocalizationTrace>());
  ASSERT_EQ(iterations.rowCount(), 1);
  for (int column = 0; column < iterations.columnCount(); ++column)
    EXPECT_EQ(iterations.headerData(column, Qt::Horizontal, Qt::TextAlignmentRole),
              iterations.index(0, column).data(Qt::TextAlignmentRole))
        << iterations.headerData(column, Qt::Horizontal).toString().toStdString();
}

TEST(NumberText, RoundsUpToOneTwoOrFiveTimesAPowerOfTen) {
  const double pairs[][2] = {{0.0011, 0.002}, {0.03, 0.05}, {0.3, 0.5}, {1.0, 1.0},  {1.1, 2.0},
                             {2.0, 2.0},      {2.1, 5.0},   {5.0, 5.0}, {6.0, 10.0}, {700.0, 1e3}};
  for (const auto& [value, rounded] : pairs) EXPECT_DOUBLE_EQ(roundedUp(value), rounded) << value;
  EXPECT_DOUBLE_EQ(roundedUp(0.1 + 0.1 + 0.1 - 0.1), 0.2) << "a last bit is no reason to round up";
  for (const double none : {0.0, -3.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(roundedUp(none), 1.0);
}

}  // namespace
}  // namespace boresight::ui
