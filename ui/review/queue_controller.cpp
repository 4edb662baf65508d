// SPDX-License-Identifier: Apache-2.0
#include "ui/review/queue_controller.h"

#include <exception>
#include <vector>

#include "sessions/io/files/errors.h"
#include "sessions/review/thumbnail.h"
#include "sessions/session/case_run.h"
#include "ui/models/text.h"
#include "ui/state/document.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

using sessions::QueueRow;

namespace {

QImage toImage(const sessions::ColorImage& picture) {
  return QImage(picture.bgr.data(), picture.width, picture.height, 3 * picture.width,
                QImage::Format_BGR888)
      .copy();
}

/// The last run's pose if it has one, else the seed in its own colour.
QImage pictureOf(const sessions::LoadedCase& loaded, const QueueRow& row, const QSize& size_px) {
  const bool converged = row.subject && row.subject->run->converged();
  std::vector<sessions::OverlayLayer> layers;
  if (converged)
    layers.push_back({"", row.subject->camera_from_station, sessions::kResultColor, true});
  else if (loaded.source.has_seed)
    layers.push_back({"", loaded.source.camera_from_station_seed, sessions::kSeedColor, true});
  std::vector<Pose> framed;
  for (const sessions::OverlayLayer& layer : layers) framed.push_back(layer.camera_from_station);
  return toImage(sessions::stationPicture(loaded.image.view(), loaded.source.camera,
                                          loaded.scene.view(), framed, layers, size_px.width(),
                                          size_px.height()));
}

/// The row of a case from the session alone.
QueueRow plainRow(const sessions::Session& session, const std::string& id) {
  QueueRow row;
  row.case_id = id;
  if (const sessions::RunRecord* run = session.lastRunOf(id)) {
    row.run_digest = run->digest;
    if (run->status != "converged") row.trouble = "the run failed: " + run->status;
  }
  sessions::takeReviewStatus(session, row);
  return row;
}

/// A case whose checking threw has the message as its trouble.
QueueEntry checkedEntry(const sessions::Session& session, const std::string& id,
                        const QSize& size_px) {
  QueueEntry entry;
  try {
    std::shared_ptr<const sessions::LoadedCase> loaded;
    std::string reason;
    try {
      loaded = sessions::loadCase(*session.findCase(id));
    } catch (const sessions::FileError& error) {
      reason = error.what();
    }
    QueueRow row = sessions::queueRow(session, id, loaded, reason);
    if (loaded) entry.thumbnail = pictureOf(*loaded, row, size_px);
    entry.row = std::move(row);
  } catch (const std::exception& error) {
    entry.row.case_id = id;
    entry.row.trouble = error.what();
  }
  return entry;
}

DifferenceEntry comparedEntry(const sessions::Session& session, const std::string& id) {
  try {
    const auto pair = sessions::lastTwoRuns(session, id);
    return {id, sessions::compareRuns(session, pair->before->digest, pair->after->digest,
                                      sessions::loadCase(*session.findCase(id)))};
  } catch (const std::exception& error) {
    return {id, std::nullopt, fromText(error.what())};
  }
}

}  // namespace

QueueController::QueueController(Document& document, const QSize& thumbnail_px)
    : document_(document),
      rows_(
          [thumbnail_px](const sessions::Session& session, const std::string& id) {
            return checkedEntry(session, id, thumbnail_px);
          },
          [this] { Q_EMIT changed(); }),
      differences_(&comparedEntry, [this] { Q_EMIT changed(); }) {
  rows_.setOrder([this](const Rows::Entry& a, const Rows::Entry& b) {
    return sessions::moreTrouble(rowOf(a), rowOf(b));
  });
  connectEach(document_, this, &QueueController::follow, &Document::opened, &Document::changed);
}

void QueueController::setLookedAt(List list) {
  if (looked_at_ == list) return;
  looked_at_ = list;
  rows_.setActive(false);
  differences_.setActive(false);
  follow();  // before anything is made of what was looked at last
  fillVisible();
}

void QueueController::fillVisible() {
  rows_.setActive(looked_at_ == List::kTrouble && !halted_);
  differences_.setActive(looked_at_ == List::kDifferences && !halted_);
}

void QueueController::follow() {
  if (looked_at_ == List::kNone) return;
  const sessions::Session& session = document_.session();
  Rows::Keys rows;
  Differences::Keys pairs;
  for (const auto& session_case : session.cases) {
    const std::string key = sessions::queueKey(session, session_case->id);
    rows.emplace_back(session_case->id, key);
    if (const auto pair = sessions::lastTwoRuns(session, session_case->id))
      pairs.emplace_back(session_case->id, key + ' ' + pair->before->digest);
  }
  rows_.follow(session, rows);
  differences_.follow(session, pairs);
}

QueueRow QueueController::rowOf(const Rows::Entry& entry) const {
  if (!entry.value) return plainRow(document_.session(), entry.id);
  QueueRow row = entry.value->row;
  sessions::takeReviewStatus(document_.session(), row);
  return row;
}

std::vector<QueueEntry> QueueController::queue() const {
  std::vector<QueueEntry> queue;
  for (const Rows::Entry& entry : rows_.entries())
    queue.push_back({rowOf(entry), entry.value ? entry.value->thumbnail : QImage(), entry.current});
  return queue;
}

std::vector<DifferenceEntry> QueueController::differences() const {
  std::vector<DifferenceEntry> differences;
  for (const Differences::Entry& entry : differences_.entries())
    differences.push_back(entry.value.value_or(DifferenceEntry{entry.id}));
  return differences;
}

int QueueController::doneCount() const {
  return looked_at_ == List::kDifferences ? differences_.currentCount() : rows_.currentCount();
}

int QueueController::count() const {
  return static_cast<int>(looked_at_ == List::kDifferences ? differences_.entries().size()
                                                           : rows_.entries().size());
}

bool QueueController::isBusy() const { return rows_.isBusy() || differences_.isBusy(); }

void QueueController::setHalted(bool halted) {
  halted_ = halted;
  fillVisible();
  Q_EMIT changed();
}

}  // namespace boresight::ui
