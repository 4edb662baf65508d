// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/canvas_frame.h"

#include <QtWidgets>

#include "ui/style/tokens.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

CanvasFrame::CanvasFrame(QWidget& canvas, QWidget* parent)
    : QFrame(parent), head_(named(new QLabel, "canvasHead")) {
  setObjectName(QStringLiteral("canvasFrame"));
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(head_);
  column->addWidget(&canvas, 1);
  head_->setFixedHeight(kPanelHeadHeight);
  setSource(CanvasSource::kOnly);
}

void CanvasFrame::setSource(CanvasSource source) {
  if (source == source_) return;
  source_ = source;
  const bool onboard = source == CanvasSource::kOnboard;
  const QString name = onboard                           ? QStringLiteral("onboard")
                       : source == CanvasSource::kGround ? QStringLiteral("ground")
                                                         : QString();
  const int margin = onboard                           ? kOnboardFrame_px
                     : source == CanvasSource::kGround ? kGroundFrame_px
                                                       : 0;
  setProperty("source", name);
  head_->setProperty("source", name);
  head_->setVisible(source != CanvasSource::kOnly);
  head_->setText(onboard ? tr("ONBOARD    as the spacecraft computed it; record read only")
                         : tr("GROUND    run here"));
  layout()->setContentsMargins(margin, onboard ? 0 : margin, margin, margin);
  for (QWidget* each : std::initializer_list<QWidget*>{this, head_}) {
    each->style()->unpolish(each);
    each->style()->polish(each);
  }
  update();
}

}  // namespace boresight::ui
