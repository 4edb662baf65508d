// SPDX-License-Identifier: Apache-2.0
#include "ui/window/case_details.h"

#include <cmath>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

#include <QCoreApplication>

#include "core/base/math.h"
#include "sessions/decision/check_limits.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/review/review_status.h"
#include "sessions/session/case_run.h"
#include "sessions/session/input_check.h"
#include "sessions/session/pose_comparer.h"
#include "sessions/session/session_file.h"
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
             sessions::StaleRuns& known) {
  const sessions::RunRecord* run = session.lastRunOf(shared_value->id);
  try {
    return run && known.isStale(*run, shared_value, session, "session");
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

CaseRow caseRow(const sessions::Session& session, const std::string& id,
                sessions::StaleRuns& known) {
  const sessions::SharedValue<sessions::SessionCase>& session_case = *session.cases.find(id);
  CaseRow row;
  row.id = QString::fromStdString(id);
  row.station = QString::fromStdString(session_case->station);
  const sessions::ReviewStatus status = sessions::reviewStatusOf(session, id);
  row.state = caseStateOf(status.state);
  const bool of_run = row.state == CaseState::kConverged || row.state == CaseState::kFailed;
  row.stale = !status.outdated.empty() || (of_run && isStale(session, session_case, known));
  row.awaits_approval = status.awaits_approval;
  row.detail = detailOf(session, id, status);
  return row;
}

CaseWork<CaseRow> caseRowWork() {
  using sessions::Session;
  return {.listed = {},
          .first =
              [](const Session& session, const std::string& id) {
                CaseRow row;
                row.id = QString::fromStdString(id);
                row.station = QString::fromStdString(session.findCase(id)->station);
                return row;
              },
          .glance =
              [](const Session& session, const std::string& id, const CaseRow&) {
                sessions::StaleRuns of_one;
                return std::pair(caseRow(session, id, of_one), true);
              },
          .make = [known = std::make_shared<sessions::StaleRuns>()](
                      const Session& session, const std::string& id,
                      const CaseRow&) { return caseRow(session, id, *known); },
          .rank = {}};
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

/// Names the error of a run against the truth of its case as it is now.
std::string errorKey(const sessions::SessionCase& session_case, const sessions::RunRecord& run) {
  sessions::SessionCase asked;
  asked.camera_from_station_truth = session_case.camera_from_station_truth;
  asked.camera_from_end_effector = session_case.camera_from_end_effector;
  asked.symmetries = session_case.symmetries;
  return run.digest +
         sessions::sha256Text(sessions::toJson(asked, sessions::PathWriter("/")).dump());
}

/// Of a station without symmetries the mesh is not read.
std::optional<sessions::PoseError> errorOf(const sessions::SessionCase& session_case,
                                           const sessions::RunRecord& run) {
  try {
    const sessions::LocalizationTrace trace = sessions::loadRun(run);
    if (!trace.converged()) return std::nullopt;
    sessions::SceneMesh scene;
    if (!session_case.symmetries.empty()) scene = sessions::readKnownScene(session_case);
    return sessions::PoseComparer(session_case, scene.view())
        .difference(*sessions::judgingTruth(session_case), trace.camera_from_station);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace

CaseDetails::CaseDetails(TaskRunner& tasks, QObject* parent) : QObject(parent), tasks_(tasks) {
  pause_.setSingleShot(true);
  pause_.setInterval(kPause_ms);
  connect(&pause_, &QTimer::timeout, this, [this] { Q_EMIT changed(std::exchange(filled_, {})); });
}

void CaseDetails::setSession(const sessions::Session& session) {
  const std::set<std::string> ids = sessions::differenceOf(session_, session).cases;
  session_ = session;
  std::vector<std::string> to_read(ids.begin(), ids.end());
  if (ids.size() >= session.cases.size()) {  // another session: in its order
    pictures_.clear();
    results_.clear();
    to_read.clear();
    for (const auto& session_case : session.cases) to_read.push_back(session_case->id);
  }
  for (std::deque<std::string>* ids_to_read : {&pictures_, &results_})
    ids_to_read->insert(ids_to_read->end(), to_read.begin(), to_read.end());
  if (!reading_) readNext();
}

/// Starts reading the value of a key unless it is known; returns whether it started.
template <class Value, class Read>
bool CaseDetails::read(const std::string& id, std::map<std::string, Value>& known,
                       const std::string& key, Read make) {
  filled_.insert(id);
  if (!pause_.isActive()) pause_.start();  // limits the signal to some times per second
  if (known.contains(key)) return false;
  const auto take = [this, &known, key, id](Value value) {
    known[key] = std::move(value);
    filled_.insert(id);
    readNext();
  };
  // What cannot be read is not shown: opening the case reports the reason.
  tasks_.queue([make](const std::stop_token&) { return make(); }, take,
               [take](const QString&) { take({}); });
  return true;
}

bool CaseDetails::readPicture(const std::string& id) {
  const sessions::SessionCase* session_case = session_.findCase(id);
  return session_case && read(id, thumbnails_, session_case->image.source.sha256,
                              [image = session_case->image] { return thumbnailOf(image); });
}

bool CaseDetails::readResult(const std::string& id) {
  const sessions::SessionCase* session_case = session_.findCase(id);
  const sessions::RunRecord* run = session_.lastRunOf(id);
  return session_case && run && sessions::judgingTruth(*session_case) &&
         read(id, errors_, errorKey(*session_case, *run),
              [one = *session_case, run = *run] { return errorOf(one, run); });
}

bool CaseDetails::readNextOf(std::deque<std::string>& ids,
                             bool (CaseDetails::*begin)(const std::string&)) {
  while (!ids.empty()) {
    const std::string id = ids.front();
    ids.pop_front();
    if ((this->*begin)(id)) return true;
  }
  return false;
}

void CaseDetails::readNext() {
  reading_ = readNextOf(pictures_, &CaseDetails::readPicture) ||
             readNextOf(results_, &CaseDetails::readResult);
  if (reading_ || !pause_.isActive()) return;
  pause_.stop();
  Q_EMIT changed(std::exchange(filled_, {}));
}

void CaseDetails::fillErrors(const sessions::SessionCase& session_case, CaseRow& row) const {
  const sessions::RunRecord* run = session_.lastRunOf(session_case.id);
  if (!run || !sessions::judgingTruth(session_case)) return;
  const auto found = errors_.find(errorKey(session_case, *run));
  if (found == errors_.end() || !found->second) return;
  const sessions::PoseError& error = *found->second;
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

void CaseDetails::fill(CaseRow& row) const {
  const sessions::SessionCase* session_case = session_.findCase(row.id.toStdString());
  if (!session_case) return;
  const auto picture = thumbnails_.find(session_case->image.source.sha256);
  if (picture != thumbnails_.end()) row.thumbnail = picture->second;
  fillErrors(*session_case, row);
}

}  // namespace boresight::ui
