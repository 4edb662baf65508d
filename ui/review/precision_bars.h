// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QWidget>

#include "sessions/decision/check.h"

class QVBoxLayout;

namespace boresight::ui {

/// How well a pose is known, against the requirement: title, "0.37 of 0.40 mm" and a bar for each
/// check of its covariance.
class PrecisionBars : public QWidget {
  Q_OBJECT

 public:
  explicit PrecisionBars(QWidget* parent = nullptr);

  /// Shows those of these checks that compare a covariance with a limit; hidden without any.
  void setChecks(const std::vector<sessions::Check>& checks);

 private:
  std::vector<sessions::Check> shown_;
  QVBoxLayout* rows_ = nullptr;
};

}  // namespace boresight::ui
