// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/case_strip.h"

#include <utility>

#include <QtWidgets>

#include "ui/panels/case/cases_panel.h"
#include "ui/style/icons.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

/// Place in the order of decisions.
int decisionRank(CaseState state) {
  switch (state) {
    case CaseState::kFailed:
      return 0;
    case CaseState::kConverged:
    case CaseState::kAnnotated:
      return 1;
    case CaseState::kRunning:
    case CaseState::kNew:
      return 2;
    case CaseState::kRejected:
    case CaseState::kValidated:
      return 3;
  }
  return 3;
}

struct Badge {
  QRgb color;
  Icon icon;
};

Badge badgeOf(CaseState state) {
  switch (state) {
    case CaseState::kNew:
      return {kBadgeNew, Icon::kDot};
    case CaseState::kConverged:
      return {kBadgeConverged, Icon::kCheck};
    case CaseState::kFailed:
      return {kBadgeFailed, Icon::kCross};
    case CaseState::kAnnotated:
      return {kBadgeAnnotated, Icon::kPencil};
    case CaseState::kValidated:
      return {kBadgeValidated, Icon::kShield};
    case CaseState::kRejected:
      return {kBadgeFailed, Icon::kFlag};
    case CaseState::kRunning:
      return {kBadgeRunning, Icon::kRun};
  }
  return {kBadgeNew, Icon::kDot};
}

/// A picture, the badge at its lower right corner, and below it the name where there is room.
class CaseTile final : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  void setNarrow(bool narrow) { measures_ = narrow ? kNarrow : kWide; }

  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex&) const override {
    const int name = named() ? option.fontMetrics.height() + 4 : 0;
    return {measures_.strip_width - 1, measures_.strip_thumbnail + 16 + name};
  }

  void paint(QPainter* painter, const QStyleOptionViewItem& option,
             const QModelIndex& index) const override {
    const auto* order = qobject_cast<const QAbstractProxyModel*>(index.model());
    if (!order) return;
    const auto* model = qobject_cast<const CasesModel*>(order->sourceModel());
    if (!model) return;
    const CaseRow& row = model->at(order->mapToSource(index).row());
    const bool chosen = option.state & QStyle::State_Selected;
    painter->save();
    painter->setRenderHints(QPainter::Antialiasing | QPainter::SmoothPixmapTransform);
    if (chosen) {
      painter->fillRect(option.rect, QColor(theme().accent_tint));
      painter->fillRect(QRect(option.rect.topLeft(), QSize(4, option.rect.height())),
                        QColor(theme().accent));
    }
    const int side = measures_.strip_thumbnail;
    const QRect picture(option.rect.center().x() - side / 2, option.rect.top() + 8, side, side);
    paintPicture(*painter, picture, row.thumbnail);
    if (chosen) {
      painter->setPen(QPen(QColor(theme().accent), 2));
      painter->setBrush(Qt::NoBrush);
      painter->drawRoundedRect(picture, kRadius, kRadius);
    }
    paintBadge(*painter, picture, badgeOf(row.state), row.stale);
    if (named()) paintName(*painter, option, picture, row.id, chosen);
    painter->restore();
  }

 private:
  bool named() const { return measures_.strip_width == kWide.strip_width; }

  static void paintPicture(QPainter& painter, const QRect& place, const QImage& image) {
    QPainterPath outline;
    outline.addRoundedRect(place, kRadius, kRadius);
    painter.fillPath(outline, QColor(theme().canvas));
    if (image.isNull()) return;
    painter.save();
    painter.setClipPath(outline);
    const int side = std::min(image.width(), image.height());
    const QRect middle((image.width() - side) / 2, (image.height() - side) / 2, side, side);
    painter.drawImage(place, image, middle);
    painter.restore();
  }

  static void paintBadge(QPainter& painter, const QRect& picture, const Badge& badge, bool stale) {
    const QRectF place(picture.right() - kBadge + 5, picture.bottom() - kBadge + 5, kBadge, kBadge);
    painter.setPen(QPen(QColor(theme().panel), 2));
    QColor color(badge.color);
    painter.setBrush(stale ? QColor(theme().panel) : color);
    painter.drawEllipse(place);
    if (stale) {  // hollow: no longer of what would be run
      painter.setPen(QPen(color, 2));
      painter.drawEllipse(place.adjusted(2, 2, -2, -2));
    }
    paintIcon(painter, place.adjusted(4, 4, -4, -4), badge.icon, stale ? color : QColor(Qt::white));
  }

  static void paintName(QPainter& painter, const QStyleOptionViewItem& option, const QRect& picture,
                        const QString& name, bool chosen) {
    QFont font = option.font;
    font.setPointSizeF(kCaptionSize - 1);
    font.setBold(chosen);
    painter.setFont(font);
    painter.setPen(QColor(chosen ? theme().text : theme().text2));
    const QRect place(option.rect.left() + 4, picture.bottom() + 4, option.rect.width() - 8,
                      option.rect.bottom() - picture.bottom() - 4);
    painter.drawText(place, Qt::AlignHCenter | Qt::AlignTop,
                     QFontMetrics(font).elidedText(name, Qt::ElideMiddle, place.width()));
  }

  Measures measures_ = kWide;
};

}  // namespace

/// The session's order, or that of decisions.
class DecisionOrder final : public QSortFilterProxyModel {
 public:
  DecisionOrder(CasesModel& model, QObject* parent) : QSortFilterProxyModel(parent), model_(model) {
    setSourceModel(&model);
    sort(0);
  }

  void setForDecisions(bool for_decisions) {
    if (std::exchange(for_decisions_, for_decisions) != for_decisions) invalidate();
  }

 protected:
  bool lessThan(const QModelIndex& left, const QModelIndex& right) const override {
    const auto rank = [this](const QModelIndex& index) {
      return for_decisions_ ? decisionRank(model_.at(index.row()).state) : 0;
    };
    return std::pair(rank(left), left.row()) < std::pair(rank(right), right.row());
  }

 private:
  CasesModel& model_;
  bool for_decisions_ = false;
};

CaseStrip::CaseStrip(CasesModel& model, QWidget* parent)
    : QFrame(parent),
      model_(model),
      order_(new DecisionOrder(model, this)),
      filter_(named(new QToolButton, "stripFilter", tr("List, filter and run the cases"))),
      list_(named(new QListView, "stripList")) {
  setObjectName(QStringLiteral("caseStrip"));
  filter_->setIcon(iconOf(Icon::kFilter, &Theme::text2));
  filter_->setFixedHeight(kVerdictHeight);
  filter_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  list_->setModel(order_);
  list_->setItemDelegate(new CaseTile(list_));
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list_->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  list_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list_->setAccessibleName(tr("Cases"));
  list_->setFrameShape(QFrame::NoFrame);
  auto* add = named(new QToolButton, "stripAdd", tr("Add a case from files (Ctrl+N)"));
  add->setIcon(iconOf(Icon::kPlus));
  add->setAccessibleName(tr("Add a case"));
  add->setFixedHeight(kSmallButtonHeight + 8);
  add->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(filter_);
  column->addWidget(list_, 1);
  column->addWidget(add);
  connect(filter_, &QToolButton::clicked, this, &CaseStrip::listRequested);
  connect(add, &QToolButton::clicked, this, &CaseStrip::addRequested);
  connect(list_->selectionModel(), &QItemSelectionModel::currentChanged, this,
          [this](const QModelIndex& current) {
            if (!showing_ && current.isValid()) Q_EMIT caseRequested(idAt(current));
          });
  list_->setContextMenuPolicy(Qt::CustomContextMenu);
  connect(list_, &QWidget::customContextMenuRequested, this, [this](const QPoint& at) {
    const QModelIndex index = list_->indexAt(at);
    if (index.isValid()) Q_EMIT menuRequested(idAt(index), list_->viewport()->mapToGlobal(at));
  });
  connect(&model_, &QAbstractItemModel::modelReset, this, &CaseStrip::showRows);
  connect(&model_, &QAbstractItemModel::rowsInserted, this, &CaseStrip::showRows);
  setNarrow(false);
  showRows();
}

void CaseStrip::showRows() {
  filter_->setText(QString::number(model_.rowCount()));
  setCurrent(current_);
}

QString CaseStrip::idAt(const QModelIndex& index) const {
  return model_.at(order_->mapToSource(index).row()).id;
}

void CaseStrip::setForDecisions(bool for_decisions) {
  order_->setForDecisions(for_decisions);
  setCurrent(current_);
}

void CaseStrip::setNarrow(bool narrow) {
  static_cast<CaseTile*>(list_->itemDelegate())->setNarrow(narrow);
  filter_->setToolButtonStyle(narrow ? Qt::ToolButtonTextUnderIcon : Qt::ToolButtonTextBesideIcon);
  setFixedWidth((narrow ? kNarrow : kWide).strip_width);
  list_->doItemsLayout();
}

void CaseStrip::setCurrent(const QString& id) {
  current_ = id;
  showing_ = true;
  const QModelIndex index = order_->mapFromSource(model_.index(model_.rowOf(id), 0));
  list_->setCurrentIndex(index);
  if (index.isValid()) list_->scrollTo(index);
  showing_ = false;
}

}  // namespace boresight::ui
