// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QLabel>

QT_BEGIN_NAMESPACE
class QAbstractItemView;
QT_END_NAMESPACE

namespace boresight::ui {

/// Says in an empty list why it is empty and what to do about it. Lies over the view and takes no
/// clicks.
class EmptyHint : public QLabel {
  Q_OBJECT

 public:
  /// The view must have its model already; a hint shows while that has at most `least_rows` rows.
  explicit EmptyHint(QAbstractItemView& view, int least_rows = 0);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void showOrHide();

  QAbstractItemView& view_;
  int least_rows_;
};

}  // namespace boresight::ui
