// SPDX-License-Identifier: Apache-2.0
// From inputs that were read to a problem that can be run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/localizer/problem.h"
#include "core/record/record_writer.h"
#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/images/image_file.h"
#include "sessions/io/meshes/scene_mesh.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// A problem from inputs that were read; points to image, mask (nullptr: none) and mesh.
LocalizationProblem problemOf(const GrayImage& image, const BitImage* ignore, const Camera& camera,
                              const MeshView& mesh, const Pose& camera_from_station_seed,
                              const DeclaredUncertainty& uncertainty,
                              const std::optional<Pose>& camera_from_end_effector);

/// The hashes by which an onboard record identifies the inputs of a run (core/record/FORMAT.md);
/// `problem` without inputs that the run does not use (withoutUnusedInputs).
RecordInputs recordInputs(const LocalizationProblem& problem);

/// Why a run from this seed is pointless, or "": the matched parts lie behind the camera or outside
/// the image. Whether the visible part suffices is decided by the run.
std::string seedConcern(const Camera& camera, const MeshView& mesh,
                        const Pose& camera_from_station_seed);

/// InputError for the mesh when its size is implausible at this seed, and for `file` and `place`
/// when there is a seedConcern.
void requireSensibleSeed(const Camera& camera, const SceneMesh& scene,
                         const Pose& camera_from_station_seed, const std::filesystem::path& file,
                         const std::string& place);

/// Sources of the inputs of a run: a file, and a place in it.
struct InputPlaces {
  struct Place {
    std::filesystem::path file;
    std::string field;  ///< may be empty
  };
  Place image, camera, mesh, seed;
};

/// InputError for the input that the core rejected although the readers accepted it.
void requireAccepted(const LocalizationTrace& trace, const InputPlaces& places);

}  // namespace boresight::sessions
