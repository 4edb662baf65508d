// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/empty_hint.h"

#include <QAbstractItemModel>
#include <QAbstractItemView>
#include <QEvent>

namespace boresight::ui {

EmptyHint::EmptyHint(QAbstractItemView& view, int least_rows)
    : QLabel(view.viewport()), view_(view), least_rows_(least_rows) {
  setObjectName(QStringLiteral("emptyHint"));
  setAlignment(Qt::AlignCenter);
  setWordWrap(true);
  setMargin(12);
  setAttribute(Qt::WA_TransparentForMouseEvents);
  view.viewport()->installEventFilter(this);
  const QAbstractItemModel* model = view.model();
  connect(model, &QAbstractItemModel::modelReset, this, &EmptyHint::showOrHide);
  connect(model, &QAbstractItemModel::rowsInserted, this, &EmptyHint::showOrHide);
  connect(model, &QAbstractItemModel::rowsRemoved, this, &EmptyHint::showOrHide);
  connect(model, &QAbstractItemModel::layoutChanged, this, &EmptyHint::showOrHide);
  showOrHide();
}

void EmptyHint::showOrHide() {
  setGeometry(view_.viewport()->rect());
  setVisible(view_.model()->rowCount() <= least_rows_);
}

bool EmptyHint::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize) setGeometry(view_.viewport()->rect());
  return QLabel::eventFilter(watched, event);
}

}  // namespace boresight::ui
