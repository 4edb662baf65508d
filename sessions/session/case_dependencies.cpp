// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/case_dependencies.h"

#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_fields.h"
#include "sessions/session/session_file.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

/// The members of a case in the session file that a name covers.
struct NamedMembers {
  const char* name;
  std::vector<const char*> members;
};

/// Members with data that `inputs` does not cover. A member that no list names is in `others`: a
/// member that a later version adds is covered without a change here.
const std::vector<NamedMembers>& namedMembers() {
  static const std::vector<NamedMembers> kMembers = {
      {"names", {"id", "station"}},
      {"image", {"image"}},
      {"frames", {"camera_reference", "station_frame", "truth_frame", "frames"}},
      {"truth", {"truth", "truth_covariance", "truth_source"}},
      {"requirement", {"requirement", "symmetries"}},
      {"end_effector", {"camera_from_end_effector"}},
      {"onboard_record", {"onboard_record"}}};
  return kMembers;
}

/// Members that `inputs` or `input_sigmas` covers (a rig: the fingerprint of a decision), and those
/// on which nothing depends.
constexpr const char* kCoveredOrFree[] = {
    "camera",  "parts", "seed",      "uncertainty",    "ignore",           "ignore_strokes",
    "working", "tags",  "landmarks", "feature_size_m", "mesh_scale_sigma", "rig"};

/// Names of files without their folders; a file's place makes no difference, its bytes do.
SessionCase withoutFolders(SessionCase session_case) {
  forEachFile(session_case, [](const std::string&, std::filesystem::path& file,
                               const std::string&) { file = "/"; });
  for (FrameTransform& transform : session_case.frames) transform.file = "/";
  return session_case;
}

std::string sha256Of(const ordered_json& json) { return sha256Text(json.dump()); }

ordered_json inputSigmasJson(const SessionCase& session_case) {
  ordered_json json = ordered_json::object();
  if (session_case.mesh_scale_sigma) json["mesh_scale"] = *session_case.mesh_scale_sigma;
  if (session_case.calibration_sigma) json["calibration"] = toJson(*session_case.calibration_sigma);
  if (session_case.camera_covariance)
    json["camera_covariance"] = toJson(*session_case.camera_covariance);
  return json;
}

}  // namespace

std::map<std::string, std::string> dependencyDigests(const SessionCase& session_case) {
  std::map<std::string, std::string> digests;
  digests["inputs"] = inputsDigest(session_case);
  digests["input_sigmas"] = sha256Of(inputSigmasJson(session_case));
  ordered_json rest = toJson(withoutFolders(session_case), PathWriter("/"));
  digests["image_label"] = sha256Of(toJson(session_case.image.label));
  rest["image"].erase("label");
  for (const char* member : kCoveredOrFree) rest.erase(member);
  for (const auto& [name, members] : namedMembers()) {
    ordered_json named = ordered_json::object();
    for (const char* member : members)
      if (const auto found = rest.find(member); found != rest.end()) {
        named[member] = *found;
        rest.erase(member);
      }
    digests[name] = sha256Of(named);
  }
  digests["others"] = sha256Of(rest);
  return digests;
}

}  // namespace boresight::sessions
