// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "sessions/evaluation/bop_scene.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/datasets/dataset_file.h"

namespace boresight::sessions {

/// Which part of a BOP dataset is read, and how well its objects' places are said to be known.
struct BopSelection {
  /// Folder of scenes, e.g. "val"; empty: "test", or the only one there is.
  std::string split = {};
  std::vector<int> scenes = {};   ///< empty: all
  std::vector<int> objects = {};  ///< empty: all
  std::string sensor = {};        ///< of datasets with several: `scene_camera_SENSOR.json`
  /// Every instance, also those that are hardly to be seen or no target of the challenge.
  bool every_instance = false;
  /// Seeds are drawn about the truth, uniformly in the ellipsoids inscribed in this; a case always
  /// gets the same.
  DeclaredUncertainty uncertainty = {Eigen::Vector3d::Constant(0.03),
                                     Eigen::Vector3d::Constant(10.0), UncertaintyPivot::kStation};
};

/// Reads a BOP dataset (bop_toolkit, bop_datasets_format.md) as ours: an object is a station
/// (`obj_000001`, mesh in mm, its symmetries), an instance in an image is a case
/// (`SCENE-IMAGE-OBJECT[-n]`). Of the split `test`, the targets of the challenge
/// (test_targets_bop19.json); where there is no such list, what is visible by a tenth
/// (scene_gt_info.json). InputError: a split, scene or object that is not there, several splits and
/// none chosen, a scene without truth, a camera that is not a pinhole, images or models that are
/// missing.
Dataset readBopDataset(const std::filesystem::path& folder, const BopSelection& selection = {});

/// A folder as a BOP dataset, anything else as a dataset.json (the selection does not matter then).
Dataset openDataset(const std::filesystem::path& path, const BopSelection& selection = {});

/// The completed runs of one method on a BOP dataset as lines of a results file: the score is the
/// edge support, the time that of all runs in the image. Runs from further seeds are left out.
/// InputError when a case is not of a BOP dataset.
std::vector<BopResult> bopResults(const Dataset& dataset, std::span<const RunResult> runs);

}  // namespace boresight::sessions
