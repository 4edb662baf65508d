// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <QAbstractItemModelTester>

#include "ui/models/rows_model.h"

namespace boresight::test {

/// A model and a filter of its rows, both watched by Qt's tester of models.
template <class Model>
class TestedModel : public ::testing::Test {
 protected:
  using Tester = QAbstractItemModelTester;

  TestedModel() { filter_.setSourceModel(&model_); }

  QString text(int row, int column) const { return model_.index(row, column).data().toString(); }
  /// Number of rows that a choice of the model's rows leaves.
  template <class Show>
  int countOf(Show show) {
    filter_.setCondition([this, show](int row) { return model_.isShown(row, show); });
    return filter_.rowCount();
  }

  Model model_;
  ui::RowsFilter filter_;
  Tester model_tester_{&model_, Tester::FailureReportingMode::Fatal};
  Tester filter_tester_{&filter_, Tester::FailureReportingMode::Fatal};
};

}  // namespace boresight::test
