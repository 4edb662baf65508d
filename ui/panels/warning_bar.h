// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QFrame>
#include <QStringList>

class QLabel;
class QToolButton;

namespace boresight::ui {

/// A strip that says what looks wrong before anybody asks, with one button for more; hidden while
/// there is nothing to say. A sign and words carry it, the colour only helps.
class WarningBar : public QFrame {
  Q_OBJECT

 public:
  /// `action` is what the button says, `tip` what it does.
  WarningBar(const QString& action, const QString& tip, QWidget* parent = nullptr);

  /// The first sentences are shown, all of them are in the tooltip; none hides the bar.
  void setSentences(const QStringList& sentences);
  QString text() const;

 Q_SIGNALS:
  void actionRequested();

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void applyPalette();

  QLabel* text_ = nullptr;
  bool tinting_ = false;
};

}  // namespace boresight::ui
