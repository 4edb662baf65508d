// SPDX-License-Identifier: Apache-2.0
// A session with a case that was run, and what there is to decide about it; no files.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sessions/io/json/config_file.h"
#include "sessions/review/review_status.h"
#include "tests/sessions/session/random_session.h"

namespace boresight::test {

struct JudgedCase {
  sessions::Session session;
  sessions::ReviewSubject subject;
  std::vector<sessions::Check> checks;

  /// A case that converged.
  explicit JudgedCase(Random& random, const std::string& id = "a") {
    sessions::SessionCase session_case = randomCase(random, id);
    session_case.rig.reset();
    const std::string digest = randomSha256(random);
    session = withCase({}, session_case);
    noteRun(digest, "converged", random);
    auto loaded = std::make_shared<sessions::LoadedCase>();
    loaded->source = session_case;
    subject.loaded = loaded;
    subject.camera_from_station = randomPose(random);
    subject.covariance.picture = Matrix6d::Identity();
    subject.run.emplace();
    subject.run->status = LocalizationStatus::kConverged;
    subject.run->digest = digest;
    checks = {check("converged", sessions::CheckState::kPassed),
              check("coverage", sessions::CheckState::kPassed),
              check("truth", sessions::CheckState::kNotApplicable)};
  }

  void noteRun(const std::string& digest, const std::string& status, Random& random) {
    const sessions::SessionCase& session_case = *session.cases.front();
    session.runs.push_back(
        {session_case.id, digest, randomPath(random, ".trace"), status, "0.1.0",
         "2026-01-31T23:59:59Z", inputsDigest(session_case),
         sessions::optionsDigest(caseOptions(session, session_case, "session"))});
  }

  static sessions::Check check(const std::string& id, sessions::CheckState state) {
    sessions::Check result;
    result.id = id;
    result.title = "Check of " + id;
    result.state = state;
    result.sentence = "It was looked at.";
    return result;
  }

  sessions::Session validatedBy(const std::string& by) const {
    return sessions::validated(session, subject, checks, {}, {by, "looks right"});
  }
};

}  // namespace boresight::test
