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

struct ToneLook {
  const char* name;  ///< in the style sheet
  QRgb Theme::*color;
};
/// In the order of `VerdictTone`.
constexpr ToneLook kLooks[] = {
    {"plain", &Theme::accent},
    {"good", &Theme::success_text},
    {"bad", &Theme::failure_text},
    {"caution", &Theme::warning_text},
};
static_assert(std::size(kLooks) == static_cast<std::size_t>(VerdictTone::kCaution) + 1);

}  // namespace

VerdictBar::VerdictBar(QWidget* parent) : QFrame(parent), more_menu_(new QMenu(this)) {
  ui_.setupUi(this);
  setFixedHeight(kVerdictHeight);
  ui_.verdictIcon->setFixedSize(kToolIcon, kToolIcon);
  ui_.warningBadge->setIcon(iconOf(Icon::kWarning, &Theme::warning_text));
  ui_.verdictMore->setMenu(more_menu_);
  for (QWidget* each :
       std::initializer_list<QWidget*>{ui_.warningBadge, ui_.verdictMore, ui_.verdictAction})
    each->setFixedHeight(kButtonHeight);
  for (QPushButton* each : {ui_.warningBadge, ui_.verdictAction}) each->setIconSize(kButtonIcon);
  connect(ui_.warningBadge, &QPushButton::clicked, this, &VerdictBar::showWarnings);
  connect(ui_.verdictAction, &QPushButton::clicked, this,
          [this] { Q_EMIT stepRequested(verdict_.step); });
  ui_.verdictSentence->installEventFilter(this);
  setWarnings({});
  showVerdict();
}

/// Buttons that come and go change the room of the sentence, and not the bar's size.
bool VerdictBar::eventFilter(QObject* watched, QEvent* event) {
  if (watched == ui_.verdictSentence && event->type() == QEvent::Resize)
    QMetaObject::invokeMethod(
        this, [this] { elide(); }, Qt::QueuedConnection);
  return QFrame::eventFilter(watched, event);
}

void VerdictBar::setVerdict(const Verdict& verdict) {
  if (verdict == verdict_) return;  // a button that is pressed, and an open menu, stay
  verdict_ = verdict;
  showVerdict();
}

void VerdictBar::showVerdict() {
  const Verdict& verdict = verdict_;
  const ToneLook& look = kLooks[static_cast<std::size_t>(verdict.tone)];
  setProperty("tone", QLatin1String(look.name));
  const StepInfo step = stepInfo(verdict.step);
  ui_.verdictIcon->setIcon(verdict.icon, look.color);
  ui_.verdictHeadline->setText(verdict.head);
  ui_.verdictAction->setVisible(verdict.step != Step::kNone);
  ui_.verdictAction->setText(verdict.step_text.isEmpty() ? step.text : verdict.step_text);
  ui_.verdictAction->setToolTip(tr("%1 (Ctrl+Enter)").arg(step.help));
  ui_.verdictAction->setProperty("primary", !verdict.plain);
  ui_.verdictAction->setIcon(iconOf(step.icon, verdict.plain ? &Theme::text : &Theme::on_accent));
  setAccessibleName(text());
  showOthers();
  restyle({this, ui_.verdictHeadline, ui_.verdictAction});
  elide();
}

QString VerdictBar::text() const {
  return verdict_.sentence.isEmpty() ? verdict_.head
                                     : verdict_.head + QLatin1Char(' ') + verdict_.sentence;
}

void VerdictBar::showOthers() {
  clearLayout(*ui_.others);
  more_menu_->clear();
  const int shown = width() < kWideWindow ? kOthersNarrow : kOthersWide;
  for (std::size_t i = 0; i < verdict_.others.size(); ++i) {
    const Step step = verdict_.others[i];
    const auto ask = [this, step] { Q_EMIT stepRequested(step); };
    if (static_cast<int>(i) < shown) {
      auto* button = new QPushButton;
      showStep(*button, step);
      button->setFixedHeight(kButtonHeight);
      button->setIconSize(kButtonIcon);
      connect(button, &QPushButton::clicked, this, ask, Qt::QueuedConnection);
      ui_.others->addWidget(button);
    } else {
      QAction* each = more_menu_->addAction(QString());
      showStep(*each, step);
      connect(each, &QAction::triggered, this, ask, Qt::QueuedConnection);
    }
  }
  ui_.verdictMore->setVisible(!more_menu_->isEmpty());
}

void VerdictBar::setWarnings(const QStringList& sentences) {
  warnings_ = sentences;
  ui_.warningBadge->setVisible(!sentences.isEmpty());
  ui_.warningBadge->setText(sentences.size() == 1 ? tr("1 warning")
                                                  : tr("%1 warnings").arg(sentences.size()));
  ui_.warningBadge->setToolTip(sentences.join(QLatin1Char('\n')));
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
  auto* inputs = named(new QPushButton, "showInputs");
  showStep(*inputs, Step::kInputs);
  column->addWidget(inputs, 0, Qt::AlignRight);
  connect(inputs, &QPushButton::clicked, popover, &QWidget::close);
  connect(inputs, &QPushButton::clicked, this, [this] { Q_EMIT stepRequested(Step::kInputs); });
  popover->adjustSize();
  popover->move(ui_.warningBadge->mapToGlobal(QPoint(ui_.warningBadge->width() - popover->width(),
                                                     ui_.warningBadge->height() + kPopoverGap)));
  popover->show();
}

/// The bar has room for two lines; a longer sentence is whole in the tool tip.
void VerdictBar::elide() {
  layout()->activate();
  const QFontMetrics metrics = ui_.verdictSentence->fontMetrics();
  const auto fits = [&](const QString& text) {
    const QRect line(0, 0, ui_.verdictSentence->width(), 1);
    const int height = metrics.boundingRect(line, Qt::TextWordWrap, text).height();
    return 2 * height < 5 * metrics.lineSpacing();  // two lines, however they are rounded
  };
  QString shown = verdict_.sentence;
  for (int width = 2 * ui_.verdictSentence->width(); !fits(shown) && width > 0; width -= kElideStep)
    shown = metrics.elidedText(verdict_.sentence, Qt::ElideRight, width);
  ui_.verdictSentence->setText(shown);
  ui_.verdictSentence->setToolTip(shown == verdict_.sentence ? QString() : verdict_.sentence);
}

void VerdictBar::resizeEvent(QResizeEvent* event) {
  QFrame::resizeEvent(event);
  const bool narrow = event->size().width() < kWideWindow;
  const bool was_narrow = event->oldSize().width() < kWideWindow;
  if (narrow != was_narrow) showOthers();
  elide();
}

}  // namespace boresight::ui
