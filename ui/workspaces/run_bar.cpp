// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/run_bar.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <QtWidgets>

#include "ui/models/text.h"
#include "ui/panels/diagnose/iterations_panel.h"
#include "ui/state/view_state.h"
#include "ui/style/theme.h"
#include "ui/style/tokens.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr int kNarrowHeight = 36;  // the image keeps 40 % of a screen of 1280 x 800
constexpr int kWideHeight = 48;
constexpr double kDot = 2.5;
/// Smaller moves look alike: they are far below any requirement.
constexpr double kLeastMove_m = 1e-7;

/// "Moved 17.3 → 0.015 mm": by the first and by the shown iteration.
QString correctionText(const ViewState& state) {
  const auto shown = state.iteration();
  if (!shown) return {};
  const auto& first = *state.snapshot()->iterations.front();
  return RunBar::tr("Moved %1 → %2 mm")
      .arg(numberText(1e3 * first.correction_translation_m, 1),
           numberText(1e3 * shown->correction_translation_m, 3));
}

/// Corrections of the shown run's iterations: a line with a dot per iteration, on a logarithmic
/// scale; the shown iteration's dot is filled.
class CorrectionLine final : public QWidget {
 public:
  explicit CorrectionLine(ViewState& state) : state_(state) {
    setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Preferred);
    setObjectName(QStringLiteral("correctionLine"));
    setToolTip(RunBar::tr("Translation by each iteration, logarithmic"));
    setAccessibleName(toolTip());
    state_.onChange(ViewChange::kSnapshot | ViewChange::kCursor, this, [this] { update(); });
  }

  QSize sizeHint() const override { return {120, 32}; }

 protected:
  void paintEvent(QPaintEvent*) override {
    const QVector<QPointF> line = places();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QColor color(theme().accent);
    painter.setPen(QPen(color, 1.5));
    painter.drawPolyline(line.data(), line.size());
    for (int i = 0; i < line.size(); ++i) {
      painter.setBrush(i == state_.cursor().iteration ? color : QColor(theme().panel));
      painter.drawEllipse(line[i], kDot, kDot);
    }
  }

 private:
  QVector<QPointF> places() const {
    std::vector<double> heights;
    if (state_.snapshot())
      for (const auto& iteration : state_.snapshot()->iterations)
        heights.push_back(std::log10(std::max(kLeastMove_m, iteration->correction_translation_m)));
    if (heights.size() < 2) return {};
    const auto [least, most] = std::minmax_element(heights.begin(), heights.end());
    const double span = std::max(1e-9, *most - *least);
    const QRectF area = QRectF(rect()).adjusted(4.0, 8.0, -4.0, -8.0);
    QVector<QPointF> places;
    for (std::size_t i = 0; i < heights.size(); ++i)
      places << QPointF(area.left() + area.width() * static_cast<double>(i) /
                                          static_cast<double>(heights.size() - 1),
                        area.bottom() - area.height() * (heights[i] - *least) / span);
    return places;
  }

  ViewState& state_;
};

}  // namespace

RunBar::RunBar(ViewState& state, QWidget* parent)
    : QFrame(parent),
      state_(state),
      buttons_(new QHBoxLayout),
      scrubber_(new RunScrubber(state)),
      correction_(named(new QLabel, "runCorrection",
                        tr("Translation by the first iteration, and by the shown one"))),
      corrections_(new CorrectionLine(state)) {
  setObjectName(QStringLiteral("runBar"));
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 0, 8, 0);
  row->setSpacing(8);
  buttons_->setSpacing(4);
  row->addLayout(buttons_);
  row->addWidget(scrubber_, 1);
  row->addWidget(correction_);
  row->addWidget(corrections_);
  state_.onChange(ViewChange::kSnapshot | ViewChange::kCursor, this, &RunBar::showCursor);
  setNarrow(false);
}

void RunBar::setActions(const QList<QAction*>& actions) {
  for (QAction* action : actions) {
    auto* button = new QToolButton;
    button->setDefaultAction(action);
    button->setAutoRaise(true);
    button->setIconSize(QSize(kIcon, kIcon));
    buttons_->addWidget(button);
    run_buttons_ << button;
  }
  setNarrow(narrow_);
}

void RunBar::setNarrow(bool narrow) {
  narrow_ = narrow;
  setFixedHeight(narrow ? kNarrowHeight : kWideHeight);
  for (QToolButton* button : run_buttons_)
    button->setToolButtonStyle(narrow ? Qt::ToolButtonIconOnly : Qt::ToolButtonTextBesideIcon);
  showCursor();
}

int RunBar::widthOfCorrections() const {
  return correction_->sizeHint().width() + corrections_->sizeHint().width() +
         2 * layout()->spacing();
}

QSize RunBar::minimumSizeHint() const {
  QSize least = QFrame::minimumSizeHint();
  if (correction_->isVisibleTo(this)) least.rwidth() -= widthOfCorrections();
  return least;
}

void RunBar::resizeEvent(QResizeEvent* event) {
  QFrame::resizeEvent(event);
  showCursor();
}

void RunBar::showCursor() {
  correction_->setText(correctionText(state_));
  const bool room = width() >= minimumSizeHint().width() + widthOfCorrections();
  correction_->setVisible(!narrow_ && room && !correction_->text().isEmpty());
  corrections_->setVisible(correction_->isVisibleTo(this));
}

}  // namespace boresight::ui
