// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "ui/models/column_info.h"
#include "ui/models/marks_model.h"

namespace boresight::ui {

inline constexpr const char* kMarksContext = "boresight::ui::MarksModel";

/// What the columns of the marks' table are called and mean.
extern const std::array<ColumnInfo, MarksModel::kColumnCount> kMarksColumns;

}  // namespace boresight::ui
