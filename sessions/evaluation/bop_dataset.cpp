// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/bop_dataset.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "sessions/evaluation/bop_scene.h"
#include "sessions/evaluation/reseed.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/images/image_decoder.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/meshes/mesh_file.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/units.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

std::optional<int> numberOf(const std::string& text) {
  const auto number = numberIn<int>(text);
  return number && *number >= 0 ? number : std::nullopt;
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    found.push_back(at->path());
  if (error) throw InputError(folder, "", "cannot be listed: " + error.message());
  std::sort(found.begin(), found.end());
  return found;
}

bool isImage(const fs::path& file) {
  const std::string extension = lowerCase(file.extension().string());
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg" ||
         extension == ".tif" || extension == ".tiff";
}

/// Sensors whose files lie in a scene, for messages.
std::string sensorsOf(const fs::path& scene) {
  const std::string start = "scene_camera_";
  std::vector<std::string> names;
  for (const fs::path& file : entries(scene)) {
    const std::string stem = file.stem().string();
    if (stem.rfind(start, 0) == 0) names.push_back(stem.substr(start.size()));
  }
  return joined(names);
}

/// `scene_camera`, `scene_gt` ... of a scene: with the sensor's name where there is one.
fs::path bopSceneFile(const fs::path& scene, const std::string& what, const std::string& sensor) {
  return scene / (what + (sensor.empty() ? "" : "_" + sensor) + ".json");
}

/// The scenes of a split by their numbers.
std::map<int, fs::path> bopScenes(const fs::path& split, const std::string& sensor) {
  std::map<int, fs::path> scenes;
  for (const fs::path& entry : entries(split)) {
    const auto number = numberOf(entry.filename().string());
    if (!number || !fs::is_directory(entry)) continue;
    if (fs::exists(bopSceneFile(entry, "scene_camera", sensor))) {
      scenes.emplace(*number, entry);
    } else if (const std::string sensors = sensorsOf(entry); !sensors.empty()) {
      throw InputError(entry, "",
                       sensor.empty()
                           ? "has several sensors (" + sensors + "): choose one with --sensor"
                           : "has no sensor " + sensor + "; there are " + sensors);
    }
  }
  return scenes;
}

/// The folder of the requested split, or of "test", or of the only one. InputError, listing the
/// existing splits.
fs::path bopSplitFolder(const fs::path& root, const std::string& split, const std::string& sensor) {
  if (!split.empty()) {
    if (fs::is_directory(root / split)) return root / split;
    throw InputError(root, "", "has no split " + split);
  }
  std::vector<std::string> names;
  for (const fs::path& entry : entries(root))
    if (fs::is_directory(entry) && !bopScenes(entry, sensor).empty())
      names.push_back(entry.filename().string());
  if (std::find(names.begin(), names.end(), "test") != names.end()) return root / "test";
  if (names.size() == 1) return root / names.front();
  if (names.empty())
    throw InputError(root, "",
                     "is not a BOP dataset: no folder in it has scenes with scene_camera.json");
  throw InputError(root, "", "has several splits, choose one with --split: " + joined(names));
}

/// The images of a scene by their numbers: of the folder rgb or gray (with several sensors: of the
/// sensor's), PNG, JPEG or TIFF. InputError when there is no such folder.
std::map<int, fs::path> bopImages(const fs::path& scene, const std::string& sensor) {
  const std::string end = sensor.empty() ? "" : "_" + sensor;
  std::vector<std::string> names = {"rgb" + end, "gray" + end};
  if (!sensor.empty()) names.insert(names.begin(), sensor);
  for (const std::string& name : names) {
    if (!fs::is_directory(scene / name)) continue;
    std::map<int, fs::path> images;
    for (const fs::path& file : entries(scene / name))
      if (const auto number = numberOf(file.stem().string()); number && isImage(file))
        if (const auto [known, is_new] = images.emplace(*number, file); !is_new)
          throw InputError(file, "",
                           "is image " + bopNumber(*number) + ", as is " +
                               known->second.filename().string() + ": remove one");
    return images;
  }
  throw InputError(scene, "", "has no folder of images (" + joined(names) + ")");
}

/// The folder with models_info.json: models, models_cad, models_eval, or another one that begins
/// so. InputError.
fs::path bopModels(const fs::path& root) {
  for (const char* name : {"models", "models_cad", "models_eval"})
    if (fs::exists(root / name / "models_info.json")) return root / name;
  for (const fs::path& entry : entries(root))
    if (entry.filename().string().rfind("models", 0) == 0 && fs::exists(entry / "models_info.json"))
      return entry;
  throw InputError(root, "", "has no folder models with a models_info.json");
}

constexpr const char* kTargets = "test_targets_bop19.json";

/// (scene, image, object) -> number of target instances; empty without a list.
using BopTargets = std::map<std::tuple<int, int, int>, int>;

std::optional<BopTargets> bopTargets(const fs::path& root) {
  const fs::path file = root / kTargets;
  if (!fs::exists(file)) return std::nullopt;
  constexpr int kMaxId = 1 << 30;
  BopTargets targets;
  const JsonDocument document(file);
  for (const JsonReader& entry : document.root().elements()) {
    const auto id = [&entry](const char* key) {
      return static_cast<int>(entry.at(key).integer(0, kMaxId));
    };
    if (!targets.emplace(std::tuple(id("scene_id"), id("im_id"), id("obj_id")), id("inst_count"))
             .second)
      entry.fail("the target is listed twice");
  }
  return targets;
}

constexpr double kLeastVisible = 0.1;  ///< visible share of the challenge's objects

/// An entry of models_info.json.
struct Model {
  std::string name;
  Station station;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  double diagonal_m = 0.0;
};

std::map<int, Model> readModels(const fs::path& folder) {
  std::map<int, Model> models;
  const JsonDocument document(folder / "models_info.json");
  for (const auto& [number, entry] : bopEntries(document.root())) {
    Model model;
    model.name = "obj_" + bopNumber(number);
    PartSource& part = model.station.parts.emplace_back();
    part.mesh = folder / (model.name + ".ply");
    part.mesh_unit = "mm";
    model.station.symmetries = readBopSymmetries(entry);
    Eigen::Vector3d size_m;
    int i = 0;
    for (const char* axis : {"x", "y", "z"}) {
      size_m[i] = entry.at(std::string("size_") + axis).number() / kMillimetres;
      model.centre_m[i] =
          entry.at(std::string("min_") + axis).number() / kMillimetres + 0.5 * size_m[i];
      ++i;
    }
    model.diagonal_m = size_m.norm();
    models.emplace(number, std::move(model));
  }
  return models;
}

/// Visible share of each instance, by image; empty when the scene does not state it.
std::map<int, std::vector<double>> readVisibility(const fs::path& file) {
  std::map<int, std::vector<double>> shares;
  if (!fs::exists(file)) return shares;
  const JsonDocument document(file);
  for (const auto& [id, list] : bopEntries(document.root()))
    for (const JsonReader& entry : list.elements()) {
      const auto share = entry.find("visib_fract");
      shares[id].push_back(share ? share->number() : 1.0);
    }
  return shares;
}

/// Hash of the inputs of runs: ids of cases, seeds, truths and cameras.
std::string digestOf(const Dataset& dataset) {
  std::string text;
  const auto add = [&text](const Pose& pose) {
    const Eigen::Quaterniond& q = pose.rotation;
    const Eigen::Vector3d& t = pose.translation_m;
    text += " " + numbersText({q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()});
  };
  for (const Case& dataset_case : dataset.cases) {
    text += dataset_case.id;
    add(dataset_case.seed_camera_from_station);
    add(*dataset_case.truth_camera_from_station);
    const Camera& camera = dataset.cameraOf(dataset_case);
    text += " " + numbersText({camera.fx, camera.fy, camera.cx, camera.cy}) + "\n";
  }
  return sha256Text(text);
}

class Reader {
 public:
  Reader(const fs::path& root, const BopSelection& selection)
      : root_(root), selection_(selection), models_(readModels(bopModels(root))) {}

  Dataset read();

 private:
  struct Instance {
    BopObject object;
    double visible = 1.0;
  };

  void requireTargets() const;
  void readScene(int scene_id, const fs::path& folder);
  std::vector<Instance> chosen(int scene_id, int image_id, std::vector<Instance> instances);
  void addCase(int scene_id, const BopObject& object, int repetition, const fs::path& image);
  std::string cameraOf(const Camera& camera);
  bool wants(const std::vector<int>& list, int number) const {
    return list.empty() || std::find(list.begin(), list.end(), number) != list.end();
  }

  fs::path root_;
  const BopSelection& selection_;
  std::map<int, Model> models_;
  std::optional<BopTargets> targets_;
  std::int64_t hidden_ = 0;  ///< instances that are left out as hardly visible
  Dataset dataset_;
};

Dataset Reader::read() {
  dataset_.file = root_;
  for (const int object : selection_.objects)
    if (!models_.contains(object))
      throw InputError(root_, "models_info.json", "there is no object " + std::to_string(object));
  const fs::path split = bopSplitFolder(root_, selection_.split, selection_.sensor);
  if (split.filename() == "test" && !selection_.every_instance) targets_ = bopTargets(root_);
  const std::map<int, fs::path> scenes = bopScenes(split, selection_.sensor);
  for (const int scene : selection_.scenes)
    if (!scenes.contains(scene)) throw InputError(split, "", "has no scene " + bopNumber(scene));
  for (const auto& [id, folder] : scenes)
    if (wants(selection_.scenes, id)) readScene(id, folder);
  requireTargets();
  if (dataset_.cases.empty())
    throw InputError(split, "",
                     hidden_ == 0 ? "the selection is empty"
                                  : "the selection is empty: " + countText(hidden_, "instance") +
                                        " of less than 10 % visibility are left out "
                                        "(--every-instance takes them)");
  dataset_.sha256 = digestOf(dataset_);
  return std::move(dataset_);
}

/// A target without its case would leave the challenge's rates another denominator.
void Reader::requireTargets() const {
  if (!targets_) return;
  std::map<BopTargets::key_type, int> found;
  for (const Case& dataset_case : dataset_.cases)
    ++found[{dataset_case.bop->scene_id, dataset_case.bop->image_id, dataset_case.bop->object_id}];
  int missing = 0;
  std::string first;
  for (const auto& [target, count] : *targets_) {
    const auto& [scene, image, object] = target;
    const auto cases = found.find(target);
    const int lacks = count - (cases == found.end() ? 0 : cases->second);
    if (!wants(selection_.scenes, scene) || !wants(selection_.objects, object) || lacks <= 0)
      continue;
    if (missing == 0)
      first = "object " + std::to_string(object) + " in image " + std::to_string(image) +
              " of scene " + std::to_string(scene);
    missing += lacks;
  }
  if (missing > 0)
    throw InputError(root_ / kTargets, "",
                     countText(missing, "target instance") + " without a true pose, the first " +
                         first + ": choose scenes (--scene), or take --every-instance");
}

void Reader::readScene(int scene_id, const fs::path& folder) {
  const std::string& sensor = selection_.sensor;
  const fs::path truth = bopSceneFile(folder, "scene_gt", sensor);
  if (!fs::exists(truth))
    throw InputError(truth, "", "is missing: seeds are drawn about true poses");
  const auto objects = readBopScene(bopSceneFile(folder, "scene_camera", sensor), truth);
  const auto visible = readVisibility(bopSceneFile(folder, "scene_gt_info", sensor));
  const auto images = bopImages(folder, sensor);
  std::map<int, std::vector<Instance>> instances;
  for (const BopObject& object : objects) {
    auto& list = instances[object.image.id];
    const auto shares = visible.find(object.image.id);
    const bool known = shares != visible.end() && list.size() < shares->second.size();
    list.push_back({object, known ? shares->second[list.size()] : 1.0});
  }
  std::optional<ImageHeader> size;  // BOP does not state it; a scene is taken by one camera
  for (const auto& [image_id, list] : instances) {
    std::vector<Instance> wanted = chosen(scene_id, image_id, list);
    if (wanted.empty()) continue;
    const auto image = images.find(image_id);
    if (image == images.end()) throw InputError(folder, "", "has no image " + bopNumber(image_id));
    if (!size)
      size = readImageHeader(image->second, readFileBytes(image->second, kMaxImageFileBytes));
    std::map<int, int> repetitions;
    for (Instance& instance : wanted) {
      BopObject& object = instance.object;
      object.image.camera.width = size->width;
      object.image.camera.height = size->height;
      addCase(scene_id, object, ++repetitions[object.object_id], image->second);
    }
  }
}

std::vector<Reader::Instance> Reader::chosen(int scene_id, int image_id,
                                             std::vector<Instance> instances) {
  std::erase_if(instances, [this](const Instance& instance) {
    return !wants(selection_.objects, instance.object.object_id);
  });
  if (selection_.every_instance) return instances;
  if (!targets_) {
    hidden_ += static_cast<std::int64_t>(std::erase_if(
        instances, [](const Instance& instance) { return instance.visible < kLeastVisible; }));
    return instances;
  }
  // Of several instances the challenge requires the most visible ones.
  std::stable_sort(instances.begin(), instances.end(),
                   [](const Instance& a, const Instance& b) { return a.visible > b.visible; });
  std::map<int, int> taken;
  std::erase_if(instances, [&](const Instance& instance) {
    const int object = instance.object.object_id;
    const auto target = targets_->find({scene_id, image_id, object});
    return target == targets_->end() || ++taken[object] > target->second;
  });
  return instances;
}

std::string Reader::cameraOf(const Camera& camera) {
  for (const auto& [id, known] : dataset_.cameras)
    if (known.camera == camera) return id;
  const std::string id = "camera_" + bopNumber(static_cast<int>(dataset_.cameras.size()) + 1);
  dataset_.cameras.emplace(id, CameraFile{camera});
  return id;
}

void Reader::addCase(int scene_id, const BopObject& object, int repetition, const fs::path& image) {
  const auto model = models_.find(object.object_id);
  if (model == models_.end())
    throw InputError(root_, "models_info.json",
                     "there is no object " + std::to_string(object.object_id) +
                         ", which is in scene " + bopNumber(scene_id));
  constexpr double kNearest = 0.05;  // of the object's size
  if (const double distance_m = object.image.camera_from_station.translation_m.norm();
      distance_m < kNearest * model->second.diagonal_m)
    throw InputError(image, "scene_gt.json",
                     "cam_t_m2c: object " + std::to_string(object.object_id) + " is " +
                         lengthText(distance_m) + " from the camera, at a size of " +
                         lengthText(model->second.diagonal_m) + ": the format's unit is the mm");
  Camera camera = object.image.camera;
  if (prepareCamera(camera) != Status::kOk)
    throw InputError(image, "scene_camera.json", "cam_K cannot be a camera's");
  dataset_.stations.emplace(model->second.name, model->second.station);
  Case dataset_case;
  dataset_case.id = bopNumber(scene_id) + "-" + bopNumber(object.image.id) + "-" +
                    bopNumber(object.object_id) +
                    (repetition > 1 ? "-" + std::to_string(repetition) : "");
  dataset_case.station = model->second.name;
  dataset_case.camera = cameraOf(camera);
  dataset_case.image = image;
  dataset_case.uncertainty = selection_.uncertainty;
  dataset_case.truth_camera_from_station = object.image.camera_from_station;
  dataset_case.seed_camera_from_station = seedForOffset(
      object.image.camera_from_station, drawOffset(selection_.uncertainty, 1.0, dataset_case.id, 0),
      selection_.uncertainty.pivot, model->second.centre_m);
  dataset_case.tags = {"scene_" + bopNumber(scene_id)};
  dataset_case.bop = BopKey{scene_id, object.image.id, object.object_id};
  dataset_.cases.push_back(std::move(dataset_case));
}

}  // namespace

Dataset openDataset(const fs::path& path, const BopSelection& selection) {
  return fs::is_directory(path) ? Reader(path, selection).read() : readDataset(path);
}

std::vector<BopResult> bopResults(const Dataset& dataset, std::span<const RunResult> runs) {
  for (const Case& dataset_case : dataset.cases)
    if (!dataset_case.bop)
      throw InputError(dataset.file, "cases." + dataset_case.id, "is not part of a BOP dataset");
  std::map<std::pair<int, int>, double> seconds;
  std::vector<BopResult> results;
  for (const RunResult& run : runs) {
    const Case* dataset_case = dataset.findCase(run.case_id);
    if (run.reseed != 0 || dataset_case == nullptr) continue;
    seconds[{dataset_case->bop->scene_id, dataset_case->bop->image_id}] += run.seconds.total();
    if (run.completed)
      results.push_back({dataset_case->bop->scene_id, dataset_case->bop->image_id,
                         dataset_case->bop->object_id, run.edge_support, run.camera_from_station,
                         0.0});
  }
  for (BopResult& result : results) result.seconds = seconds[{result.scene_id, result.image_id}];
  return results;
}

}  // namespace boresight::sessions
