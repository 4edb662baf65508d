// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/case_strip.h"

#include <utility>

#include <QtWidgets>

#include "ui/panels/case/cases_panel.h"
#include "ui/style/icons.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

struct Badge {
  QRgb color;
  Icon icon;
  int rank;  ///< place in the order of decisions
};

/// In the order of `CaseState`.
constexpr Badge kBadges[] = {
    {kBadgeNew, Icon::kDot, 2},           // kNew
    {kBadgeConverged, Icon::kCheck, 1},   // kConverged
    {kBadgeFailed, Icon::kCross, 0},      // kFailed
    {kBadgeAnnotated, Icon::kPencil, 1},  // kAnnotated
    {kBadgeValidated, Icon::kShield, 3},  // kValidated
    {kBadgeFailed, Icon::kFlag, 3},       // kRejected
    {kBadgeRunning, Icon::kRun, 2},       // kRunning
};
static_assert(std::size(kBadges) == kCaseStateCount);

const Badge& badgeOf(CaseState state) { return kBadges[static_cast<std::size_t>(state)]; }

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
      return for_decisions_ ? badgeOf(model_.at(index.row()).state).rank : 0;
    };
    return std::pair(rank(left), left.row()) < std::pair(rank(right), right.row());
  }

 private:
  CasesModel& model_;
  bool for_decisions_ = false;
};

CaseStrip::CaseStrip(CasesModel& model, QWidget* parent)
    : QFrame(parent), model_(model), order_(new DecisionOrder(model, this)) {
  ui_.setupUi(this);
  ui_.stripFilter->setIcon(iconOf(Icon::kFilter, &Theme::text2));
  ui_.stripFilter->setFixedHeight(kVerdictHeight);
  ui_.stripList->setModel(order_);
  ui_.stripList->setItemDelegate(new CaseTile(ui_.stripList));
  ui_.stripAdd->setIcon(iconOf(Icon::kPlus));
  ui_.stripAdd->setFixedHeight(kSmallButtonHeight + 8);
  connect(ui_.stripFilter, &QToolButton::clicked, this, &CaseStrip::listRequested);
  connect(ui_.stripAdd, &QToolButton::clicked, this, &CaseStrip::addRequested);
  connect(ui_.stripList->selectionModel(), &QItemSelectionModel::currentChanged, this,
          [this](const QModelIndex& current) {
            if (!showing_ && current.isValid()) Q_EMIT caseRequested(idAt(current));
          });
  connect(ui_.stripList, &QWidget::customContextMenuRequested, this, [this](const QPoint& at) {
    const QModelIndex index = ui_.stripList->indexAt(at);
    if (index.isValid())
      Q_EMIT menuRequested(idAt(index), ui_.stripList->viewport()->mapToGlobal(at));
  });
  connectEach(model_, this, &CaseStrip::showRows, &QAbstractItemModel::modelReset,
              &QAbstractItemModel::rowsInserted);
  setNarrow(false);
  showRows();
}

void CaseStrip::showRows() {
  ui_.stripFilter->setText(QString::number(model_.rowCount()));
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
  static_cast<CaseTile*>(ui_.stripList->itemDelegate())->setNarrow(narrow);
  ui_.stripFilter->setToolButtonStyle(narrow ? Qt::ToolButtonTextUnderIcon
                                             : Qt::ToolButtonTextBesideIcon);
  setFixedWidth((narrow ? kNarrow : kWide).strip_width);
  ui_.stripList->doItemsLayout();
}

void CaseStrip::setCurrent(const QString& id) {
  current_ = id;
  showing_ = true;
  const QModelIndex index = order_->mapFromSource(model_.index(model_.rowOf(id), 0));
  ui_.stripList->setCurrentIndex(index);
  if (index.isValid()) ui_.stripList->scrollTo(index);
  showing_ = false;
}

}  // namespace boresight::ui
