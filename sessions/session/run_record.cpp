// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/run_record.h"

#include <algorithm>

#include "core/base/digest.h"
#include "core/localizer/run_digest.h"
#include "sessions/session/session.h"

namespace boresight::sessions {
bool RerunRecord::operator==(const RerunRecord& other) const {
  const auto same = [](const OptionChange& a, const OptionChange& b) {
    return a.iteration == b.iteration && sameOptions(a.options, b.options);
  };
  return from == other.from && sameOptions(options, other.options) &&
         std::equal(changes.begin(), changes.end(), other.changes.begin(), other.changes.end(),
                    same);
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
