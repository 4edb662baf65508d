// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/canvas_frame.h"

#include <utility>

#include <QtWidgets>

#include "ui/style/tokens.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

struct FrameLook {
  const char* name;  ///< in the style sheet
  int width_px;
};
/// In the order of `CanvasSource`.
constexpr FrameLook kFrames[] = {
    {"", 0}, {"onboard", kOnboardFrame_px}, {"ground", kGroundFrame_px}};
static_assert(std::size(kFrames) == static_cast<std::size_t>(CanvasSource::kGround) + 1);

}  // namespace

CanvasFrame::CanvasFrame(QWidget& canvas, QWidget* parent)
    : QFrame(parent), head_(named(new QLabel, "canvasHead")) {
  setObjectName(QStringLiteral("canvasFrame"));
  auto* column = withoutMargins(new QVBoxLayout(this));
  column->addWidget(head_);
  column->addWidget(&canvas, 1);
  head_->setFixedHeight(kPanelHeadHeight);
  setSource(CanvasSource::kOnly);
}

void CanvasFrame::setSource(CanvasSource source) {
  if (source == source_) return;
  source_ = source;
  const bool onboard = source == CanvasSource::kOnboard;
  const auto& [name, margin] = kFrames[static_cast<std::size_t>(source)];
  setProperty("source", QLatin1String(name));
  head_->setProperty("source", QLatin1String(name));
  head_->setVisible(source != CanvasSource::kOnly);
  head_->setText(onboard ? tr("ONBOARD    as the spacecraft computed it; record read only")
                         : tr("GROUND    run here"));
  layout()->setContentsMargins(margin, onboard ? 0 : margin, margin, margin);
  restyle({this, head_});
  update();
}

}  // namespace boresight::ui
