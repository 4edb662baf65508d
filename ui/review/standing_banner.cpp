// SPDX-License-Identifier: Apache-2.0
#include "ui/review/standing_banner.h"

#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>

#include "ui/models/cases_model.h"
#include "ui/models/number_text.h"
#include "ui/panels/tint.h"
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

StandingBanner::StandingBanner(QWidget* parent) : QFrame(parent) {
  setFrameShape(QFrame::StyledPanel);
  setAutoFillBackground(true);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 2, 8, 2);
  sign_ = new QLabel(this);
  QFont large = font();
  large.setPointSizeF(1.4 * large.pointSizeF());
  large.setBold(true);
  sign_->setFont(large);
  row->addWidget(sign_);
  text_ = new QLabel(this);
  text_->setObjectName(QStringLiteral("caseStanding"));
  text_->setWordWrap(true);
  text_->setTextFormat(Qt::PlainText);
  text_->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  row->addWidget(text_, 1);
  clear();
}

QString StandingBanner::text() const { return text_->text(); }

void StandingBanner::setStanding(const sessions::Standing& standing) {
  // The decision that no longer holds stands out: somebody counted on it.
  const bool bad = standing.state == CaseStanding::kFailed ||
                   standing.state == CaseStanding::kRejected || !standing.dropped.empty();
  const Look look = standing.state == CaseStanding::kValidated ? Look::kGood
                    : bad                                      ? Look::kBad
                                                               : Look::kPlain;
  const QString sign = signOf(standing);
  QString text = fromText(sessions::standingText(standing));
  if (!text.isEmpty()) text[0] = text[0].toUpper();
  show(sign, text, look);
}

void StandingBanner::clear() { show({}, tr("No case is shown."), Look::kPlain); }

void StandingBanner::show(const QString& sign, const QString& text, Look look) {
  sign_->setText(sign);
  sign_->setVisible(!sign.isEmpty());
  text_->setText(text);
  text_->setToolTip(text);
  look_ = look;
  applyPalette();
}

void StandingBanner::applyPalette() {
  const QPalette& base = parentWidget() ? parentWidget()->palette() : palette();
  const PlotColors colors = plotColors(base);
  const QPalette look = look_ == Look::kGood  ? tinted(base, colors.first)
                        : look_ == Look::kBad ? tinted(base, colors.second)
                                              : base;
  if (palette().color(QPalette::Window) == look.color(QPalette::Window)) return;
  setPalette(look);
}

void StandingBanner::changeEvent(QEvent* event) {
  QFrame::changeEvent(event);
  if (event->type() == QEvent::ParentChange && text_ != nullptr) applyPalette();
}

}  // namespace boresight::ui
