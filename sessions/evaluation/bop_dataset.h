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

/// Part of a BOP dataset to be read, and the declared uncertainty of its seeds.
struct BopSelection {
  /// Folder of scenes, e.g. "val"; empty: "test", or the only folder.
  std::string split = {};
  std::vector<int> scenes = {};   ///< empty: all
  std::vector<int> objects = {};  ///< empty: all
  std::string sensor = {};        ///< of datasets with several: `scene_camera_SENSOR.json`
  /// All instances, including hardly visible ones and those that are not targets of the challenge.
  bool every_instance = false;
  /// Seeds are drawn about the truth, uniformly in the ellipsoids inscribed in this; a case always
  /// gets the same seed.
  DeclaredUncertainty uncertainty = {Eigen::Vector3d::Constant(0.03),
                                     Eigen::Vector3d::Constant(10.0), UncertaintyPivot::kStation};
};

/// Reads a file as dataset.json (without the selection), a folder as a BOP dataset (bop_toolkit,
/// bop_datasets_format.md): an object is a station (`obj_000001`, mesh in mm, its symmetries), an
/// instance in an image is a case (`SCENE-IMAGE-OBJECT[-n]`). Of the split `test`, the targets of
/// the challenge are read (test_targets_bop19.json); without such a list, instances that are at
/// least 10 % visible (scene_gt_info.json). InputError: a missing split, scene, object, image or
/// model, several splits without a choice, a scene without truth, a camera that is not a pinhole.
Dataset openDataset(const std::filesystem::path& path, const BopSelection& selection = {});

/// The completed runs of one method on a BOP dataset as lines of a results file: the score is the
/// edge support, the time is that of all runs in the image. Runs from further seeds are left out.
/// InputError when a case is not of a BOP dataset.
std::vector<BopResult> bopResults(const Dataset& dataset, std::span<const RunResult> runs);

}  // namespace boresight::sessions
