// SPDX-License-Identifier: Apache-2.0
#include "ui/window/case_details.h"

#include <cmath>
#include <exception>

#include <QCoreApplication>

#include "core/base/math.h"
#include "sessions/decision/check_limits.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/review/review_status.h"
#include "sessions/session/case_run.h"
#include "sessions/trace/run_text.h"
#include "ui/models/text.h"
#include "ui/run/task_runner.h"
#include "ui/views/display_image.h"

namespace boresight::ui {
namespace {

QString detailOf(const sessions::Session& session, const std::string& id,
                 const sessions::ReviewStatus& status) {
  QString text = fromText(sessions::reviewStatusText(status));
  if (const sessions::RunRecord* run = session.lastRunOf(id))
    text += QCoreApplication::translate("CaseRows", "\nLast run %1: %2")
                .arg(fromText(run->time), fromText(run->status)) +
            (run->together ? QStringLiteral(", ") + fromText(togetherText(run->together->views, id))
                           : QString());
  return text;
}

/// Options that cannot be read are said where they are shown.
bool isStale(const sessions::Session& session,
             const sessions::SharedValue<sessions::SessionCase>& shared_value,
             const std::filesystem::path& file, sessions::StaleRuns& known) {
  const sessions::RunRecord* run = session.lastRunOf(shared_value->id);
  try {
    return run && known.isStale(*run, shared_value, session, file);
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

std::vector<CaseRow> caseRows(const sessions::Session& session, const QString& running,
                              const std::filesystem::path& file, sessions::StaleRuns& known) {
  std::vector<CaseRow> rows;
  for (const auto& session_case : session.cases) {
    CaseRow row;
    row.id = QString::fromStdString(session_case->id);
    row.station = QString::fromStdString(session_case->station);
    const sessions::ReviewStatus status = sessions::reviewStatusOf(session, session_case->id);
    row.state = row.id == running ? CaseState::kRunning : caseStateOf(status.state);
    const bool of_run = row.state == CaseState::kConverged || row.state == CaseState::kFailed;
    row.stale = !status.outdated.empty() || (of_run && isStale(session, session_case, file, known));
    row.detail = detailOf(session, session_case->id, status);
    rows.push_back(std::move(row));
  }
  return rows;
}

namespace {

constexpr int kCaseThumbnail_px = 128;  // also sharp on a screen of double density
constexpr int kPause_ms = 200;          // the list is filled as a whole

/// As the canvas shows the image at first. Null when the file cannot be read: opening the case
/// reports the reason.
QImage thumbnailOf(const sessions::ImageInput& input) {
  try {
    const sessions::ImageSamples samples =
        sessions::readSamples(input.source.file, input.eight_bit.bayer);
    return stretched(samples, firstLevels(samples, automaticLevels(samples)))
        .scaled(kCaseThumbnail_px, kCaseThumbnail_px, Qt::KeepAspectRatio,
                Qt::SmoothTransformation);
  } catch (const std::exception&) {
    return {};
  }
}

std::optional<Pose> resultOf(const sessions::RunRecord& run) {
  try {
    const sessions::LocalizationTrace trace = sessions::loadRun(run);
    return trace.converged() ? std::optional(trace.camera_from_station) : std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace

CaseDetails::CaseDetails(TaskRunner& tasks, QObject* parent) : QObject(parent), tasks_(tasks) {
  pause_.setSingleShot(true);
  pause_.setInterval(kPause_ms);
  connect(&pause_, &QTimer::timeout, this, &CaseDetails::changed);
}

void CaseDetails::setSession(const sessions::Session& session) {
  session_ = session;
  next_ = 0;
  if (!reading_) readNext();
}

/// Starts reading the value of a key unless it is known; returns whether it started.
template <class Value, class Read>
bool CaseDetails::read(std::map<std::string, Value>& known, const std::string& key, Read make) {
  if (known.contains(key)) return false;
  const auto take = [this, &known, key](Value value) {
    known[key] = std::move(value);
    tellSoon();
  };
  // What cannot be read is not shown: opening the case reports the reason.
  tasks_.queue([make](const std::stop_token&) { return make(); }, take,
               [take](const QString&) { take({}); });
  return true;
}

void CaseDetails::readNext() {
  const auto& cases = std::as_const(session_).cases;
  reading_ = true;
  for (; next_ < cases.size(); ++next_)
    if (read(thumbnails_, cases[next_]->image.source.sha256,
             [image = cases[next_]->image] { return thumbnailOf(image); }))
      return;
  for (; next_ < 2 * cases.size(); ++next_) {
    const sessions::SessionCase& session_case = *cases[next_ - cases.size()];
    const sessions::RunRecord* run = session_.lastRunOf(session_case.id);
    if (run && sessions::judgingTruth(session_case) &&
        read(poses_, run->digest, [run = *run] { return resultOf(run); }))
      return;
  }
  reading_ = false;
  if (!pause_.isActive()) return;
  pause_.stop();
  Q_EMIT changed();
}

/// Limits the signal to some times per second, and emits it at the end.
void CaseDetails::tellSoon() {
  if (!pause_.isActive()) pause_.start();
  readNext();
}

void CaseDetails::fillErrors(const sessions::SessionCase& session_case, CaseRow& row) const {
  const sessions::RunRecord* run = session_.lastRunOf(session_case.id);
  if (!run || !sessions::judgingTruth(session_case)) return;
  const auto found = poses_.find(run->digest);
  if (found == poses_.end() || !found->second) return;
  const sessions::PoseError error = sessions::poseError(
      *sessions::judgingTruth(session_case), *found->second, session_case.camera_from_end_effector);
  row.normal_mm = std::abs(error.normal_mm);
  row.lateral_mm = error.lateral_mm;
  row.rotation_deg = 1e-3 * error.rotation_mrad / kDegree_rad;
  const std::string excess = sessions::sigmaExcessText(
      session_case.truth_covariance.value_or(Matrix6d::Zero()),
      session_case.camera_from_end_effector, sessions::requirementOf(session_, session_case));
  if (excess.empty()) return;
  row.detail +=
      (row.detail.isEmpty() ? QString() : QStringLiteral("\n")) +
      tr("One sigma of its truth is %1, too large for these errors.").arg(fromText(excess));
}

void CaseDetails::fill(std::vector<CaseRow>& rows) const {
  for (CaseRow& row : rows) {
    const sessions::SessionCase* session_case = session_.findCase(row.id.toStdString());
    if (!session_case) continue;
    const auto picture = thumbnails_.find(session_case->image.source.sha256);
    if (picture != thumbnails_.end()) row.thumbnail = picture->second;
    fillErrors(*session_case, row);
  }
}

}  // namespace boresight::ui
