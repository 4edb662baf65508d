// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/refinement_view.h"

#include <QtWidgets>

#include "ui/models/number_text.h"
#include "ui/panels/widgets.h"
#include "ui/plots/histogram_plot.h"

namespace boresight::ui {
namespace {

constexpr int kBins = 41;
constexpr int kColumns = 4;

QVector<int> asVector(const std::vector<std::int32_t>& counts) {
  return QVector<int>(counts.begin(), counts.end());
}

/// Places and their share of all.
QString countText(int count, double share) {
  return RefinementView::tr("%1 (%2 %)").arg(count).arg(numberText(100.0 * share, 0));
}

}  // namespace

RefinementView::RefinementView(QWidget* parent) : QWidget(parent) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  table_ = new QTableWidget(4, kColumns, this);
  styleTable(*table_);
  table_->setSelectionMode(QAbstractItemView::NoSelection);
  table_->setFocusPolicy(Qt::NoFocus);
  table_->setHorizontalHeaderLabels({tr("Edges"), tr("Places"), tr("Found"), tr("Used")});
  const QStringList help = {
      tr("Kind of rendered edge."), tr("Places along rendered edges where the image was searched."),
      tr("Places with an image edge within the search radius, and their share."),
      tr("Places whose edge agrees with the others (weight above one half in the last round), and "
         "their share.")};
  for (int column = 0; column < kColumns; ++column)
    table_->horizontalHeaderItem(column)->setToolTip(help[column]);
  row->addWidget(table_);
  histogram_ =
      new HistogramPlot(tr("residual along the edge's normal, px"), tr("found"), tr("used"), this);
  histogram_->setToolTip(tr(
      "Where the image's edges lie, seen from the rendered ones after this refinement, in pixels "
      "of the full image. A good pose has a narrow heap at 0."));
  row->addWidget(histogram_, 1);
}

void RefinementView::fillRow(int row, const QString& name, const sessions::SampleCounts& counts) {
  const QStringList texts = {name, QString::number(counts.places),
                             countText(counts.found, counts.foundShare()),
                             countText(counts.used, counts.usedShare())};
  for (int column = 0; column < kColumns; ++column) {
    auto* item = new QTableWidgetItem(texts[column]);
    const Qt::Alignment side = column > 0 ? Qt::AlignRight : Qt::AlignLeft;
    item->setData(Qt::TextAlignmentRole, static_cast<int>(side | Qt::AlignVCenter));
    table_->setItem(row, column, item);
  }
}

void RefinementView::setIteration(const sessions::IterationTrace& iteration) {
  const sessions::SampleStatistics statistics = sessions::sampleStatistics(iteration, kBins);
  fillRow(0, tr("all"), statistics.all);
  fillRow(1, tr("outline"), statistics.border);
  fillRow(2, tr("occluding"), statistics.occluding);
  fillRow(3, tr("creases"), statistics.creases);
  table_->resizeColumnsToContents();
  table_->setFixedWidth(table_->horizontalHeader()->length() + 2 * table_->frameWidth());
  histogram_->setCounts(statistics.radius_px, asVector(statistics.found_in_bin),
                        asVector(statistics.used_in_bin));
}

}  // namespace boresight::ui
