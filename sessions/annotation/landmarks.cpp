// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/landmarks.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "core/base/symmetric_eigen.h"
#include "sessions/annotation/annotations_on_image.h"
#include "sessions/annotation/image_snap.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/json/json_fields.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

constexpr const char* kLandmarksFormat = "boresight-landmarks";
constexpr int kLandmarksVersion = 1;

/// Standard deviation along the direction in which it is largest.
double largestSigma_px(const PredictedPlace& place, const Matrix6d& covariance) {
  const Eigen::Matrix2d spread = place.pixel_by_xi * covariance * place.pixel_by_xi.transpose();
  return std::sqrt(std::max(0.0, SymmetricEigen<2>(spread).values[1]));
}

constexpr double kSigmas = 3.0;
constexpr double kLeastRadius_px = 2.0;
constexpr double kMostRadius_px = 8.0;

}  // namespace

template <class Archive, ConstOr<Landmark> Self>
void fields(Archive& archive, Self& landmark) {
  constexpr auto kPlace = jsonCodec<Eigen::Vector3d>(
      [](const JsonReader& json) { return json.vector3(-kMaxCoordinate_m, kMaxCoordinate_m); });
  archive.field("name", landmark.name, kNonEmptyText);
  archive.field("point_in_station_m", landmark.point_in_station_m, kPlace);
  archive.defaulted("comment", landmark.comment, kAnyText);
}

std::vector<Landmark> readLandmarks(const std::filesystem::path& file) {
  const auto bytes = readFileBytes(file, kMaxJsonBytes, FileUse::kLandmarks);
  const auto readMembers = [](const JsonReader& root) {
    std::vector<Landmark> landmarks;
    std::set<std::string> names;
    for (const JsonReader& json : root.at("landmarks").elements()) {
      landmarks.push_back(readFields<Landmark>(json));
      const std::string& name = landmarks.back().name;
      if (!names.insert(name).second) json.failMember("name", "'" + name + "' is given twice");
    }
    return landmarks;
  };
  return JsonDocument(file, asText(bytes)).read(kLandmarksFormat, kLandmarksVersion, readMembers);
}

void writeLandmarks(const std::filesystem::path& file, const std::vector<Landmark>& landmarks) {
  ordered_json json = {{"format", kLandmarksFormat}, {"version", kLandmarksVersion}};
  json["landmarks"] = ordered_json::array();
  for (const Landmark& landmark : landmarks) json["landmarks"].push_back(fieldsJson(landmark));
  writeFileAtomically(file, prettyJson(json), FileUse::kLandmarks);
}

std::vector<Landmark> withAnnotations(std::vector<Landmark> landmarks,
                                      const Annotations& annotations) {
  for (const PointPair& point : annotations.points) {
    if (!point.point_in_station_m) continue;
    const Landmark landmark{point.id, *point.point_in_station_m, point.comment};
    const auto same = std::ranges::find(landmarks, point.id, &Landmark::name);
    if (same == landmarks.end())
      landmarks.push_back(landmark);
    else
      *same = landmark;
  }
  return landmarks;
}

std::string leftOutOfLandmarks(const Annotations& annotations) {
  const std::size_t lines = annotations.lines.size();
  if (lines == 0) return "";
  return std::to_string(lines) + (lines == 1 ? " line is" : " lines are") +
         " left out: landmarks are points.";
}

std::vector<Proposal> proposeAnnotations(const std::vector<Landmark>& landmarks,
                                         const Annotations& annotations, const MeshView& mesh,
                                         const Camera& camera, const Pose& camera_from_station,
                                         const Matrix6d* covariance) {
  std::vector<Proposal> proposals;
  for (const Landmark& landmark : landmarks) {
    if (hasAnnotation(annotations, landmark.name)) continue;
    const PredictedPlace place =
        predictPlace(camera, camera_from_station, landmark.point_in_station_m);
    if (!place.valid || !isInImage(camera, place.pixel)) continue;
    Proposal proposal;
    proposal.landmark = landmark;
    proposal.pixel = place.pixel;
    if (covariance != nullptr) proposal.sigma_px = largestSigma_px(place, *covariance);
    proposal.seen = isSeen(camera, mesh, camera_from_station, landmark.point_in_station_m);
    proposals.push_back(proposal);
  }
  std::sort(proposals.begin(), proposals.end(), [](const Proposal& a, const Proposal& b) {
    return a.seen != b.seen ? a.seen : a.landmark.name < b.landmark.name;
  });
  return proposals;
}

std::optional<Eigen::Vector2d> featureOf(const Proposal& proposal, const ImageView& image) {
  const double radius_px = std::clamp(kSigmas * proposal.sigma_px, kLeastRadius_px, kMostRadius_px);
  for (const ImageSnap& snap : imageSnaps(image, proposal.pixel, radius_px, 4.0 * radius_px))
    if (snap.kind != ImageSnapKind::kEdge) return snap.pixel;
  return std::nullopt;
}

}  // namespace boresight::sessions
