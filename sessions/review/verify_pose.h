// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace boresight::sessions {

/// One thing that was asked of a validated_pose.json.
struct VerifyFinding {
  bool good = false;
  std::string what;  ///< "signature", "image", "run", "pose", ...
  std::string text;  ///< one sentence
};

struct VerifyReport {
  std::string standing;  ///< who vouches for the pose, or NOT VALIDATED and why, as it is stated
  std::vector<VerifyFinding> findings;
  /// What is stated and was not, or cannot be, measured: who decided, when, and why a failed check
  /// was passed over. One sentence each.
  std::vector<std::string> not_proved;

  /// Everything that was measured is as stated; whether the pose is validated is another question.
  bool good() const;
};

/// Checks a validated_pose.json: its signature, the files that it names by their hashes, whether
/// the decision in it still holds, and whether all members follow from each other. With `run_again`
/// the run is run again (the marks are solved again), and its digest, pose, covariance, matches and
/// every check are compared with what is stated; with `basin_again` the convergence test, too.
/// InputError when it is no such file.
VerifyReport verifyPose(const std::filesystem::path& file, bool run_again,
                        bool basin_again = false);

}  // namespace boresight::sessions
