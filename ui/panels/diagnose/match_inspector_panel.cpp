// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/diagnose/match_inspector_panel.h"

#include <QtWidgets>

#include "sessions/evaluation/pose_error.h"
#include "sessions/trace/sample_statistics.h"
#include "ui/models/text.h"
#include "ui/plots/plots.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr int kBins = 41;
constexpr int kHistogramHeight = 320;

/// Places and their share of all.
QString placesText(int count, double share) {
  return MatchInspectorPanel::tr("%1 (%2 %)").arg(count).arg(numberText(100.0 * share, 0));
}

QVector<int> asVector(const std::vector<std::int32_t>& counts) {
  return QVector<int>(counts.begin(), counts.end());
}

/// As high as its rows.
void fitHeight(QTableWidget& table) {
  table.setFixedHeight(table.horizontalHeader()->sizeHint().height() +
                       table.verticalHeader()->length() + 2 * table.frameWidth());
}

}  // namespace

MatchInspectorPanel::MatchInspectorPanel(ViewState& view) : view_(view) {
  filter_.setSourceModel(&model_);
  ui_.setupUi(this);
  ui_.splitter->setStretchFactor(0, 1);
  ui_.splitter->setStretchFactor(1, 3);
  ui_.splitter->setSizes({110, 600});
  setUpTable(*ui_.templates, filter_);
  ui_.templates->sortByColumn(TemplatesModel::kNumber, Qt::AscendingOrder);
  ui_.show->addItems(TemplatesModel::showNames());
  for (QTableWidget* table : {ui_.edges, ui_.directions}) {
    styleTable(*table);
    table->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
    table->horizontalHeader()->setSectionResizeMode(0, QHeaderView::Stretch);
  }
  histogram_ =
      new HistogramPlot(tr("residual along the edge's normal, px"), tr("found"), tr("used"));
  histogram_->setToolTip(
      tr("Distance of the image's edges from the rendered edges after this refinement, in pixels "
         "of the full image. A good pose has a narrow peak at 0."));
  histogram_->setMaximumHeight(kHistogramHeight);
  ui_.refinementRow->insertWidget(2, histogram_, 1);
  connect(ui_.showMatches, &QPushButton::clicked, this, [this] {
    if (const auto matched = lastMatched()) view_.setCursor({*matched, Stage::kFinished});
  });
  connect(ui_.show, kIndexChanged, this, [this](int index) {
    showing_ = true;
    filter_.setCondition([this, show = static_cast<TemplatesModel::Show>(index)](int source_row) {
      return model_.isShown(source_row, show);
    });
    showing_ = false;
    showCount();
    showTemplate();
  });
  connect(ui_.templates->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          [this](const QModelIndex& current) {
            if (!showing_ && current.isValid())
              view_.selectTemplate(filter_.mapToSource(current).row());
          });
  view_.onChange(ViewChange::kSnapshot | ViewChange::kCursor, this,
                 &MatchInspectorPanel::showIteration);
  view_.onChange(ViewChange::kTemplate, this, &MatchInspectorPanel::showTemplate);
  showIteration();
}

void MatchInspectorPanel::showCount() {
  ui_.count->setText(tr("%1 of %2").arg(filter_.rowCount()).arg(model_.rowCount()));
}

void MatchInspectorPanel::showIteration() {
  const auto next = view_.iteration();
  if (next != iteration_ || !next) {
    iteration_ = next;
    showing_ = true;
    model_.setIteration(iteration_.get());
    showing_ = false;
    ui_.templates->resizeColumnsToContents();
    showCount();
  }
  const bool refines = iteration_ && iteration_->kind == IterationKind::kRefine;
  if (refines && iteration_->reached >= Stage::kRefine) {
    showRefinement();
    ui_.pages->setCurrentWidget(ui_.refinement);
  } else if (model_.rowCount() > 0) {
    ui_.pages->setCurrentWidget(ui_.matches);
  } else {
    ui_.hint->setText(!view_.snapshot() ? tr("No run yet.")
                      : !iteration_     ? tr("The seed has no matches; select an iteration.")
                                        : tr("This iteration has no templates yet."));
    ui_.pages->setCurrentWidget(ui_.nothing);
  }
  showTemplate();
}

/// The last iteration up to the shown one that has templates.
std::optional<int> MatchInspectorPanel::lastMatched() const {
  const auto& run = view_.snapshot();
  for (int i = run ? view_.cursor().iteration : -1; i >= 0; --i)
    if (!run->iterations[static_cast<std::size_t>(i)]->templates.empty()) return i;
  return std::nullopt;
}

/// Shares by kind of edge, and distances of the image's edges.
void MatchInspectorPanel::showRefinement() {
  const auto statistics = sessions::sampleStatistics(*iteration_, kBins);
  const auto add = [this](const QString& name, const sessions::SampleCounts& counts) {
    addRow(*ui_.edges,
           {name, QString::number(counts.places), placesText(counts.found, counts.foundShare()),
            placesText(counts.used, counts.usedShare())});
  };
  ui_.edges->setRowCount(0);
  add(tr("all"), statistics.all);
  add(tr("outline"), statistics.border);
  add(tr("occluding"), statistics.occluding);
  add(tr("creases"), statistics.creases);
  fitHeight(*ui_.edges);
  showDirections();
  ui_.showMatches->setEnabled(lastMatched().has_value());
  histogram_->setCounts(statistics.radius_px, asVector(statistics.found_in_bin),
                        asVector(statistics.used_in_bin));
}

/// How far the refinement moved the pose, and how well its edges determine it.
void MatchInspectorPanel::showDirections() {
  const sessions::PoseError moved = sessions::poseError(
      iteration_->camera_from_station_before, iteration_->camera_from_station, std::nullopt);
  const auto sigma = sessions::poseSigma(iteration_->refinement.covariance, std::nullopt);
  const auto add = [&](const QString& name, double corrected, double sigma_value,
                       const QString& unit) {
    addRow(*ui_.directions,
           {name, QStringLiteral("%1 %2").arg(numberText(corrected, 3), unit),
            sigma ? QStringLiteral("%1 %2").arg(numberText(sigma_value, 3), unit) : tr("unknown")});
  };
  const sessions::PoseSigma known = sigma.value_or(sessions::PoseSigma());
  ui_.directions->setRowCount(0);
  add(tr("along the view axis"), moved.normal_mm, known.normal_mm, tr("mm"));
  add(tr("across it"), moved.lateral_mm, known.lateral_mm, tr("mm"));
  add(tr("tilt of the axis"), moved.rotation_mrad, known.out_of_plane_mrad, tr("mrad"));
  add(tr("twist about it"), moved.in_plane_mrad, known.rotation_mrad.z(), tr("mrad"));
  fitHeight(*ui_.directions);
}

void MatchInspectorPanel::showTemplate() {
  const int selected = view_.selectedTemplate();
  followRow(*ui_.templates, filter_.mapFromSource(model_.index(selected, 0)), showing_);
  const auto* run = view_.snapshot().get();
  if (selected >= 0 && selected < model_.rowCount() && run && run->edges)
    ui_.match->showMatch(run->edges, iteration_, selected);
  else
    ui_.match->showNote(tr("Select a template in the table or in the image."));
}

}  // namespace boresight::ui
