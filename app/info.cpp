// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "app/commands.h"
#include "sessions/annotation/annotations_file.h"
#include "sessions/annotation/landmarks.h"
#include "sessions/io/cameras/cahvor_file.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/cameras/frame_transform.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/images/image_file.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/meshes/mesh_container.h"
#include "sessions/record/onboard_record.h"
#include "sessions/review/review_status.h"
#include "sessions/review/validated_pose_file.h"
#include "sessions/session/input_check.h"
#include "sessions/session/input_sheet.h"
#include "sessions/session/session_file.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"
#include "sessions/trace/run_text.h"
#include "sessions/trace/trace_file.h"

namespace boresight::app {
namespace {

using sessions::countText;
using sessions::fixedText;
using sessions::sizeText;
using std::filesystem::path;

/// Of a session, since the inputs of each are read.
constexpr std::size_t kDescribedCases = 200;

void line(const std::string& text) { std::cout << sessions::plainLine("  " + text); }
void flag(const std::string& text) { line("! " + text); }

std::string vectorText(const Eigen::Vector3d& vector, int decimals) {
  return fixedText(vector.x(), decimals) + " " + fixedText(vector.y(), decimals) + " " +
         fixedText(vector.z(), decimals);
}

void flagAll(const std::vector<sessions::RedFlag>& flags) {
  for (const sessions::RedFlag& red_flag : flags) flag(red_flag.text);
}

void describeCamera(const sessions::CameraFile& file) {
  const sessions::CameraSheet sheet = sessions::cameraSheet(file.camera);
  for (const std::string& text : sheet.lines) line(text);
  if (file.reference) {
    line("vectors in " + frameText(file.reference->frame) + ", the camera's centre at " +
         vectorText(file.reference->camera_from_reference.inverse().translation_m, 4) + " m");
  }
  if (pupilMoves(file.camera))
    line("the entrance pupil moves from " + fixedText(1e3 * file.camera.cahv.pupil_low_m, 2) +
         " to " + fixedText(1e3 * file.camera.cahv.pupil_high_m, 2) + " mm along the optical axis");
  flagAll(sheet.flags);
}

void describeRecord(const sessions::OnboardRecord& record) {
  line("onboard record, " + std::to_string(record.iterations.size()) + " iterations" +
       (record.inputs ? ", image " + sizeText(record.inputs->width, record.inputs->height) + " px"
                      : ""));
  if (record.end)
    line(std::string(localizationStatusText(record.end->status)) + ", digest " +
         record.end->digest);
  for (const std::string& text : record.missing) flag("missing: " + text);
}

void describeDataset(const sessions::Dataset& dataset) {
  line(countText(std::ssize(dataset.cases), "case") + ", " +
       countText(std::ssize(dataset.stations), "station") + ", " +
       countText(std::ssize(dataset.cameras), "camera"));
  std::map<std::string, std::int64_t> cases_of;
  for (const sessions::Case& dataset_case : dataset.cases) ++cases_of[dataset_case.station];
  for (const auto& [id, station] : dataset.stations) {
    line("station " + id + ": " + countText(cases_of[id], "case") + ", " +
         countText(std::ssize(station.parts), "part") +
         (station.feature_size_m
              ? ", feature size " + fixedText(1e3 * *station.feature_size_m, 3) + " mm"
              : "") +
         (station.symmetries.empty()
              ? ""
              : ", symmetries: " + sessions::symmetriesText(station.symmetries)));
    for (const sessions::PartSource& part : station.parts) line("  part " + partText(part));
  }
  for (const auto& [id, camera] : dataset.cameras) {
    line("camera " + id + ":");
    describeCamera(camera);
  }
  std::set<std::string> tags;
  for (const sessions::Case& dataset_case : dataset.cases)
    tags.insert(dataset_case.tags.begin(), dataset_case.tags.end());
  std::string list;
  for (const std::string& tag : tags) list += " " + tag;
  if (!list.empty()) line("tags:" + list);
  const auto blind =
      std::count_if(dataset.cases.begin(), dataset.cases.end(),
                    [](const auto& item) { return !item.truth_camera_from_station; });
  if (blind > 0) flag(std::to_string(blind) + " cases have no truth");
  for (const std::string& text : dataset.notes) flag(text);
  sessions::requireFiles(dataset);
}

void describeAnnotations(const sessions::Annotations& annotations) {
  const auto used = [](const auto& pairs) {
    return std::count_if(pairs.begin(), pairs.end(), [](const auto& pair) { return pair.used(); });
  };
  line(std::to_string(annotations.points.size()) + " points, " +
       std::to_string(used(annotations.points)) + " of them complete and enabled; " +
       std::to_string(annotations.lines.size()) + " lines, " +
       std::to_string(used(annotations.lines)));
  if (used(annotations.points) < 4) flag("without a seed a pose needs at least 4 points");
}

std::string stalenessText(const sessions::Staleness& staleness) {
  if (!staleness.stale()) return "";
  return std::string(", outdated: ") + (staleness.inputs_changed ? "inputs" : "") +
         (staleness.inputs_changed && staleness.options_changed ? " and " : "") +
         (staleness.options_changed ? "options" : "") + " changed since";
}

std::string rerunText(const sessions::RunRecord& run) {
  if (!run.rerun) return "";
  if (run.rerun->changes.empty()) return ", with options of its own";
  const int from_iteration = run.rerun->changes.back().iteration + 1;
  return ", with other options from its iteration " + std::to_string(from_iteration) + " on" +
         (run.rerun->from.empty() ? "" : ", continued from run " + run.rerun->from);
}

/// `previous`: the case described last, or null; replaced by this case. Files that both share are
/// read once.
void describeCase(const sessions::SessionCase& session_case, const sessions::Session& session,
                  const path& file, std::shared_ptr<const sessions::LoadedCase>& previous) {
  line("case " + session_case.id +
       (session_case.station.empty() ? "" : ", station " + session_case.station));
  try {
    previous = previous ? reloadCase(*previous, session_case) : sessions::loadCase(session_case);
    const sessions::InputSheet sheet = sessions::inputSheet(*previous);
    for (const sessions::SheetLine& entry : sheet.lines)
      line("  " + entry.label + ": " + entry.value);
    flagAll(sheet.flags);
  } catch (const sessions::InputError& error) {
    flag(error.what());
  }
  for (const sessions::RunRecord& run : session.runs) {
    if (run.case_id != session_case.id) continue;
    line("  run " + run.digest + ": " + run.status + ", " + run.time + ", whs " + run.version +
         stalenessText(sessions::stalenessOf(run, session, file)) + rerunText(run) +
         (run.together ? ", " + togetherText(run.together->views, session_case.id) : ""));
  }
  const sessions::ReviewStatus status = sessions::reviewStatusOf(session, session_case.id);
  if (status.decision != nullptr)
    line("  " + reviewStatusText(status) + ", " + status.decision->time +
         (status.decision->comment.empty() ? "" : ": " + status.decision->comment));
}

void describeSession(const path& file) {
  const auto document = sessions::SessionDocument::open(file, sessions::Access::kReadOnly);
  const sessions::Session& session = document.session();
  line(countText(std::ssize(session.cases), "case") + ", " +
       countText(std::ssize(session.runs), "run") + ", profile " + session.profile + ", " +
       std::to_string(session.options.size()) +
       " options differ: " + sessions::toJson(session.options).dump());
  if (const auto holder = sessions::readLockFile(sessions::lockFileOf(document.file())))
    line((sessions::hasEnded(*holder) ? "was left open by " : "is open in ") + holder->text());
  for (const std::string& text : document.notices()) flag(text);
  if (document.recovery())
    flag(document.unsavedText() + "; the last is of " + document.recovery()->time);
  std::shared_ptr<const sessions::LoadedCase> previous;
  const std::size_t described = std::min(session.cases.size(), kDescribedCases);
  for (std::size_t i = 0; i < described; ++i)
    describeCase(*session.cases[i], session, file, previous);
  if (described < session.cases.size())
    line("and " + countText(std::ssize(session.cases) - described, "more case") +
         ": whs queue lists them");
  for (const sessions::Finding& finding : sessions::checkInputs(session))
    if (finding.what == "run" || finding.what == "onboard_record") flag(finding.text);
}

void printPose(const Pose& pose, const char* name) {
  std::cout << sessions::poseText(pose, Matrix6d::Zero(), name);
}

/// The other members of a pose file, in its frame.
void describeSeed(const sessions::PoseFile& pose) {
  if (pose.uncertainty)
    line("uncertainty " + vectorText(pose.uncertainty->translation_m, 4) + " m, " +
         vectorText(pose.uncertainty->rotation_deg, 2) + " deg about the " +
         (pose.uncertainty->pivot == sessions::UncertaintyPivot::kStation ? "station" : "camera") +
         ", along and about the camera's axes");
  const std::string projected = sessions::projectionNote(pose.rotation_deviation);
  if (!projected.empty()) flag(projected);
}

void describeCameraPose(const sessions::PoseFile& pose) {
  printPose(pose.camera_from_station, "camera_from_station");
  const Eigen::Vector3d camera_in_station_m = pose.camera_from_station.inverse().translation_m;
  line("camera centre in the station frame " + vectorText(camera_in_station_m, 4) + " m");
  describeSeed(pose);
  if (pose.camera_from_station.translation_m.z() <= 0.0)
    flag("the station's origin lies behind the camera");
}

/// A pose in the frame of a camera model, which this file alone does not place in the camera.
void describeReferencePose(const path& file, const sessions::JsonReader& root) {
  sessions::CameraReference there;
  if (const auto frame = root.find("reference_frame"))
    there.frame = sessions::readFrameName(*frame);
  line("reference_from_station in " +
       (there.frame.name.empty() ? "the frame of the camera model" : frameText(there.frame)));
  const sessions::PoseFile pose = sessions::readPose(file, {there, {}});
  printPose(pose.camera_from_station, "reference_from_station");
  describeSeed(pose);
}

/// pose.json, in the camera's frame or in a named one.
void describePoseFile(const path& file, const sessions::JsonReader& root) {
  if (root.has("reference_from_station") && !root.has("camera_from_station"))
    describeReferencePose(file, root);
  else
    describeCameraPose(sessions::readPose(file));
}

std::string sigmaText(const Matrix6d& covariance) {
  const Vector6d sigma = 1e3 * sessions::sigmasOf(covariance);
  std::string text = "1 sigma";
  for (const auto& [first, unit] : {std::pair(3, "mm"), std::pair(0, "mrad")}) {
    for (int axis = first; axis < first + 3; ++axis)
      text += " " + sessions::fixedText(sigma[axis], 3);
    text += std::string(" ") + unit + (first == 3 ? "," : "");
  }
  return text;
}

/// Transforms, and chains of them, that are printed.
constexpr std::size_t kMostPrinted = 50;

void describeTransform(const sessions::FrameTransform& transform) {
  std::string text = "from " + frameText(transform.source) + " to " + frameText(transform.target) +
                     ": " + transform.comment;
  if (transform.origin != sessions::TransformSource::kUnstated)
    text += std::string(" (") +
            sessions::kTransformSourceNames[static_cast<std::size_t>(transform.origin)] + ")";
  line(text);
  printPose(transform.target_from_source, "target_from_source");
  if (transform.covariance) line("  " + sigmaText(*transform.covariance) + ", target frame");
}

/// What each frame is from the first one, with each transform's share of the covariance.
void describeChains(const sessions::FrameTree& tree) {
  const std::vector<sessions::FrameName> frames = tree.frames();
  const bool camera =
      std::find(frames.begin(), frames.end(), sessions::kCameraFrame) != frames.end();
  const sessions::FrameName& first = camera ? sessions::kCameraFrame : frames.front();
  std::size_t printed = 0;
  for (const sessions::FrameName& frame : frames) {
    const auto chain = tree.chain(first, frame);
    if (!chain || chain->links.empty()) continue;
    if (++printed > kMostPrinted) {
      line("... chains to further frames of " + std::to_string(frames.size()) + " are left out");
      break;
    }
    line(chain->path());
    printPose(chain->a_from_b, "first_from_last");
    if (!chain->covariance_stated) continue;
    for (const sessions::FrameLink& link : chain->links)
      line("  " + sigmaText(link.contribution) + " by " + link.transform->comment);
    line("  " + sigmaText(chain->covariance) + " in all, in " + frameText(first));
  }
}

void describeFrames(const path& file) {
  const auto transforms = sessions::readFrameTransforms(file);
  for (std::size_t i = 0; i < std::min(transforms.size(), kMostPrinted); ++i)
    describeTransform(transforms[i]);
  if (transforms.size() > kMostPrinted)
    line("... " + std::to_string(transforms.size() - kMostPrinted) + " more transforms");
  if (transforms.size() > 1) describeChains(sessions::FrameTree(transforms));
}

/// validated_pose.json: what it states; `whs verify` asks whether that is so.
void describeValidatedPose(const sessions::JsonReader& root) {
  line("case " + root.at("case").text() + ": " + root.at("review_status").text());
  printPose(sessions::readTransform(root.at("pose").at("camera_from_station")),
            "camera_from_station");
  if (const auto frames = root.find("frames"))
    for (const auto& [name, frame] : frames->members()) {
      line("in " + name);
      printPose(sessions::readTransform(frame.at("reference_from_station")),
                "reference_from_station");
    }
  line("whs verify checks it against its checksum and its inputs");
}

/// rig.json, with the cameras and points that it names.
void describeRig(const path& file) {
  for (const sessions::AnnotatedView& view : sessions::readRig(file)) {
    line("view " + view.name + ": camera of " + std::to_string(view.camera.width) + " x " +
         std::to_string(view.camera.height) + " px, " +
         countText(std::ssize(view.annotations.points), "point") + ", " +
         countText(std::ssize(view.annotations.lines), "line"));
    printPose(view.camera_from_rig, "camera_from_rig");
  }
}

void describeConfig(const sessions::Config& config) {
  LocalizerOptions options = profileOptions(config.profile);
  sessions::applyConfig(options, config);  // rejects unknown options
  line("profile " + config.profile + ", " + std::to_string(config.options.size()) +
       " options differ: " + sessions::toJson(config.options).dump());
}

void describeJson(const path& file) {
  const sessions::JsonDocument document(file);
  const auto stated = document.root().find("format");
  if (!stated)
    throw sessions::InputError(file, "format",
                               "missing: state what the file is, e.g. \"format\": "
                               "\"boresight-camera\", \"version\": 1");
  const std::string format = stated->nonEmptyText();
  line(format);
  if (format == "boresight-camera") return describeCamera(sessions::readCameraFile(file));
  if (format == "boresight-pose") return describePoseFile(file, document.root());
  if (format == "boresight-transform" || format == "boresight-frames") return describeFrames(file);
  if (format == "boresight-dataset") return describeDataset(sessions::readDataset(file));
  if (format == "boresight-points") return describeAnnotations(sessions::readAnnotations(file));
  if (format == sessions::kSessionFormat) return describeSession(file);
  if (format == "boresight-config") return describeConfig(sessions::readConfig(file));
  if (format == sessions::kValidatedPoseFormat) return describeValidatedPose(document.root());
  if (format == "boresight-rig") return describeRig(file);
  if (format == "boresight-landmarks")
    return line(countText(sessions::readLandmarks(file).size(), "landmark"));
  if (format != "boresight-result")
    throw sessions::InputError(file, "format", "\"" + format + "\" is not known");
}

void describeMesh(const path& file, const std::string& unit) {
  const sessions::MeshFormat format = sessions::meshFormatOf(file);
  const bool stated = !unit.empty() || sessions::carriesUnit(format);
  const sessions::Mesh mesh = sessions::readMesh(file, stated ? unit : "m");
  const sessions::MeshInfo& info = mesh.info;
  const Eigen::Vector3d extent = (info.maximum_m - info.minimum_m);
  line(info.format + ", " + std::to_string(mesh.vertices_m.size()) + " vertices, " +
       std::to_string(mesh.faces.size()) + " faces");
  if (stated) {
    line("extent " + vectorText(extent, 4) + " m, from " + vectorText(info.minimum_m, 4) + " to " +
         vectorText(info.maximum_m, 4) + " m");
  } else {
    line("extent " + vectorText(extent, 4) + " in the file's unit, which is not stated: in m " +
         fixedText(extent.norm(), 3) + " m across, in mm " + fixedText(extent.norm() * 1e-3, 6) +
         " m");
    if (extent.norm() > 20.0) flag("over 20 m across if in m: probably in mm");
  }
  for (const std::string& text : info.notes()) flag(text);
}

std::string frameLine(const sessions::LabelFrame& frame) {
  const Pose& pose = frame.reference_from_frame;
  const Eigen::Quaterniond& q = pose.rotation;
  return frameText(frame.frame) + " in " + frameText(frame.reference) + ": at " +
         vectorText(pose.translation_m, 4) + " m, wxyz " + fixedText(q.w(), 6) + " " +
         fixedText(q.x(), 6) + " " + fixedText(q.y(), 6) + " " + fixedText(q.z(), 6);
}

void describeLabel(const sessions::ImageLabel& label) {
  for (const sessions::SheetLine& entry : sessions::labelLines(label))
    line(entry.label + ": " + entry.value);
  if (label.camera) {
    line("camera of the label:");
    describeCamera(*label.camera);
  }
  for (const sessions::LabelItem& item : label.camera_items)
    line("camera " + item.name + ": " + item.value);
  for (const sessions::LabelFrame& frame : label.frames) line("frame " + frameLine(frame));
  if (!label.camera) flag(label.camera_remark);
}

void describeImage(const path& file) {
  const sessions::GrayImage image = sessions::readImage(file);
  line(image.container + ", " + sizeText(image.width, image.height) + " px, " +
       countText(image.channels, "channel") + ", " + std::to_string(image.sample_bits) + " bit");
  line("to 8 bit: " + image.rule);
  const sessions::ImageSheet sheet = sessions::imageSheet(image);
  line("gray " + std::to_string(sheet.lowest_gray) + " .. " + std::to_string(sheet.highest_gray) +
       ", " + sessions::percentText(sheet.saturated_share, 2) + " saturated");
  line("sha256 " + image.file_sha256);
  flagAll(sheet.flags);
  if (image.label) describeLabel(*image.label);
}

void describeTrace(const path& file) {
  const sessions::LocalizationTrace trace = sessions::loadTrace(file);
  line("trace by whs " + trace.version + ": " + localizationStatusText(trace.status) + ", digest " +
       trace.digest);
  std::cout << sessions::iterationTable(trace);
}

bool beginsLikeTrace(const path& file) {
  return sessions::asText(sessions::readBeginning(file, 8)) == "BSTRACE\n";
}

void describeFolder(const path& folder, DatasetArguments arguments) {
  line("BOP dataset");
  arguments.path = folder.string();
  describeDataset(arguments.open());
}

void describe(const path& file, const std::string& mesh_unit, const DatasetArguments& choice) {
  print(file.string());
  if (std::filesystem::is_directory(file)) return describeFolder(file, choice);
  const std::string extension = sessions::lowerCase(file.extension().string());
  const auto is = [&extension](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), extension) != names.end();
  };
  if (sessions::isCahvorFile(file)) return describeCamera(sessions::readCahvorCamera(file));
  if (is({".json"})) return describeJson(file);
  if (is({".csv"})) return describeAnnotations(sessions::readAnnotations(file));
  if (is({".ply", ".obj", ".stl", ".gltf", ".glb"})) return describeMesh(file, mesh_unit);
  if (is({".png", ".jpg", ".jpeg", ".tif", ".tiff"}) || sessions::hasImageLabel(file))
    return describeImage(file);
  if (is({".whsr"})) return describeRecord(sessions::readRecord(file));
  if (beginsLikeTrace(file)) return describeTrace(file);
  throw sessions::InputError(
      file, "neither an image, a mesh, a JSON file, a table of points, a record, nor a trace");
}

struct InfoArguments {
  std::vector<std::string> files;
  std::string mesh_unit;
  DatasetArguments choice;

  void addTo(CLI::App& command) {
    addFile(command, "files", files,
            "Images, cameras, meshes, poses (validated ones, too), transforms, datasets, sessions, "
            "configs, points, rigs, landmarks, traces, onboard records; folders of BOP datasets")
        ->required();
    addMeshUnit(command, mesh_unit, "Unit of meshes without one");
    choice.addTo(command);
  }
};

/// Every file is described; a bad one does not keep the others from it.
int describeAll(const InfoArguments& arguments) {
  int exit_code = kDone;
  for (const std::string& file : arguments.files) {
    try {
      describe(file, arguments.mesh_unit, arguments.choice);
    } catch (const sessions::FileError& error) {
      std::cerr << error.what() << std::endl;
      exit_code = kBadInput;
    }
  }
  std::cout << std::flush;
  return exit_code;
}

}  // namespace

void addInfo(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "info",
             "Describes files: size, unit, camera model, field of view, warnings", describeAll);
}

}  // namespace boresight::app
