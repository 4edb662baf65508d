// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>
#include <QStringList>

#include "sessions/review/review_status.h"
#include "sessions/run/trace.h"

class QLabel;
class QToolButton;

namespace boresight::ui {

/// A sentence behind a sign of its own shape, and a button where something can be done about it.
/// The colour is never the only difference.
class Banner : public QFrame {
  Q_OBJECT

 public:
  enum class Tone { kPlain, kGood, kBad };

  explicit Banner(QWidget* parent = nullptr);

  void setMessage(const QString& sign, const QString& text, Tone tone);
  /// Progress of a run; after its end what was measured, what was needed and what to try. nullptr:
  /// no run.
  void showRun(const sessions::LocalizationTrace* run);
  /// The review status of a case; nullptr: there is no case.
  void showReviewStatus(const sessions::ReviewStatus* status);
  /// Shows the first sentences, and all of them in the tooltip. Hides the banner when empty.
  void showWarnings(const QStringList& sentences);
  /// Adds the button; `tip` says what it does.
  void setAction(const QString& text, const QString& tip);
  QString text() const;

 Q_SIGNALS:
  void actionRequested();

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void applyPalette();

  Tone tone_ = Tone::kPlain;
  bool tinting_ = false;
  QLabel* sign_ = nullptr;
  QLabel* text_ = nullptr;
  QToolButton* action_ = nullptr;
};

}  // namespace boresight::ui
