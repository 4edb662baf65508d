// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>

#include "sessions/review/standing.h"

QT_BEGIN_NAMESPACE
class QLabel;
QT_END_NAMESPACE

namespace boresight::ui {

/// Where a case stands, in words behind a sign of its own shape; the colour only helps.
class StandingBanner : public QFrame {
  Q_OBJECT

 public:
  explicit StandingBanner(QWidget* parent = nullptr);

  void setStanding(const sessions::Standing& standing);
  /// Neither sign nor standing: there is no case.
  void clear();
  QString text() const;

 protected:
  void changeEvent(QEvent* event) override;

 private:
  enum class Look { kPlain, kGood, kBad };
  void show(const QString& sign, const QString& text, Look look);
  void applyPalette();

  Look look_ = Look::kPlain;
  QLabel* sign_ = nullptr;
  QLabel* text_ = nullptr;
};

}  // namespace boresight::ui
