// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/stale_runs.h"

namespace boresight::sessions {

void StaleRuns::takeOptions(const Session& session) {
  if (profile_ == session.profile && options_ == session.options) return;
  profile_ = session.profile;
  options_ = session.options;
  options_digests_.clear();
}

bool StaleRuns::isStale(const RunRecord& run, const SharedValue<SessionCase>& one,
                        const Session& session, const std::filesystem::path& file) {
  // Of a run together the other cases count, too.
  if (run.together) return stalenessOf(run, session, file).stale();
  takeOptions(session);
  auto known = inputs_.find(one->id);
  if (known == inputs_.end() || !known->second.one.sharesWith(one))
    known = inputs_.insert_or_assign(one->id, Inputs{one, inputsDigest(*one)}).first;
  if (run.inputs_sha256 != known->second.digest) return true;
  std::string& options = options_digests_[one->feature_size_m.value_or(0.0)];
  if (options.empty()) options = optionsDigest(caseOptions(session, *one, file));
  return run.options_sha256 != options;
}

}  // namespace boresight::sessions
