// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/run_record.h"

#include <algorithm>

#include "core/base/digest.h"
#include "core/localizer/run_digest.h"
#include "sessions/io/config_file.h"
#include "sessions/session/session.h"

namespace boresight::sessions {
namespace {

OptionList recorded(const LocalizerOptions& options) {
  OptionList list = changedOptions(options, defaultProfile());
  std::sort(list.begin(), list.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  return list;
}

LocalizerOptions optionsOf(const OptionList& list, const std::filesystem::path& file) {
  Config config;
  config.file = file;
  config.options = list;
  LocalizerOptions options = defaultProfile();
  applyConfig(options, config);
  return options;
}

}  // namespace

RerunRecord rerunRecord(const std::string& from, const RunPlan& plan) {
  RerunRecord record;
  record.from = from;
  record.options = recorded(plan.options);
  for (const OptionChange& change : plan.changes)
    record.changes.push_back({change.iteration, recorded(change.options)});
  return record;
}

RunPlan planOf(const RerunRecord& record, const std::filesystem::path& file) {
  RunPlan plan(optionsOf(record.options, file));
  for (const RecordedChange& change : record.changes)
    plan.changes.push_back({change.iteration, optionsOf(change.options, file)});
  return plan;
}

std::vector<std::string> casesOf(const TogetherRecord& record) {
  std::vector<std::string> ids;
  for (const ViewOutcome& view : record.views) ids.push_back(view.case_id);
  return ids;
}

std::string viewsDigest(const Session& session, const std::vector<std::string>& case_ids) {
  DigestWriter writer;
  writer.tag("views");
  for (std::size_t i = 0; i < case_ids.size(); ++i) {
    const SessionCase* found = session.findCase(case_ids[i]);
    if (found == nullptr || !found->rig) return "";
    SessionCase one = *found;
    if (i > 0) {
      one.camera_from_station_seed = Pose();
      one.uncertainty = {};
    }
    writer.tag(inputsDigest(one).c_str());
    digestPose(found->rig->camera_from_rig, writer);
  }
  return hexText(writer.digest()).data();
}

}  // namespace boresight::sessions
