// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/together_record.h"

#include <nlohmann/json.hpp>

#include "core/base/digest.h"
#include "core/localizer/run_digest.h"
#include "sessions/session/case_json.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

using nlohmann::ordered_json;

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

std::string readRunStatus(const JsonReader& json) {
  const std::string text = json.text();
  std::string known;
  for (int i = 0; i <= static_cast<int>(kLastLocalizationStatus); ++i) {
    const std::string status = localizationStatusText(static_cast<LocalizationStatus>(i));
    if (text == status) return text;
    known += (known.empty() ? "" : ", ") + status;
  }
  json.fail("'" + text + "' is not a status of a run: use one of " + known);
}

ordered_json toJson(const TogetherRecord& record) {
  ordered_json json;
  json["views"] = ordered_json::array();
  for (const ViewOutcome& view : record.views) {
    ordered_json made;
    made["case"] = view.case_id;
    made["status"] = view.status;
    json["views"].push_back(std::move(made));
  }
  json["inputs_sha256"] = record.inputs_sha256;
  return json;
}

TogetherRecord readTogether(const JsonReader& json) {
  json.requireKnown({"views", "inputs_sha256"});
  TogetherRecord record;
  for (const JsonReader& view : json.at("views").elements()) {
    view.requireKnown({"case", "status"});
    record.views.push_back({view.at("case").nonEmptyText(), readRunStatus(view.at("status"))});
  }
  if (record.views.size() < 2) json.failMember("views", "names less than two");
  record.inputs_sha256 = readSha256(json.at("inputs_sha256"));
  return record;
}

}  // namespace boresight::sessions
