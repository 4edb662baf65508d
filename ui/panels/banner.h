// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>

#include "sessions/review/standing.h"
#include "sessions/run/trace.h"

class QLabel;

namespace boresight::ui {

/// A sentence behind a sign of its own shape; the colour only helps.
class Banner : public QFrame {
  Q_OBJECT

 public:
  /// `name`: of the sentence's label.
  explicit Banner(const QString& name, QWidget* parent = nullptr);

  /// Where a run is; after its end what was measured, what was needed and what to try. nullptr: no
  /// run.
  void showRun(const sessions::LocalizationTrace* run);
  /// The review status of a case; nullptr: there is no case.
  void showStanding(const sessions::Standing* standing);
  QString text() const;

 protected:
  void changeEvent(QEvent* event) override;

 private:
  enum class Tone { kPlain, kGood, kBad };
  void show(const QString& sign, const QString& text, Tone tone);
  void applyPalette();

  Tone tone_ = Tone::kPlain;
  QLabel* sign_ = nullptr;
  QLabel* text_ = nullptr;
};

}  // namespace boresight::ui
