// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/run/runs_panel.h"

#include <algorithm>

#include <QtWidgets>

#include "ui/models/text.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"

namespace boresight::ui {
namespace {

constexpr int kDigest = Qt::UserRole;
constexpr const char* kPinnedKey = "pinnedRuns";

enum Column { kPin, kTime, kStatus, kChanged, kMoved, kColumns };

QString runListKey() { return QStringLiteral("run list"); }

/// What makes the run differ from a plain one.
QString kindOf(const sessions::RunRecord& run) {
  if (run.together) return RunsPanel::tr("together with other cameras");
  if (run.rerun) return RunsPanel::tr("other options");
  return {};
}

}  // namespace

RunsPanel::RunsPanel(Document& document, ViewState& state, QWidget* parent)
    : QWidget(parent), document_(document), state_(state), list_(new QTreeWidget) {
  pinned_ = QSettings().value(QLatin1String(kPinnedKey)).toStringList();
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(list_);
  list_->setObjectName(QStringLiteral("runs"));
  list_->setColumnCount(kColumns);
  list_->setHeaderLabels({tr("Pin"), tr("Ended, UTC"), tr("Status"), tr("Changed"), tr("Moved")});
  list_->headerItem()->setToolTip(kChanged, tr("Inputs and options that changed since the run "
                                               "before it"));
  list_->headerItem()->setToolTip(kMoved, tr("Distance of its pose from the run before it, at the "
                                             "end effector, else at the camera; px: mean over the "
                                             "station"));
  list_->setRootIsDecorated(false);
  list_->setFrameShape(QFrame::NoFrame);
  list_->setContextMenuPolicy(Qt::CustomContextMenu);
  list_->setToolTip(tr("Double click opens a run; the context menu compares and pins it"));
  connect(list_, &QTreeWidget::itemActivated, this, [this] { Q_EMIT openRequested(chosen()); });
  connect(list_, &QWidget::customContextMenuRequested, this, &RunsPanel::showMenu);
  connect(&document_, &Document::opened, this, &RunsPanel::fill);
  connect(&document_, &Document::changed, this, &RunsPanel::fill);
  state_.onChange(ViewChange::kCase | ViewChange::kSnapshot, this, &RunsPanel::fill);
  fill();
}

std::string RunsPanel::chosen() const {
  const QTreeWidgetItem* item = list_->currentItem();
  return item ? item->data(kTime, kDigest).toString().toStdString() : std::string();
}

void RunsPanel::fill() {
  list_->clear();
  const std::string shown_case = shownCaseId(document_, state_);
  std::vector<const sessions::RunRecord*> runs;
  std::vector<sessions::RunRecord> in_order;
  for (const sessions::RunRecord& run : document_.session().runs)
    if (run.case_id == shown_case) {
      runs.push_back(&run);
      in_order.push_back(run);
    }
  askForLines(in_order);
  std::reverse(runs.begin(), runs.end());
  const auto is_pinned = [this](const sessions::RunRecord* run) {
    return pinned_.contains(fromText(run->digest));
  };
  std::stable_partition(runs.begin(), runs.end(), is_pinned);
  for (const sessions::RunRecord* run : runs) {
    auto* item = new QTreeWidgetItem(list_);
    item->setText(kPin, is_pinned(run) ? QStringLiteral("\u25C6") : QString());
    item->setText(kTime, timeText(run->time));
    item->setText(kStatus, fromText(run->status).replace(QLatin1Char('_'), QLatin1Char(' ')));
    item->setText(kChanged, kindOf(*run));
    item->setData(kTime, kDigest, fromText(run->digest));
    if (!state_.snapshot() || state_.snapshot()->digest != run->digest) continue;
    QFont bold = font();
    bold.setBold(true);
    for (int i = 0; i < kColumns; ++i) item->setFont(i, bold);
    list_->setCurrentItem(item);
  }
  showLines();
}

/// Traces are read: once for a list of runs, while it is looked at.
void RunsPanel::askForLines(const std::vector<sessions::RunRecord>& runs) {
  if (runs == read_ || !isVisible() || !state_.currentCase()) return;
  read_ = runs;
  lines_.clear();
  reader_.start(
      runListKey(),
      [runs, loaded = state_.currentCase()](const std::stop_token& stop) {
        return sessions::runListLines(runs, *loaded, stop);
      },
      [this](std::vector<sessions::RunListLine> lines) {
        lines_ = std::move(lines);
        showLines();
      });
}

void RunsPanel::showLines() {
  for (int row = 0; row < list_->topLevelItemCount(); ++row) {
    QTreeWidgetItem& item = *list_->topLevelItem(row);
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
  for (int i = 0; i < kColumns; ++i) list_->resizeColumnToContents(i);
}

void RunsPanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  fill();
}

void RunsPanel::pin(const std::string& digest) {
  const QString text = fromText(digest);
  if (!pinned_.removeOne(text)) pinned_ << text;
  QSettings().setValue(QLatin1String(kPinnedKey), pinned_);
  fill();
}

void RunsPanel::showMenu(const QPoint& at) {
  if (!list_->itemAt(at)) return;
  const std::string digest = chosen();
  QMenu menu(this);
  menu.addAction(tr("Open"), this, [this, digest] { Q_EMIT openRequested(digest); });
  menu.addAction(tr("Compare side by side"), this,
                 [this, digest] { Q_EMIT compareRequested(digest); });
  menu.addAction(pinned_.contains(fromText(digest)) ? tr("Unpin") : tr("Pin"), this,
                 [this, digest] { pin(digest); });
  menu.exec(list_->viewport()->mapToGlobal(at));
}

}  // namespace boresight::ui
