// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <QWidget>

#include "sessions/decision/check.h"

class QLineEdit;
class QVBoxLayout;

namespace boresight::ui {

/// A failed check, and the reason for waiving it, or empty.
struct FailedCheck {
  sessions::Check check;
  QString reason;
};

/// "0.37 of 0.40 mm" as everywhere for the pose's quality; "91.3 % (≥ 40 %)".
QString foundAndLimit(const sessions::Check& check);
/// "≥ 40 %"; empty without a limit.
QString shortLimit(const sessions::Check& check);

/// The failed checks of a pose, a card each: figure and limit, finding and remedy, and the reason
/// for waiving it, which is edited here.
class CheckCards : public QWidget {
  Q_OBJECT

 public:
  explicit CheckCards(QWidget* parent = nullptr);

  /// `current` false: their inputs have changed since, and no reason can be given. Cards of the
  /// same checks stay, with a reason that is being typed.
  void setChecks(const std::vector<FailedCheck>& failed, bool current);

 Q_SIGNALS:
  /// For the check as its card shows it.
  void reasonEdited(const boresight::sessions::Check& check, const QString& reason);
  /// Requests to show the source of the figure.
  void showRequested(const std::string& check_id);

 private:
  QWidget* cardOf(const sessions::Check& check);

  std::vector<sessions::Check> checks_;
  std::vector<QLineEdit*> reasons_;
  QVBoxLayout* cards_ = nullptr;
};

}  // namespace boresight::ui
