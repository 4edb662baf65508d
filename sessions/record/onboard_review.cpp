// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/onboard_review.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/record/onboard_record.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"
#include "sessions/text/units.h"

namespace boresight::sessions {
namespace {

constexpr std::size_t kDigestShown = 16;  ///< digits; enough to tell runs apart

std::string triple(const Eigen::Vector3d& value, int decimals) {
  return fixedText(value.x(), decimals) + ", " + fixedText(value.y(), decimals) + ", " +
         fixedText(value.z(), decimals);
}

/// Largest of three sigmas.
double largestSigma(const Matrix6d& covariance, int first) {
  return std::sqrt(std::max(0.0, covariance.diagonal().segment<3>(first).maxCoeff()));
}

}  // namespace

std::shared_ptr<const OnboardReview> reviewRecord(const std::filesystem::path& file,
                                                  const std::string& sha256,
                                                  const LocalizationProblem& ground,
                                                  const std::stop_token& stop) {
  const std::vector<std::uint8_t> bytes = readFileBytes(file, 64 * kMegabyte);
  if (sha256Text(bytes) != sha256)
    throw InputError(
        file,
        "it differs from the attached record: accept it as it is now, or attach the right one");
  auto result = std::make_shared<OnboardReview>();
  result->record = parseRecord(file, bytes);
  result->plan = planOf(result->record);
  result->replay =
      std::make_shared<const LocalizationTrace>(replayRecord(result->record, ground, stop));
  return result;
}

RecordComparison compareWithGround(const OnboardReview& review, const LocalizationTrace& run,
                                   const LocalizationProblem& ground,
                                   const ComparisonLimits& limits) {
  return compareRecords(review.record, recordOf(run, &ground), limits);
}

std::vector<std::pair<std::string, std::string>> recordSheet(const OnboardRecord& record) {
  std::vector<std::pair<std::string, std::string>> lines;
  const std::size_t known = record.iterations.size();
  if (record.end) {
    const RecordedEnd& end = *record.end;
    const bool all = static_cast<std::size_t>(std::max(0, end.iterations)) == known;
    lines.emplace_back("Ended as", localizationStatusText(end.status));
    lines.emplace_back("Iterations", std::to_string(end.iterations) + " in " +
                                         countText(end.attempts, "attempt") +
                                         (all ? "" : ", " + std::to_string(known) + " known"));
    lines.emplace_back("Camera from station",
                       triple(kMillimetres * end.camera_from_station.translation_m, 2) + " mm");
    lines.emplace_back(
        "Rotation vector",
        triple(rotationLog(end.camera_from_station.rotation) / kDegree_rad, 3) + " deg");
    if (!end.covariance.isZero())
      lines.emplace_back("One sigma at the camera, at most",
                         fixedText(kMillimetres * largestSigma(end.covariance, 3), 3) + " mm, " +
                             fixedText(kMilliradians * largestSigma(end.covariance, 0), 3) +
                             " mrad");
    lines.emplace_back("Digest", end.digest.substr(0, kDigestShown) + " ...");
  } else {
    lines.emplace_back("Ended as", "not known");
    lines.emplace_back("Iterations", std::to_string(known) + " known");
  }
  lines.emplace_back("Record", record.whole() ? "whole" : "incomplete, see below");
  return lines;
}

std::string verdictText(const RecordComparison& comparison) {
  switch (comparison.verdict) {
    case RunVerdict::kEqual:
      return "Agrees with the run on the ground bit for bit.";
    case RunVerdict::kWithinLimits:
      return comparison.first
                 ? "Within the limits; the pixels differ."
                 : "Agrees with the run on the ground bit for bit as far as it reaches.";
    case RunVerdict::kUndecided:
      return "Nothing of a run is in both: the record does not show whether they agree.";
    case RunVerdict::kDifferent:
      break;
  }
  return "Differs from the run on the ground.";
}

std::string limitsText(const ComparisonLimits& limits) {
  return "Limits if the pixels differ: in the first iteration at least " +
         percentText(limits.found_share) + " of the templates at equal positions match within " +
         fixedText(limits.found_px, 1) + " px of each other, and at least " +
         percentText(limits.inlier_share) +
         " of the inliers of either run are inliers of both (shares of ten or more); the final "
         "poses are at most " +
         fixedText(limits.pose_sigmas, 1) + " sigmas apart.";
}

}  // namespace boresight::sessions
