// SPDX-License-Identifier: Apache-2.0
// Where a BOP dataset has its files; what bop_dataset.cpp reads them with.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

namespace boresight::sessions {

/// "000007", as BOP names scenes, images and objects.
std::string bopNumber(int number);

/// The folder of the split that is asked for, or of "test", or of the only one. InputError, listing
/// what there is.
std::filesystem::path bopSplitFolder(const std::filesystem::path& root, const std::string& split,
                                     const std::string& sensor);

/// `scene_camera`, `scene_gt` ... of a scene: with the sensor's name where there is one.
std::filesystem::path bopSceneFile(const std::filesystem::path& scene, const std::string& what,
                                   const std::string& sensor);

/// The scenes of a split by their numbers.
std::map<int, std::filesystem::path> bopScenes(const std::filesystem::path& split,
                                               const std::string& sensor);

/// The images of a scene by their numbers: of the folder rgb or gray (with several sensors: of the
/// sensor's), PNG, JPEG or TIFF. InputError when there is no such folder.
std::map<int, std::filesystem::path> bopImages(const std::filesystem::path& scene,
                                               const std::string& sensor);

/// The folder with models_info.json: models, models_cad, models_eval, or another one that begins
/// so. InputError.
std::filesystem::path bopModels(const std::filesystem::path& root);

/// (scene, image, object) -> how many instances are asked for; nothing when there is no list.
using BopTargets = std::map<std::tuple<int, int, int>, int>;
std::optional<BopTargets> bopTargets(const std::filesystem::path& root);

}  // namespace boresight::sessions
