// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/run/runs_panel.h"

#include <algorithm>
#include <iterator>

#include <QtWidgets>

#include "ui/models/rows_model.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

constexpr int kDigest = Qt::UserRole;
constexpr const char* kPinnedKey = "pinnedRuns";

enum RunColumn { kPin, kTime, kStatus, kChanged, kMoved, kRunColumns };

constexpr int kMostPins = 500;

/// Of this program and of others that run meanwhile.
QStringList storedPins() { return QSettings().value(QLatin1String(kPinnedKey)).toStringList(); }

/// How the run differs from a plain one; empty for a plain run.
QString kindOf(const sessions::RunRecord& run) {
  if (run.together) return RunsPanel::tr("together with other cameras");
  if (run.rerun) return RunsPanel::tr("other options");
  return {};
}

}  // namespace

RunsPanel::RunsPanel(Document& document, ViewState& state) : document_(document), state_(state) {
  pinned_ = storedPins();
  ui_.setupUi(this);
  connect(ui_.runs, &QTreeWidget::itemActivated, this, [this] { Q_EMIT openRequested(chosen()); });
  connect(ui_.runs, &QWidget::customContextMenuRequested, this, &RunsPanel::showMenu);
  connectEach(document_, this, &RunsPanel::fill, &Document::opened, &Document::changed);
  state_.onChange(ViewChange::kCase | ViewChange::kSnapshot, this, &RunsPanel::fill);
  fill();
}

std::string RunsPanel::chosen() const {
  const QTreeWidgetItem* item = ui_.runs->currentItem();
  return item ? item->data(kTime, kDigest).toString().toStdString() : std::string();
}

void RunsPanel::fill() {
  const std::string shown_case = shownCaseId(document_, state_);
  std::vector<sessions::RunRecord> runs;
  for (const sessions::RunRecord* run : document_.session().runs.findAll(shown_case))
    runs.push_back(*run);
  askForLines(runs);
  const auto is_pinned = [this](const sessions::RunRecord& run) {
    return pinned_.contains(fromText(run.digest));
  };
  std::ranges::reverse(runs);
  std::ranges::stable_partition(runs, is_pinned);
  Listed now{runs, pinned_, {}};
  if (const auto& snapshot = state_.snapshot())
    for (const sessions::RunRecord& run : runs)
      if (run.digest == snapshot->digest) now.shown = run.digest;
  if (now == listed_) return;
  const bool same_shown = now.shown.empty() || now.shown == listed_.shown;
  const std::string selected = same_shown ? chosen() : now.shown;
  listed_ = std::move(now);
  ui_.runs->clear();
  for (const sessions::RunRecord& run : runs) {
    auto* item = new QTreeWidgetItem(ui_.runs);
    item->setText(kPin, is_pinned(run) ? QStringLiteral("\u25C6") : QString());
    item->setText(kTime, timeText(run.time));
    item->setText(kStatus, fromText(run.status).replace(QLatin1Char('_'), QLatin1Char(' ')));
    item->setText(kChanged, kindOf(run));
    item->setData(kTime, kDigest, fromText(run.digest));
    if (run.digest == selected) ui_.runs->setCurrentItem(item);
    if (run.digest != listed_.shown) continue;
    for (int i = 0; i < kRunColumns; ++i) item->setFont(i, boldFont(font()));
  }
  showLines();
}

/// Traces are read: once for a list of runs, while it is looked at.
void RunsPanel::askForLines(const std::vector<sessions::RunRecord>& runs) {
  if (runs == read_ || !isVisible() || !state_.currentCase()) return;
  read_ = runs;
  lines_.clear();
  reader_.replace(
      reading_,
      [runs, loaded = state_.currentCase()](const std::stop_token& stop) {
        return sessions::runListLines(runs, *loaded, stop);
      },
      [this](std::vector<sessions::RunListLine> lines) {
        lines_ = std::move(lines);
        showLines();
      },
      reportTo(this, &RunsPanel::failed));
}

void RunsPanel::showLines() {
  for (int row = 0; row < ui_.runs->topLevelItemCount(); ++row) {
    QTreeWidgetItem& item = *ui_.runs->topLevelItem(row);
    const std::string digest = item.data(kTime, kDigest).toString().toStdString();
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (read_[i].digest != digest) continue;
      QStringList changed = {kindOf(read_[i]), fromText(lines_[i].changed)};
      changed.removeAll(QString());
      item.setText(kChanged, changed.join(QStringLiteral(", ")));
      item.setToolTip(kChanged, item.text(kChanged));
      if (lines_[i].moved) item.setText(kMoved, fromText(poseDistanceText(*lines_[i].moved)));
    }
  }
  for (int i = 0; i < kRunColumns; ++i) ui_.runs->resizeColumnToContents(i);
}

void RunsPanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  fill();
}

void RunsPanel::pin(const std::string& digest) {
  const QString text = fromText(digest);
  pinned_ = storedPins();
  if (!pinned_.removeOne(text)) pinned_ << text;
  while (pinned_.size() > kMostPins) pinned_.removeFirst();
  QSettings().setValue(QLatin1String(kPinnedKey), pinned_);
  fill();
}

void RunsPanel::showMenu(const QPoint& at) {
  if (!ui_.runs->itemAt(at)) return;
  const std::string digest = chosen();
  QMenu menu(this);
  menu.addAction(tr("Open"), this, [this, digest] { Q_EMIT openRequested(digest); });
  menu.addAction(tr("Compare side by side"), this,
                 [this, digest] { Q_EMIT compareRequested(digest); });
  menu.addAction(pinned_.contains(fromText(digest)) ? tr("Unpin") : tr("Pin"), this,
                 [this, digest] { pin(digest); });
  menu.exec(ui_.runs->viewport()->mapToGlobal(at));
}

}  // namespace boresight::ui
