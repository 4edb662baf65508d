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

/// The row of a case from its run alone. Whether a decision holds is not looked at.
QueueRow plainRow(const sessions::Session& session, const std::string& id) {
  QueueRow row;
  row.case_id = id;
  const sessions::Decision* decision = session.decisionOn(id);
  if (const sessions::RunRecord* run = session.lastRunOf(id)) {
    row.run_digest = run->digest;
    row.review_state = run->status == "converged" ? sessions::ReviewState::kConverged
                                                  : sessions::ReviewState::kFailed;
    if (run->status != "converged") row.trouble = "the run failed: " + run->status;
    row.group = row.trouble.empty() ? sessions::QueueGroup::kOpen : sessions::QueueGroup::kNoPose;
  }
  if (decision && decision->verdict != sessions::Verdict::kReopened)
    row.group = sessions::QueueGroup::kDecided;
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

std::string pairKey(const sessions::Session& session, const std::string& id) {
  const auto pair = sessions::lastTwoRuns(session, id);
  return sessions::queueKey(session, id) + ' ' + (pair ? pair->before->digest : std::string());
}

}  // namespace

/// A row is checked again where the key of its inputs differs; its review status is always taken.
CaseWork<QueueController::Checked> QueueController::checking(const QSize& thumbnail_px) {
  using sessions::Session;
  return {.listed = {},
          .first =
              [](const Session& session, const std::string& id) {
                return Checked{plainRow(session, id), {}, {}};
              },
          .glance =
              [](const Session& session, const std::string& id, Checked former) {
                if (former.key.empty()) former.row = plainRow(session, id);
                sessions::takeReviewStatus(session, former.row);
                const bool same =
                    !former.key.empty() && former.key == sessions::queueKey(session, id);
                return std::pair(std::move(former), same);
              },
          .make =
              [thumbnail_px](const Session& session, const std::string& id, Checked former) {
                std::string key = sessions::queueKey(session, id);
                if (former.key == key) {
                  sessions::takeReviewStatus(session, former.row);
                  return former;
                }
                QueueEntry entry = checkedEntry(session, id, thumbnail_px);
                return Checked{std::move(entry.row), entry.thumbnail, std::move(key)};
              },
          .rank =
              [](const Checked& checked) {
                return WaitingRank(static_cast<int>(checked.row.group), -checked.row.failed);
              }};
}

CaseWork<QueueController::Compared> QueueController::comparing() {
  using sessions::Session;
  return {.listed =
              [](const Session& session, const std::string& id) {
                return sessions::lastTwoRuns(session, id).has_value();
              },
          .first =
              [](const Session&, const std::string& id) {
                return Compared{{id}, {}};
              },
          .glance =
              [](const Session& session, const std::string& id, Compared former) {
                const bool same = !former.key.empty() && former.key == pairKey(session, id);
                return std::pair(std::move(former), same);
              },
          .make =
              [](const Session& session, const std::string& id, Compared former) {
                std::string key = pairKey(session, id);
                if (former.key == key) return former;
                return Compared{comparedEntry(session, id), std::move(key)};
              },
          .rank = {}};
}

QueueController::QueueController(Document& document, const QSize& thumbnail_px)
    : document_(document),
      rows_(checking(thumbnail_px),
            [this](const std::vector<std::size_t>* places) {
              if (places)
                Q_EMIT queueRowsChanged(*places);
              else
                Q_EMIT changed();
            }),
      differences_(comparing(), [this](const std::vector<std::size_t>* places) {
        if (places)
          Q_EMIT differenceRowsChanged(*places);
        else
          Q_EMIT changed();
      }) {
  connect(&document_, &Document::opened, this, [this] {
    rows_.clear();
    differences_.clear();
    Q_EMIT changed();
    follow();
  });
  connect(&document_, &Document::changed, this, &QueueController::follow);
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
  if (looked_at_ == List::kTrouble) rows_.follow(document_.session());
  if (looked_at_ == List::kDifferences) differences_.follow(document_.session());
}

QueueEntry QueueController::queueAt(std::size_t place) const {
  const Checked& checked = rows_.value(place);
  return {checked.row, checked.thumbnail, rows_.isCurrent(place)};
}

std::vector<QueueEntry> QueueController::queue() const {
  std::vector<QueueEntry> queue;
  for (std::size_t place = 0; place < rows_.size(); ++place) queue.push_back(queueAt(place));
  return queue;
}

const DifferenceEntry& QueueController::differenceAt(std::size_t place) const {
  return differences_.value(place).entry;
}

std::vector<DifferenceEntry> QueueController::differences() const {
  std::vector<DifferenceEntry> differences;
  for (std::size_t place = 0; place < differences_.size(); ++place)
    differences.push_back(differenceAt(place));
  return differences;
}

int QueueController::doneCount() const {
  return static_cast<int>(looked_at_ == List::kDifferences ? differences_.currentCount()
                                                           : rows_.currentCount());
}

int QueueController::count() const {
  return static_cast<int>(looked_at_ == List::kDifferences ? differences_.size() : rows_.size());
}

bool QueueController::isBusy() const { return rows_.isBusy() || differences_.isBusy(); }

void QueueController::setHalted(bool halted) {
  halted_ = halted;
  fillVisible();
  Q_EMIT changed();
}

}  // namespace boresight::ui
