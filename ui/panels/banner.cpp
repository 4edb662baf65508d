// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/banner.h"

#include <QtWidgets>

#include "sessions/run/run_text.h"
#include "ui/models/cases_model.h"
#include "ui/models/number_text.h"
#include "ui/plots/plot_colors.h"

namespace boresight::ui {

using sessions::CaseStanding;

namespace {

/// A tick beside "NOT VALIDATED" would be read as a yes: what converged, but nobody vouches for, is
/// an open circle here.
QString signOf(const sessions::Standing& standing) {
  if (!standing.dropped.empty()) return QStringLiteral("⚠");
  const bool open =
      standing.state == CaseStanding::kConverged || standing.state == CaseStanding::kAnnotated;
  return CasesModel::stateText(open ? CaseState::kNew : caseStateOf(standing.state)).left(1);
}

}  // namespace

Banner::Banner(const QString& name, QWidget* parent) : QFrame(parent) {
  setFrameShape(QFrame::StyledPanel);
  setAutoFillBackground(true);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 3, 8, 3);
  sign_ = new QLabel(this);
  QFont large = font();
  large.setPointSizeF(1.4 * large.pointSizeF());
  large.setBold(true);
  sign_->setFont(large);
  row->addWidget(sign_);
  text_ = new QLabel(this);
  text_->setObjectName(name);
  text_->setWordWrap(true);
  text_->setTextFormat(Qt::PlainText);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  row->addWidget(text_, 1);
}

QString Banner::text() const { return text_->text(); }

void Banner::showRun(const sessions::LocalizationTrace* run) {
  if (run == nullptr) {
    show(QStringLiteral("○"), tr("Nothing has run yet."), Tone::kPlain);
    return;
  }
  const QString text = fromText(sessions::standingText(*run));
  if (run->converged())
    show(QStringLiteral("✓"), text, Tone::kGood);
  else if (run->finished)
    show(QStringLiteral("✗"), text, Tone::kBad);
  else
    show(QStringLiteral("…"), text, Tone::kPlain);
}

void Banner::showStanding(const sessions::Standing* standing) {
  if (standing == nullptr) {
    show({}, tr("No case is shown."), Tone::kPlain);
    return;
  }
  // The decision that no longer holds stands out: somebody counted on it.
  const bool bad = standing->state == CaseStanding::kFailed ||
                   standing->state == CaseStanding::kRejected || !standing->dropped.empty();
  QString text = fromText(sessions::standingText(*standing));
  if (!text.isEmpty()) text[0] = text[0].toUpper();
  show(signOf(*standing), text,
       standing->state == CaseStanding::kValidated ? Tone::kGood
       : bad                                       ? Tone::kBad
                                                   : Tone::kPlain);
}

void Banner::show(const QString& sign, const QString& text, Tone tone) {
  sign_->setText(sign);
  sign_->setVisible(!sign.isEmpty());
  text_->setText(text);
  text_->setToolTip(text);
  tone_ = tone;
  applyPalette();
}

void Banner::applyPalette() {
  const QPalette& base = parentWidget() ? parentWidget()->palette() : palette();
  const PlotColors colors = plotColors(base);
  const QPalette look = tone_ == Tone::kGood  ? tinted(base, colors.first)
                        : tone_ == Tone::kBad ? tinted(base, colors.second)
                                              : base;
  if (palette().color(QPalette::Window) != look.color(QPalette::Window)) setPalette(look);
}

void Banner::changeEvent(QEvent* event) {
  QFrame::changeEvent(event);
  if (event->type() == QEvent::ParentChange && text_ != nullptr) applyPalette();
}

}  // namespace boresight::ui
