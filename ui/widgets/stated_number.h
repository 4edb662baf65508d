// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QDoubleSpinBox>

namespace boresight::ui {

/// A number of a dialog in a spin box, which shows it rounded and within the box's range. Unless
/// the operator changes it, the number keeps its exact value, or stays unstated.
class StatedNumber {
 public:
  StatedNumber() = default;
  /// `box_per_unit`: 1e3 shows metres in millimetres. Without a stated number `assumed` is shown.
  StatedNumber(QDoubleSpinBox& box, double box_per_unit, const std::optional<double>& stated,
               double assumed = 0.0)
      : box_(&box), box_per_unit_(box_per_unit), stated_(stated) {
    const double value = box_per_unit * stated.value_or(assumed);
    box.setValue(value);
    // A small number must not be rounded to the one that means "not stated".
    while (stated && isNone() && value > box.minimum() && box.decimals() < kMostDecimals) {
      box.setDecimals(box.decimals() + 1);
      box.setValue(value);
    }
    shown_ = box.value();
  }

  bool isChanged() const { return box_->value() != shown_; }
  /// Empty: not stated. A box with a special text states nothing at its minimum.
  std::optional<double> value() const {
    if (!isChanged()) return stated_;
    return isNone() ? std::nullopt : std::optional(box_->value() / box_per_unit_);
  }

 private:
  static constexpr int kMostDecimals = 15;

  bool isNone() const {
    return !box_->specialValueText().isEmpty() && box_->value() == box_->minimum();
  }

  QDoubleSpinBox* box_ = nullptr;
  double box_per_unit_ = 1.0;
  std::optional<double> stated_;
  double shown_ = 0.0;
};

}  // namespace boresight::ui
