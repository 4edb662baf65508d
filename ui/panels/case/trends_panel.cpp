// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/trends_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include <QtWidgets>

#include "sessions/session/session_difference.h"
#include "sessions/session/session_document.h"
#include "ui/models/text.h"
#include "ui/plots/plots.h"
#include "ui/state/document.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

using sessions::kTrendFigures;
using sessions::TrendPoint;

constexpr auto kResidual = static_cast<std::size_t>(sessions::TrendFigure::kResidual);

/// In the order of `TrendFigure`.
constexpr std::array<const char*, kTrendFigures> kFigureTitles = {
    QT_TR_NOOP("x, mm"),    QT_TR_NOOP("y, mm"),    QT_TR_NOOP("z, mm"),  QT_TR_NOOP("rx, mrad"),
    QT_TR_NOOP("ry, mrad"), QT_TR_NOOP("rz, mrad"), QT_TR_NOOP("RMS, px")};

std::vector<TableColumn<TrendPoint>> trendColumns() {
  constexpr auto tr = [](const char* text) { return TrendsModel::tr(text); };
  std::vector<TableColumn<TrendPoint>> columns = {
      {tr("Case"), tr("A case whose last run converged."), -1,
       [](const TrendPoint& point) { return fromText(point.case_id); }}};
  for (std::size_t figure = 0; figure < kTrendFigures; ++figure)
    columns.push_back(
        {tr(kFigureTitles[figure]),
         figure == kResidual
             ? tr("Residual of the last iteration. !: outlier among the runs of its station.")
             : tr("Correction along or about an axis of the end effector, else of the camera. !: "
                  "outlier among the runs of its station."),
         3, [figure](const TrendPoint& point) { return point.figures[figure]; }});
  columns.push_back({tr("Review"), tr("Review status of the case."), -1,
                     [](const TrendPoint& point) { return fromText(point.review); }});
  return columns;
}

}  // namespace

TrendsModel::TrendsModel() : RowsModel(trendColumns()) {}

QVariant TrendsModel::look(const TrendPoint& row, int column, int role) const {
  const int figure = column - kFirstFigure;
  const bool outlier = figure >= 0 && figure < static_cast<int>(kTrendFigures) &&
                       row.outlier[static_cast<std::size_t>(figure)];
  if (role == Qt::DisplayRole && outlier)
    return tr("%1 !").arg(numberText(row.figures[static_cast<std::size_t>(figure)], 3));
  if (role == Qt::FontRole && outlier) return boldFont();
  if (role == Qt::ToolTipRole && column == kCase)
    return QStringLiteral("%1\n%2 %3")
        .arg(fromText(row.session.string()), fromText(row.station), fromText(row.time));
  return {};
}

TrendsPanel::TrendsPanel(Document& document) : document_(document) {
  ui_.setupUi(this);
  setUpTable(*ui_.trendTable, model_);
  for (std::size_t figure = 0; figure < kResidual; ++figure)
    ui_.trendFigure->addItem(TrendsModel::tr(kFigureTitles[figure]));
  connect(ui_.trendFigure, kIndexChanged, this, &TrendsPanel::showFigure);
  connect(ui_.addSessions, &QPushButton::clicked, this, &TrendsPanel::askForEarlier);
  connect(ui_.trendTable, &QTableView::activated, this, [this](const QModelIndex& index) {
    const TrendPoint& point = model_.at(index.row());
    if (point.session == document_.file()) Q_EMIT openRequested(fromText(point.case_id));
  });
  connect(ui_.trendTable->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          [this](const QModelIndex& current) {
            if (plot_) plot_->setMarked(current.row());
          });
  connect(&document_, &Document::left, this, [this] { earlier_.clear(); });
  connectEach(document_, this, &TrendsPanel::follow, &Document::opened, &Document::changed);
  take({});
}

/// Files that are chosen again may have changed.
void TrendsPanel::setEarlier(std::vector<std::filesystem::path> files) {
  earlier_ = std::move(files);
  read_files_.clear();
  follow();
}

/// Whether the trend is of the last runs that the session has now. Walks what was changed.
bool TrendsPanel::isRead() const {
  const sessions::Session& current = document_.session();
  return std::ranges::none_of(
      sessions::differenceOf(read_session_, current).cases, [&](const std::string& id) {
        const sessions::RunRecord* before = read_session_.lastRunOf(id);
        const sessions::RunRecord* now = current.lastRunOf(id);
        return before && now ? before->digest != now->digest : before != now;
      });
}

/// Runs are read while they are looked at, once.
void TrendsPanel::follow() {
  if (!isVisible()) return;
  std::vector<std::filesystem::path> files = earlier_;
  files.push_back(document_.file());
  const bool is_read = isRead() && files == read_files_;
  read_session_ = document_.session();
  if (is_read) return;
  read_files_ = std::move(files);
  ui_.trendNote->setText(tr("Reading the runs ..."));
  reader_.replace(
      reading_,
      [session = document_.session(), file = document_.file(),
       earlier = earlier_](const std::stop_token& stop) {
        Trend trend;
        std::vector<std::string> remarks;
        const auto add = [&](const sessions::Session& one, const std::filesystem::path& path) {
          std::ranges::move(sessions::trendOf(one, path, remarks, stop),
                            std::back_inserter(trend.points));
        };
        for (const auto& path : earlier) {
          const auto one = sessions::SessionDocument::open(path, sessions::Access::kReadOnly);
          one.requireNothingUnsaved();
          add(one.session(), path);
        }
        add(session, file);
        sessions::flagOutliers(trend.points);
        for (const std::string& remark : remarks) trend.remarks << fromText(remark);
        return trend;
      },
      [this](const Trend& trend) { take(trend); },
      [this](const QString& problem) {
        take({});
        ui_.trendNote->setText(problem);
      });
}

void TrendsPanel::take(const Trend& trend) {
  const auto flagged = std::ranges::count_if(trend.points, &TrendPoint::flagged);
  QString note = trend.points.empty()
                     ? tr("No converged run yet.")
                     : tr("%1 of %2 runs stand out.").arg(flagged).arg(trend.points.size());
  if (!trend.points.empty() && !trend.remarks.isEmpty())
    note += tr(" %n case(s) without a converged run.", "", static_cast<int>(trend.remarks.size()));
  ui_.trendNote->setText(note);
  ui_.trendNote->setToolTip(trend.remarks.join(QLatin1Char('\n')));
  model_.setRows(trend.points, false);
  ui_.trendTable->resizeColumnsToContents();
  showFigure();
}

/// A plot has its quantities for life.
void TrendsPanel::showFigure() {
  const auto figure = static_cast<std::size_t>(std::max(0, ui_.trendFigure->currentIndex()));
  delete plot_;
  plot_ = new DoublePlot({TrendsModel::tr(kFigureTitles[figure])},
                         {TrendsModel::tr(kFigureTitles[kResidual])});
  plot_->canvas()->setToolTip(tr("Click to select a run."));
  plot_->setNames([](int place) { return QString::number(place + 1); });
  ui_.column->insertWidget(1, plot_, 1);
  QVector<QPointF> corrections;
  QVector<QPointF> residuals;
  for (int row = 0; row < model_.rowCount(); ++row) {
    const TrendPoint& point = model_.at(row);
    corrections.append({static_cast<double>(row), point.figures[figure]});
    residuals.append({static_cast<double>(row), point.figures[kResidual]});
  }
  plot_->setPoints(model_.rowCount(), corrections, residuals);
  plot_->setMarked(ui_.trendTable->currentIndex().row());
  connect(plot_, &DoublePlot::chosen, this,
          [this](int row) { ui_.trendTable->setCurrentIndex(model_.index(row, 0)); });
}

void TrendsPanel::askForEarlier() {
  const QStringList files = QFileDialog::getOpenFileNames(
      window(), tr("Earlier sessions"), fromText(document_.file().parent_path().string()),
      tr("Sessions (*.boresight.json)"));
  std::vector<std::filesystem::path> chosen;
  for (const QString& file : files) chosen.emplace_back(file.toStdString());
  std::ranges::sort(chosen);
  if (!chosen.empty()) setEarlier(std::move(chosen));
}

void TrendsPanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  follow();
}

}  // namespace boresight::ui
