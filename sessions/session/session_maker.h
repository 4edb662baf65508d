// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sessions/session/case_run.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// Files of one case. No file is guessed.
struct CaseFiles {
  std::string id;               ///< "": the image's name without extension
  std::filesystem::path image;  ///< "": none yet, of a sequence; then `camera` is needed
  ImageReadOptions eight_bit;
  /// camera.json, text of calibration or an image with a label; "": the image's own label.
  std::filesystem::path camera;
  /// Transforms between named frames (sessions/io/cameras/cameras.md).
  std::vector<std::filesystem::path> transforms;
  std::vector<PartSource> parts;
  /// "": the chain between STATION and CAMERA, with the transforms' covariances as its uncertainty;
  /// where the transforms do not join these, a case without a seed.
  std::filesystem::path seed;
  std::optional<DeclaredUncertainty> uncertainty;  ///< instead of the seed file's, but its pivot
  std::optional<UncertaintyPivot> pivot;           ///< instead of the seed file's
  std::optional<std::filesystem::path> truth;
  std::optional<std::filesystem::path> ignore;
  Symmetries symmetries;
  std::optional<double> feature_size_m;
  std::optional<double> mesh_scale_sigma;
  /// Used instead of the transforms between CAMERA and END_EFFECTOR.
  std::optional<Pose> camera_from_end_effector;
  std::optional<Requirement> requirement;
};

/// A case with the current hashes of its files, and notes for the operator (a seed without
/// uncertainty, a matrix that is not quite a rotation).
struct MadeCase {
  SessionCase made;
  std::vector<std::string> notes;
};

/// The contents of the case's transform files. InputError.
std::vector<FrameTransform> readTransforms(const CaseFiles& files);

/// An image as stored in a case. InputError.
ImageInput imageInput(const std::filesystem::path& file, const ImageReadOptions& eight_bit);

/// Meshes as stored in a case. Parts that are switched off are read, too: they can be switched on
/// later. InputError.
std::vector<MeshInput> meshInputs(const std::vector<PartSource>& parts);

/// Reads all files once. InputError when one is missing or wrong. An image whose size differs from
/// its camera's is accepted; the input sheet flags it and a run rejects it.
MadeCase makeCase(const CaseFiles& files);

/// A session of the cases of a dataset.json with these ids, or of all. Requirement, truth, rig,
/// tags and uncertainty are copied, and the checks' preset is the one for the requirement of all of
/// them (a requirement in pixels alone: "photographs"). InputError, also for an id that the dataset
/// does not have.
Session makeSession(const Dataset& dataset, const std::vector<std::string>& case_ids = {});
/// The same for a file, or for a BOP folder with the selection of openDataset.
Session makeSession(const std::filesystem::path& dataset_file,
                    const std::vector<std::string>& case_ids = {});

/// The folder of the examples that ship: share/boresight/examples next to an installed program,
/// sessions/examples above one that runs from its build tree. InputError when there is neither.
std::filesystem::path examplesFolder();

}  // namespace boresight::sessions
