// SPDX-License-Identifier: Apache-2.0
// Export and import of a session's annotations and poses, for the desktop program, `whs export` and
// `whs import`.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sessions/review/validated_pose_file.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// Poses solved from annotations as by `solveCaseAnnotations`, each together with its rig: of the
/// given cases, or of all cases with annotations (their own or their rig's). InputError for an id
/// that does not exist, and when there is no pose.
/// Sets only case_id, source and camera_from_station of each pose.
HandedPoses annotatedPoses(const Session& session, const std::vector<std::string>& case_ids);

/// Called with the number of cases written or read so far, and of all.
using ExportProgress = std::function<void(int done, int of)>;

/// The poses of cases to be handed over (handedPoses). InputError when there is none.
HandedPoses posesToHandOver(const Session& session, const std::vector<std::string>& case_ids,
                            const ExportProgress& progress = {});

/// Result of an export.
struct ExportReport {
  std::vector<std::string> case_ids;
  std::vector<std::string> notes;  ///< as in HandedPoses
};

/// Writes a new folder with a COLMAP text model (colmap_text.h) of the poses: whole or not at all.
/// Images are numbered by the order of their cases in the session, from 1, and named by their paths
/// below the folder that holds all of the session's images. A comment in images.txt names who
/// validated a pose, or states that it is not validated. InputError when the cases are of several
/// stations: a model has one world. OutputError.
ExportReport exportColmap(const Session& session, const std::filesystem::path& folder,
                          const HandedPoses& poses, const ExportProgress& progress = {});

/// Writes a new folder with a BOP scene (bop_scene.h) of the poses: scene_gt.json,
/// scene_camera.json, and in gray/ the undistorted 8-bit images. Images are numbered by their file
/// names (000012.png is 12) when all file names in the session are distinct numbers; otherwise by
/// the order of their cases, from 1. Objects are the session's stations in their order, from 1. A
/// `remark` in scene_gt.json names who validated a pose, or states that it is not validated.
/// InputError when an image cannot be read; OutputError.
ExportReport exportBop(const Session& session, const std::filesystem::path& folder,
                       const HandedPoses& poses, const ExportProgress& progress = {});

/// Writes the handed-over poses of cases as a BOP19 results file: images and objects are numbered
/// as `exportBop` does, in this scene; the score is 1 for a validated pose or one from annotations,
/// else the edge support of its run. The format has no room for a remark: when a pose is not
/// validated, the file's name must contain kNotValidatedName. InputError; OutputError.
ExportReport exportBopResults(const Session& session, const std::filesystem::path& file,
                              const std::vector<std::string>& case_ids, int scene_id,
                              const ExportProgress& progress = {});
inline constexpr const char* kNotValidatedName = "NOT-VALIDATED";

/// Writes a case's annotations as points.json, or points.csv, by the ending of the name. InputError
/// when the case does not exist or has none; OutputError.
void exportAnnotations(const Session& session, const std::string& case_id,
                       const std::filesystem::path& file);

/// Writes the points of a case as landmarks.json, added to those in the file; a landmark of the
/// same name is replaced. Returns a sentence for each kind left out. InputError also for an
/// existing file that is not a landmarks file; OutputError.
std::vector<std::string> exportLandmarks(const Session& session, const std::string& case_id,
                                         const std::filesystem::path& file);

/// A session with the imported data, not yet saved.
struct ImportReport {
  Session session;
  std::vector<std::string> case_ids;  ///< that were changed
  std::vector<std::string> notes;     ///< data left out, and why
};

/// Sets the annotations of a case from points.json or points.csv. InputError when the case has
/// others and they are not to be replaced.
ImportReport importAnnotations(const Session& session, const std::string& case_id,
                               const std::filesystem::path& file, bool replace);

/// Sets the truths of cases from a COLMAP text model, whose image names are those of `exportColmap`
/// or ends of image paths. InputError when no name fits, a name fits several cases, or a case has
/// another truth that is not to be replaced. A camera that differs from the case's is noted, and
/// the image left out: its pose holds for that camera only.
ImportReport importColmap(const Session& session, const std::filesystem::path& folder,
                          bool replace);

/// The same for a BOP scene, whose images are numbered as `exportBop` does. Of several objects in
/// an image, that of the case's station is used. Cameras are compared without their distortion.
ImportReport importBop(const Session& session, const std::filesystem::path& folder, bool replace);

}  // namespace boresight::sessions
