// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>

#include "sessions/run/trace.h"

QT_BEGIN_NAMESPACE
class QLabel;
QT_END_NAMESPACE

namespace boresight::ui {

/// One line that says where a run stands; after its end what was measured, what was needed and what
/// to try. A sign, a word and a colour differ.
class RunBanner : public QFrame {
  Q_OBJECT

 public:
  explicit RunBanner(QWidget* parent = nullptr);

  /// nullptr: no run.
  void setSnapshot(const sessions::LocalizationTrace* snapshot);
  QString text() const;

 protected:
  void changeEvent(QEvent* event) override;

 private:
  enum class Kind { kNone, kUnderWay, kConverged, kFailed };
  void applyPalette();

  Kind kind_ = Kind::kNone;
  QLabel* sign_ = nullptr;
  QLabel* text_ = nullptr;
};

}  // namespace boresight::ui
