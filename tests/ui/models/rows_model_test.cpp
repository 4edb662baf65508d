// SPDX-License-Identifier: Apache-2.0
#include "ui/models/rows_model.h"

#include <gtest/gtest.h>

#include <memory>

#include "ui/models/alternatives_model.h"
#include "ui/models/cases_model.h"
#include "ui/models/iterations_model.h"
#include "ui/models/marks_model.h"
#include "ui/models/options_model.h"
#include "ui/models/templates_model.h"
#include "ui/review/queue_model.h"
#include "ui/review/review_panel.h"

namespace boresight::ui {
namespace {

TEST(RowsModels, EveryColumnSaysWhatItMeans) {
  std::vector<std::unique_ptr<QAbstractItemModel>> models;
  models.push_back(std::make_unique<AlternativesModel>());
  models.push_back(std::make_unique<CasesModel>());
  models.push_back(std::make_unique<ChecksModel>());
  models.push_back(std::make_unique<DifferencesModel>());
  models.push_back(std::make_unique<IterationsModel>());
  models.push_back(std::make_unique<OptionsModel>());
  models.push_back(std::make_unique<MarksModel>());
  models.push_back(std::make_unique<QueueModel>());
  models.push_back(std::make_unique<TemplatesModel>());
  for (const auto& model : models) {
    SCOPED_TRACE(model->metaObject()->className());
    EXPECT_GE(model->columnCount(), 4);
    for (int column = 0; column < model->columnCount(); ++column) {
      EXPECT_FALSE(model->headerData(column, Qt::Horizontal).toString().isEmpty());
      EXPECT_GE(model->headerData(column, Qt::Horizontal, Qt::ToolTipRole).toString().size(), 9);
    }
    EXPECT_FALSE(model->headerData(model->columnCount(), Qt::Horizontal).isValid());
  }
}

}  // namespace
}  // namespace boresight::ui
