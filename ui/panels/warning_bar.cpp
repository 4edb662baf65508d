// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/warning_bar.h"

#include <QtWidgets>

#include "ui/panels/widgets.h"
#include "ui/plots/plot_colors.h"

namespace boresight::ui {
namespace {

constexpr int kMostShown = 2;

}  // namespace

WarningBar::WarningBar(const QString& action, const QString& tip, QWidget* parent)
    : QFrame(parent) {
  setFrameShape(QFrame::StyledPanel);
  setAutoFillBackground(true);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 3, 4, 3);
  text_ = named(new QLabel(this), "warning");
  text_->setWordWrap(true);
  text_->setTextFormat(Qt::PlainText);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  row->addWidget(text_, 1);
  auto* button = named(new QToolButton(this), "warningAction", tip);
  button->setText(action);
  row->addWidget(button);
  connect(button, &QToolButton::clicked, this, &WarningBar::actionRequested);
  applyPalette();
  hide();
}

void WarningBar::setSentences(const QStringList& sentences) {
  QStringList shown = sentences.mid(0, kMostShown);
  for (QString& each : shown) each.prepend(QStringLiteral("⚠ "));
  const int more = static_cast<int>(sentences.size()) - kMostShown;
  if (more > 0) shown.append(tr("and %1 more").arg(more));
  text_->setText(shown.join(QLatin1Char('\n')));
  text_->setToolTip(sentences.join(QLatin1Char('\n')));
  setVisible(!sentences.isEmpty());
}

QString WarningBar::text() const { return text_->text(); }

void WarningBar::applyPalette() {
  tinting_ = true;
  const QPalette base = QApplication::palette();
  setPalette(tinted(base, plotColors(base).second));
  tinting_ = false;
}

void WarningBar::changeEvent(QEvent* event) {
  QFrame::changeEvent(event);
  const bool look =
      event->type() == QEvent::ApplicationPaletteChange || event->type() == QEvent::StyleChange;
  if (look && !tinting_ && text_ != nullptr) applyPalette();
}

}  // namespace boresight::ui
