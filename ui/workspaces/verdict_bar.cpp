// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/verdict_bar.h"

#include <QtWidgets>

#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr int kOthersWide = 2;    // buttons next to the action
constexpr int kOthersNarrow = 1;  // the rest is behind "..."
constexpr int kElideStep = 20;    // px by which a sentence is shortened until it fits
constexpr int kPopoverText = 380;
constexpr int kPopoverGap = 4;

const char* toneName(VerdictTone tone) {
  return tone == VerdictTone::kGood      ? "good"
         : tone == VerdictTone::kBad     ? "bad"
         : tone == VerdictTone::kCaution ? "caution"
                                         : "plain";
}

QRgb Theme::*colorOf(VerdictTone tone) {
  return tone == VerdictTone::kGood      ? &Theme::success_text
         : tone == VerdictTone::kBad     ? &Theme::failure_text
         : tone == VerdictTone::kCaution ? &Theme::warning_text
                                         : &Theme::accent;
}

QString textOf(Step step) { return QCoreApplication::translate("Step", stepInfo(step).text); }
QString helpOf(Step step) { return QCoreApplication::translate("Step", stepInfo(step).help); }

}  // namespace

VerdictBar::VerdictBar(QWidget* parent)
    : QFrame(parent),
      icon_(new IconLabel(kToolIcon)),
      head_(named(new QLabel, "verdictHeadline")),
      sentence_(named(new QLabel, "verdictSentence")),
      badge_(named(new QPushButton, "warningBadge")),
      others_(new QHBoxLayout),
      more_(named(new QToolButton, "verdictMore", tr("What else may help"))),
      more_menu_(new QMenu(this)),
      action_(named(new QPushButton, "verdictAction")) {
  setObjectName(QStringLiteral("verdictBar"));
  setFixedHeight(kVerdictHeight);
  sentence_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  sentence_->setTextFormat(Qt::PlainText);
  sentence_->setWordWrap(true);
  head_->setTextFormat(Qt::PlainText);
  badge_->setIcon(iconOf(Icon::kWarning, &Theme::warning_text));
  more_->setText(QStringLiteral("…"));
  more_->setPopupMode(QToolButton::InstantPopup);
  more_->setMenu(more_menu_);
  more_->setAccessibleName(tr("More actions"));
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(12, 4, 8, 4);
  row->setSpacing(8);
  for (QWidget* each : {static_cast<QWidget*>(icon_), static_cast<QWidget*>(head_)})
    row->addWidget(each);
  row->addWidget(sentence_, 1);
  row->addWidget(badge_);
  row->addLayout(others_);
  row->addWidget(more_);
  row->addWidget(action_);
  for (QWidget* each : std::initializer_list<QWidget*>{badge_, more_, action_})
    each->setFixedHeight(kButtonHeight);
  for (QPushButton* each : {badge_, action_}) each->setIconSize(kButtonIcon);
  connect(badge_, &QPushButton::clicked, this, &VerdictBar::showWarnings);
  connect(action_, &QPushButton::clicked, this, [this] { Q_EMIT stepRequested(verdict_.step); });
  sentence_->installEventFilter(this);
  setWarnings({});
  setVerdict({});
}

/// Buttons that come and go change the room of the sentence, and not the bar's size.
bool VerdictBar::eventFilter(QObject* watched, QEvent* event) {
  if (watched == sentence_ && event->type() == QEvent::Resize)
    QMetaObject::invokeMethod(
        this, [this] { elide(); }, Qt::QueuedConnection);
  return QFrame::eventFilter(watched, event);
}

void VerdictBar::setVerdict(const Verdict& verdict) {
  verdict_ = verdict;
  setProperty("tone", QLatin1String(toneName(verdict.tone)));
  icon_->setIcon(verdict.icon, colorOf(verdict.tone));
  head_->setText(verdict.head);
  action_->setVisible(verdict.step != Step::kNone);
  action_->setText(verdict.step_text.isEmpty() ? textOf(verdict.step) : verdict.step_text);
  action_->setToolTip(tr("%1 (Ctrl+Enter)").arg(helpOf(verdict.step)));
  action_->setProperty("primary", !verdict.plain);
  action_->setIcon(
      iconOf(stepInfo(verdict.step).icon, verdict.plain ? &Theme::text : &Theme::on_accent));
  setAccessibleName(text());
  showOthers();
  for (QWidget* each : std::initializer_list<QWidget*>{this, head_, action_}) {
    each->style()->unpolish(each);
    each->style()->polish(each);
  }
  elide();
}

QString VerdictBar::text() const {
  return verdict_.sentence.isEmpty() ? verdict_.head
                                     : verdict_.head + QLatin1Char(' ') + verdict_.sentence;
}

void VerdictBar::showOthers() {
  while (QLayoutItem* item = others_->takeAt(0)) {
    delete item->widget();
    delete item;
  }
  more_menu_->clear();
  const int shown = width() < kWideWindow ? kOthersNarrow : kOthersWide;
  for (std::size_t i = 0; i < verdict_.others.size(); ++i) {
    const Step step = verdict_.others[i];
    const auto ask = [this, step] { Q_EMIT stepRequested(step); };
    if (static_cast<int>(i) < shown) {
      auto* button = new QPushButton(iconOf(stepInfo(step).icon), textOf(step));
      button->setToolTip(helpOf(step));
      button->setFixedHeight(kButtonHeight);
      button->setIconSize(kButtonIcon);
      connect(button, &QPushButton::clicked, this, ask, Qt::QueuedConnection);
      others_->addWidget(button);
    } else {
      QAction* each = more_menu_->addAction(iconOf(stepInfo(step).icon), textOf(step));
      each->setToolTip(helpOf(step));
      connect(each, &QAction::triggered, this, ask, Qt::QueuedConnection);
    }
  }
  more_->setVisible(!more_menu_->isEmpty());
}

void VerdictBar::setWarnings(const QStringList& sentences) {
  warnings_ = sentences;
  badge_->setVisible(!sentences.isEmpty());
  badge_->setText(sentences.size() == 1 ? tr("1 warning")
                                        : tr("%1 warnings").arg(sentences.size()));
  badge_->setToolTip(sentences.join(QLatin1Char('\n')));
  elide();
}

/// Until a click elsewhere.
void VerdictBar::showWarnings() {
  auto* popover = named(new QFrame(this, Qt::Popup), "warningPopover");
  popover->setAttribute(Qt::WA_DeleteOnClose);
  auto* column = new QVBoxLayout(popover);
  column->setContentsMargins(12, 12, 12, 12);
  column->setSpacing(8);
  for (const QString& sentence : warnings_) {
    auto* label = new QLabel(sentence);
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(true);
    label->setFixedWidth(kPopoverText);
    column->addWidget(label);
  }
  auto* inputs = named(new QPushButton(iconOf(Icon::kInfo), textOf(Step::kInputs)), "showInputs",
                       helpOf(Step::kInputs));
  column->addWidget(inputs, 0, Qt::AlignRight);
  connect(inputs, &QPushButton::clicked, popover, &QWidget::close);
  connect(inputs, &QPushButton::clicked, this, [this] { Q_EMIT stepRequested(Step::kInputs); });
  popover->adjustSize();
  popover->move(badge_->mapToGlobal(
      QPoint(badge_->width() - popover->width(), badge_->height() + kPopoverGap)));
  popover->show();
}

/// The bar has room for two lines; a longer sentence is whole in the tool tip.
void VerdictBar::elide() {
  layout()->activate();
  const QFontMetrics metrics = sentence_->fontMetrics();
  const auto fits = [&](const QString& text) {
    const QRect line(0, 0, sentence_->width(), 1);
    const int height = metrics.boundingRect(line, Qt::TextWordWrap, text).height();
    return 2 * height < 5 * metrics.lineSpacing();  // two lines, however they are rounded
  };
  QString shown = verdict_.sentence;
  for (int width = 2 * sentence_->width(); !fits(shown) && width > 0; width -= kElideStep)
    shown = metrics.elidedText(verdict_.sentence, Qt::ElideRight, width);
  sentence_->setText(shown);
  sentence_->setToolTip(shown == verdict_.sentence ? QString() : verdict_.sentence);
}

void VerdictBar::resizeEvent(QResizeEvent* event) {
  QFrame::resizeEvent(event);
  const bool narrow = event->size().width() < kWideWindow;
  const bool was_narrow = event->oldSize().width() < kWideWindow;
  if (narrow != was_narrow) showOthers();
  elide();
}

}  // namespace boresight::ui
