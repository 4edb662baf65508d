// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/run_inputs.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_writer.h"

namespace boresight::sessions {

RunInputs::RunInputs(const Dataset& dataset, std::string mesh_of)
    : dataset_(dataset), mesh_of_(std::move(mesh_of)) {}

std::string RunInputs::fileSha256(const std::filesystem::path& file) {
  std::shared_future<std::string> hash;
  {
    const std::lock_guard lock(mutex_);
    auto& known = files_[file];
    if (!known.valid())
      known = std::async(std::launch::deferred, [file] { return inputSha256(file); }).share();
    hash = known;
  }
  return hash.get();
}

std::string RunInputs::sha256(const Case& dataset_case) {
  Case posed = dataset_case;
  if (!mesh_of_.empty()) {  // as Batch poses another station's mesh
    posed.station = mesh_of_;
    posed.part_states.clear();
  }
  nlohmann::ordered_json json = {{"image", fileSha256(dataset_case.image)}};
  if (dataset_case.ignore) json["ignore"] = fileSha256(*dataset_case.ignore);
  for (const PartSource& part : partsOf(dataset_, posed))
    if (part.state.used()) json["meshes"].push_back(fileSha256(part.mesh));
  json["camera"] = toJson(dataset_.cameras.at(dataset_case.camera));
  if (dataset_case.camera_from_end_effector)
    json["end_effector"] = toJson(*dataset_case.camera_from_end_effector);
  for (const FrameTransform& transform : dataset_.transforms)
    json["transforms"].push_back(toJson(transform.target_from_source));
  json["seed"] = toJson(dataset_case.seed_camera_from_station);
  if (dataset_case.truth_camera_from_station)
    json["truth"] = toJson(*dataset_case.truth_camera_from_station);
  return sha256Text(json.dump());
}

void RunInputs::requireUnchanged(const Case& dataset_case, const std::string& held,
                                 const std::filesystem::path& results) {
  try {
    if (held.empty() || held == sha256(dataset_case)) return;
  } catch (const InputError&) {
    return;  // a missing file cannot be compared; a run of the case reports it
  }
  throw InputError(
      results, "run of " + dataset_case.id,
      "the image, mask, mesh, camera, frames, seed or truth of its case has changed since: "
      "evaluate again into a new file");
}

}  // namespace boresight::sessions
