// SPDX-License-Identifier: Apache-2.0
#include "sessions/exchange/annotation_exchange.h"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "sessions/annotation/annotations_file.h"
#include "sessions/annotation/annotations_on_image.h"
#include "sessions/annotation/landmarks.h"
#include "sessions/evaluation/bop_scene.h"
#include "sessions/exchange/colmap_text.h"
#include "sessions/io/cameras/camera_conversion.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/cameras/undistort.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/images/image_file.h"
#include "sessions/review/review_status.h"
#include "sessions/review/validated_pose_file.h"
#include "sessions/session/case_annotations.h"
#include "sessions/session/case_run.h"
#include "sessions/session/image_names.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

const Annotations& requireAnnotations(const Session& session, const std::string& case_id) {
  (void)knownCase(session, case_id);
  const auto found = session.annotations.find(case_id);
  if (found == session.annotations.end())
    throw InputError("session", "annotations", "case '" + case_id + "' has no annotations");
  return *found->second;
}

std::size_t placeOf(const Session& session, const std::string& case_id) {
  std::size_t place = 0;
  while (session.cases[place]->id != case_id) ++place;
  return place;
}

void tell(const ExportProgress& progress, std::size_t done, std::size_t of) {
  if (progress) progress(static_cast<int>(done), static_cast<int>(of));
}

void requireHonestName(const std::filesystem::path& file, const HandedPoses& handed) {
  if (file.filename().string().find(kNotValidatedName) != std::string::npos) return;
  for (const HandedPose& pose : handed.poses)
    if (!pose.validated)
      throw InputError(file, "case '" + pose.case_id + "' is " + pose.review_status +
                                 "; the format cannot state this, so the file name must: put " +
                                 kNotValidatedName +
                                 " into the name, or export only the validated cases");
}

ExportReport reportOf(const HandedPoses& case_poses) {
  ExportReport report;
  for (const HandedPose& pose : case_poses.poses) report.case_ids.push_back(pose.case_id);
  report.notes = case_poses.notes;
  return report;
}

void requireOneStation(const Session& session, const HandedPoses& case_poses) {
  const std::vector<int> stations = stationNumbers(session);
  const int first = stations[placeOf(session, case_poses.poses[0].case_id)];
  for (const HandedPose& pose : case_poses.poses)
    if (stations[placeOf(session, pose.case_id)] != first)
      throw InputError("session", "cases",
                       "'" + case_poses.poses[0].case_id + "' and '" + pose.case_id +
                           "' have different stations, but a COLMAP model has one world; choose "
                           "cases of one station");
}

/// Who validated this very pose, or that it is not validated.
std::string remarkOf(const Session& session, const HandedPose& pose) {
  const ReviewStatus status = reviewStatusOf(session, pose.case_id);
  const bool judged = status.holds() && status.decision->pose &&
                      status.decision->pose->camera_from_station == pose.camera_from_station;
  if (status.state == ReviewState::kValidated && !judged)
    return "NOT VALIDATED: the validation is of another pose of the case";
  return reviewStatusText(status);
}

Camera prepared(const SessionCase& session_case) {
  Camera camera = session_case.camera;
  if (prepareCamera(camera) != Status::kOk)
    throw InputError("case " + session_case.id, "camera",
                     "its parameters are not those of a camera");
  return camera;
}

/// A camera for formats without vectors, and a remark on it.
struct ExchangeCamera {
  Camera camera;
  std::string remark;  ///< empty: it is the case's own
};

/// A camera that COLMAP does not know is fitted at the distance of the seed; the remark has the
/// error.
ExchangeCamera exchangeCamera(const SessionCase& session_case) {
  const Camera own = prepared(session_case);
  if (hasColmapModel(own.model)) return {own, ""};
  try {
    const FittedCamera fitted = fitCamera(
        own, CameraModel::kBrownConrady,
        session_case.has_seed ? session_case.camera_from_station_seed.translation_m.norm() : 1.0);
    return {fitted.camera, std::string("its ") + cameraModelName(own.model) +
                               " camera is written as brown_conrady, " + fitText(fitted)};
  } catch (const std::runtime_error& error) {
    throw InputError(
        "session", "cases",
        "the camera of case '" + session_case.id + "' cannot be written: " + error.what());
  }
}

/// The image as a camera without distortion would have taken it, where BOP has images.
void writeBopImage(const fs::path& folder, const SessionCase& session_case, int number) {
  const GrayImage image = readImage(session_case.image.source.file, session_case.image.eight_bit);
  const ImageView view = image.view();
  const Camera camera = prepared(session_case);
  if (view.width != camera.width || view.height != camera.height)
    throw InputError(session_case.image.source.file,
                     "has another size than the camera of case " + session_case.id);
  const UndistortedImage undistorted_image = undistort(camera, view);
  writePng(folder / (bopNumber(number) + ".png"), undistorted_image.pixels, camera.width,
           camera.height, 1);
}

/// An export rounds the numbers of a pose.
constexpr double kSamePose = 1e-6;  ///< rad, m

/// Digest of the run of the case that has this pose; "": none, as far as traces can be read.
std::string runWithPose(const Session& session, const std::string& case_id, const Pose& pose) {
  for (const RunRecord& run : session.runs) {
    if (run.case_id != case_id) continue;
    try {
      const Pose of_run = loadRun(run).camera_from_station;
      if (perturbationBetween(of_run, pose).cwiseAbs().maxCoeff() <= kSamePose) return run.digest;
    } catch (const InputError&) {
      continue;  // a trace that is lost has no pose to compare with
    }
  }
  return "";
}

/// Gives a case a truth, unless it has another one that is to stay. The exported pose of a run is
/// named as such.
void setTruth(ImportReport& report, const std::string& case_id, const Pose& truth,
              const fs::path& folder, bool replace) {
  SessionCase changed = *report.session.findCase(case_id);
  const auto& known = changed.camera_from_station_truth;
  if (std::count(report.case_ids.begin(), report.case_ids.end(), case_id) > 0)
    throw InputError("session", "cases", "two of the poses are of case '" + case_id + "'");
  if (known && !(*known == truth) && !replace)
    throw InputError("session", "cases",
                     "case '" + case_id +
                         "' already has another truth; request its replacement (whs: --replace)");
  TruthSource source{TruthOrigin::kImported,
                     fs::absolute(folder).lexically_normal().filename().string(), "",
                     runWithPose(report.session, case_id, truth)};
  if (!source.run.empty()) {
    source.origin = TruthOrigin::kRun;
    report.notes.push_back("the truth of case '" + case_id +
                           "' is the pose of its run: it does not judge runs");
  }
  if (!known || !(*known == truth)) boresight::sessions::setTruth(changed, truth, source);
  report.session = withCase(report.session, std::move(changed));
  report.case_ids.push_back(case_id);
}

/// Whether two cameras are the same but for the last bits of their numbers.
bool sameCamera(const Camera& a, const Camera& b, bool distortion) {
  const auto near = [](double x, double y) {
    return std::abs(x - y) <= 1e-9 * std::max({1.0, std::abs(x), std::abs(y)});
  };
  const bool same_lens = a.model == b.model && std::equal(a.distortion.begin(), a.distortion.end(),
                                                          b.distortion.begin(), near);
  return near(a.fx, b.fx) && near(a.fy, b.fy) && near(a.cx, b.cx) && near(a.cy, b.cy) &&
         (!distortion || (same_lens && a.width == b.width && a.height == b.height));
}

std::string otherCamera(const std::string& image, const std::string& case_id) {
  return image + " was left out: its camera is not that of case '" + case_id + "'";
}

void requireSome(const ImportReport& report, const fs::path& folder) {
  if (!report.case_ids.empty()) return;
  throw InputError(folder, report.notes.empty() ? "has no pose" : report.notes.front());
}

/// The case whose image has this name, or nullptr.
const SessionCase* caseOfImage(const Session& session, const fs::path& file,
                               const std::string& name) {
  const std::vector<std::string> names = imageNames(session);
  std::vector<const SessionCase*> exact;
  std::vector<const SessionCase*> ending;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) exact.push_back(&*session.cases[i]);
    if (isEndOf(name, session.cases[i]->image.source.file)) ending.push_back(&*session.cases[i]);
  }
  const auto& found = exact.empty() ? ending : exact;
  if (found.size() > 1)
    throw InputError(file, "'" + name + "' may be the image of case '" + found[0]->id +
                               "' and of case '" + found[1]->id + "'");
  return found.empty() ? nullptr : found[0];
}

/// The enabled point pairs with both positions.
std::vector<SeenPoint> annotatedPoints(const Session& session, const std::string& case_id) {
  std::vector<SeenPoint> points;
  const auto found = session.annotations.find(case_id);
  if (found == session.annotations.end()) return points;
  for (const PointPair& pair : found->second->points)
    if (pair.used()) points.push_back({*pair.point_in_station_m, *pair.pixel});
  return points;
}

}  // namespace

HandedPoses annotatedPoses(const Session& session, const std::vector<std::string>& case_ids) {
  for (const std::string& id : case_ids) (void)knownCase(session, id);
  HandedPoses case_poses;
  for (const auto& session_case : session.cases) {
    const bool asked =
        std::find(case_ids.begin(), case_ids.end(), session_case->id) != case_ids.end();
    if (!case_ids.empty() && !asked) continue;
    const CaseAnnotations annotations = caseAnnotations(session, session_case->id);
    const bool annotated =
        std::any_of(annotations.views.begin(), annotations.views.end(),
                    [](const AnnotatedView& view) { return !view.annotations.empty(); });
    if (!annotated && !asked) continue;
    const CaseAnnotationsSolution solved =
        solveCaseAnnotations(annotations, session_case->camera_from_station_seed, {});
    if (const auto solved_pose = solved.camera_from_station()) {
      HandedPose& pose = case_poses.poses.emplace_back();
      pose.case_id = session_case->id;
      pose.source = PoseSource::kAnnotation;
      pose.camera_from_station = *solved_pose;
    } else {
      case_poses.notes.push_back("case '" + session_case->id +
                                 "' has no pose: " + solved.result.reason);
    }
  }
  if (case_poses.poses.empty())
    throw InputError("session", "annotations",
                     case_poses.notes.empty()
                         ? "no case has annotations to solve for a pose"
                         : "no case has a pose to export: " + case_poses.notes.front());
  return case_poses;
}

HandedPoses posesToHandOver(const Session& session, const std::vector<std::string>& case_ids,
                            const ExportProgress& progress) {
  HandedPoses handed = handedPoses(session, case_ids, progress);
  if (handed.poses.empty())
    throw InputError("session", "cases",
                     handed.notes.empty() ? "there is none" : handed.notes.front());
  return handed;
}

ExportReport exportBopResults(const Session& session, const std::filesystem::path& file,
                              const std::vector<std::string>& case_ids, int scene_id,
                              const ExportProgress& progress) {
  const HandedPoses handed = posesToHandOver(session, case_ids, progress);
  requireHonestName(file, handed);
  const std::vector<int> numbers = imageNumbers(session);
  const std::vector<int> stations = stationNumbers(session);
  std::vector<BopResult> results;
  for (const HandedPose& pose : handed.poses) {
    const std::size_t place = placeOf(session, pose.case_id);
    results.push_back({scene_id, numbers[place], stations[place], pose.score,
                       pose.camera_from_station, pose.seconds});
  }
  writeBopResults(file, results);
  return reportOf(handed);
}

ExportReport exportColmap(const Session& session, const fs::path& folder, const HandedPoses& poses,
                          const ExportProgress& progress) {
  requireOneStation(session, poses);
  const std::vector<std::string> names = imageNames(session);
  std::vector<PosedImage> images;
  std::vector<std::string> notes;
  for (const HandedPose& pose : poses.poses) {
    tell(progress, images.size(), poses.poses.size());
    const std::size_t place = placeOf(session, pose.case_id);
    const ExchangeCamera camera = exchangeCamera(*session.cases[place]);
    const std::string remark = remarkOf(session, pose);
    images.push_back(
        {static_cast<int>(place) + 1, names[place], camera.camera, pose.camera_from_station,
         remark + (remark.empty() || camera.remark.empty() ? "" : "; ") + camera.remark,
         annotatedPoints(session, pose.case_id)});
    if (!camera.remark.empty()) notes.push_back("case " + pose.case_id + ": " + camera.remark);
  }
  writeFolderAtomically(folder, [&](const fs::path& to) { writeColmapText(to, images); });
  ExportReport report = reportOf(poses);
  report.notes.insert(report.notes.end(), notes.begin(), notes.end());
  return report;
}

ExportReport exportBop(const Session& session, const fs::path& folder, const HandedPoses& poses,
                       const ExportProgress& progress) {
  const std::vector<int> numbers = imageNumbers(session);
  const std::vector<int> stations = stationNumbers(session);
  writeFolderAtomically(folder, [&](const fs::path& to) {
    std::error_code error;
    if (!fs::create_directory(to / "gray", error)) throw OutputError(to / "gray", error.message());
    std::vector<BopObject> objects;
    for (const HandedPose& pose : poses.poses) {
      tell(progress, objects.size(), poses.poses.size());
      const std::size_t place = placeOf(session, pose.case_id);
      const SessionCase& session_case = *session.cases[place];
      objects.push_back({{numbers[place], "", pinholeOf(prepared(session_case)),
                          pose.camera_from_station, remarkOf(session, pose)},
                         stations[place]});
      writeBopImage(to / "gray", session_case, numbers[place]);
    }
    writeBopScene(to, objects);
  });
  return reportOf(poses);
}

void exportAnnotations(const Session& session, const std::string& case_id, const fs::path& file) {
  writeAnnotations(file, requireAnnotations(session, case_id));
}

std::vector<std::string> exportLandmarks(const Session& session, const std::string& case_id,
                                         const fs::path& file) {
  const Annotations& annotations = requireAnnotations(session, case_id);
  std::error_code error;
  std::vector<Landmark> landmarks;
  if (fs::exists(file, error)) landmarks = readLandmarks(file);
  landmarks = withAnnotations(std::move(landmarks), annotations);
  if (landmarks.empty())
    throw InputError("session", "annotations",
                     "case '" + case_id + "' has no point with station coordinates");
  writeLandmarks(file, landmarks);
  const std::string left_out = leftOutOfLandmarks(annotations);
  return left_out.empty() ? std::vector<std::string>() : std::vector<std::string>{left_out};
}

ImportReport importAnnotations(const Session& session, const std::string& case_id,
                               const fs::path& file, bool replace) {
  const SessionCase& session_case = knownCase(session, case_id);
  const Annotations annotations = readAnnotations(file);
  for (const PointPair& point : annotations.points)
    if (point.pixel && !isInImage(session_case.camera, *point.pixel))
      throw InputError(file, point.id,
                       "lies outside of the image of case '" + case_id + "', which has " +
                           std::to_string(session_case.camera.width) + " x " +
                           std::to_string(session_case.camera.height) +
                           " pixels; do the annotations belong to this case?");
  const auto known = session.annotations.find(case_id);
  if (annotations.empty()) throw InputError(file, "has no annotations");
  if (known != session.annotations.end() && !(*known->second == annotations) && !replace)
    throw InputError(
        "session", "annotations",
        "case '" + case_id +
            "' already has other annotations; request their replacement (whs: --replace)");
  return {withAnnotations(session, case_id, annotations), {case_id}, {}};
}

ImportReport importColmap(const Session& session, const fs::path& folder, bool replace) {
  ImportReport report{session, {}, {}};
  for (const PosedImage& image : readColmapText(folder)) {
    const SessionCase* session_case = caseOfImage(session, folder / "images.txt", image.name);
    if (session_case == nullptr)
      report.notes.push_back("image '" + image.name + "' is no case's");
    else if (!sameCamera(image.camera, exchangeCamera(*session_case).camera, true))
      report.notes.push_back(otherCamera("image '" + image.name + "'", session_case->id));
    else
      setTruth(report, session_case->id, image.camera_from_station, folder, replace);
  }
  requireSome(report, folder);
  return report;
}

ImportReport importBop(const Session& session, const fs::path& folder, bool replace) {
  ImportReport report{session, {}, {}};
  const std::vector<int> numbers = imageNumbers(session);
  const std::vector<int> stations = stationNumbers(session);
  const std::vector<BopObject> objects = readBopScene(folder);
  for (const BopObject& object : objects) {
    const std::string image = "image " + std::to_string(object.image.id);
    const auto found = std::find(numbers.begin(), numbers.end(), object.image.id);
    if (found == numbers.end()) {
      report.notes.push_back(image + " is no case's");
      continue;
    }
    const auto place = static_cast<std::size_t>(found - numbers.begin());
    const SessionCase& session_case = *session.cases[place];
    const auto in_image = std::count_if(
        objects.begin(), objects.end(),
        [&object](const BopObject& other) { return other.image.id == object.image.id; });
    if (in_image > 1 && object.object_id != stations[place])
      report.notes.push_back(image + ": object " + std::to_string(object.object_id) +
                             " is not the station of case '" + session_case.id + "'");
    else if (!sameCamera(object.image.camera, session_case.camera, false))
      report.notes.push_back(otherCamera(image, session_case.id));
    else
      setTruth(report, session_case.id, object.image.camera_from_station, folder, replace);
  }
  requireSome(report, folder);
  return report;
}

}  // namespace boresight::sessions
