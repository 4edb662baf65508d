// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/run_banner.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>

#include "sessions/run/run_text.h"
#include "ui/models/number_text.h"
#include "ui/panels/tint.h"
#include "ui/plots/plot_colors.h"

namespace boresight::ui {

RunBanner::RunBanner(QWidget* parent) : QFrame(parent) {
  setFrameShape(QFrame::StyledPanel);
  setAutoFillBackground(true);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 4, 8, 4);
  sign_ = new QLabel(this);
  QFont large = font();
  large.setPointSizeF(1.4 * large.pointSizeF());
  large.setBold(true);
  sign_->setFont(large);
  row->addWidget(sign_);
  text_ = new QLabel(this);
  text_->setObjectName(QStringLiteral("standing"));
  text_->setWordWrap(true);
  text_->setTextFormat(Qt::PlainText);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  row->addWidget(text_, 1);
  setSnapshot(nullptr);
}

QString RunBanner::text() const { return text_->text(); }

void RunBanner::setSnapshot(const sessions::LocalizationTrace* snapshot) {
  if (snapshot == nullptr) {
    kind_ = Kind::kNone;
    text_->setText(tr("Nothing has run yet."));
  } else {
    kind_ = snapshot->converged() ? Kind::kConverged
            : snapshot->finished  ? Kind::kFailed
                                  : Kind::kUnderWay;
    text_->setText(fromText(sessions::standingText(*snapshot)));
  }
  sign_->setText(kind_ == Kind::kConverged ? QStringLiteral("✓")
                 : kind_ == Kind::kFailed  ? QStringLiteral("✗")
                 : kind_ == Kind::kNone    ? QStringLiteral("○")
                                           : QStringLiteral("…"));
  applyPalette();
}

void RunBanner::applyPalette() {
  const QPalette& base = parentWidget() ? parentWidget()->palette() : palette();
  const PlotColors colors = plotColors(base);
  const QPalette look = kind_ == Kind::kConverged ? tinted(base, colors.first)
                        : kind_ == Kind::kFailed  ? tinted(base, colors.second)
                                                  : base;
  if (palette().color(QPalette::Window) == look.color(QPalette::Window)) return;
  setPalette(look);
}

void RunBanner::changeEvent(QEvent* event) {
  QFrame::changeEvent(event);
  if (event->type() == QEvent::ParentChange && text_ != nullptr) applyPalette();
}

}  // namespace boresight::ui
