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
  std::string standing;  ///< who vouches for the pose, or NOT VALIDATED and why, as the inputs say
  std::vector<VerifyFinding> findings;

  /// Nothing is wrong; whether the pose is validated is another question.
  bool good() const;
};

/// Checks a validated_pose.json: its signature, the files that it names by their hashes, whether
/// the decision in it is one that could have been made and still holds, whether every pose and
/// figure in it follows from it, and, with `run_again`, whether the run (or the marks) gives this
/// very pose and digest once more. InputError when it is no such file.
VerifyReport verifyPose(const std::filesystem::path& file, bool run_again);

}  // namespace boresight::sessions
