// SPDX-License-Identifier: Apache-2.0
// Marks and annotated poses of a session for other programs, and from them: the one code behind the
// desktop program and `whs export` and `whs import`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sessions/evaluation/posed_image.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

struct CasePose {
  std::string case_id;
  Pose camera_from_station;
};

struct CasePoses {
  std::vector<CasePose> poses;     ///< in the order of the session
  std::vector<std::string> notes;  ///< cases without a pose that one might expect, and why
};

/// The poses that cases' marks give, solved as `solveCaseMarks` does, each together with its rig.
/// Of these cases, or of all that have marks (or whose rig has). InputError for an id that does not
/// exist.
CasePoses annotatedPoses(const Session& session, const std::vector<std::string>& case_ids,
                         bool robust);

/// What came of an export, for people.
struct ExportReport {
  std::vector<std::string> case_ids;  ///< that were written
  std::vector<std::string> notes;     ///< as in CasePoses
};

/// Writes a new folder with a COLMAP text model (colmap_text.h) of the cases' poses: whole or not
/// at all. Images are numbered by their cases' places in the session, from 1, and named by their
/// paths below the folder that holds all of the session's images. InputError when there is no pose,
/// or the cases are of several stations: a model has one world. OutputError.
ExportReport exportColmap(const Session& session, const std::filesystem::path& folder,
                          const std::vector<std::string>& case_ids, bool robust);

/// Writes a new folder with a BOP scene (bop_scene.h) of the cases' poses: scene_gt.json,
/// scene_camera.json, and in gray/ the 8-bit images as cameras without distortion would have taken
/// them. Images are numbered as their files are (000012.png is 12) when all images of the session
/// are, each differently; else by their cases' places in the session, from 1. Objects are the
/// session's stations in their order, from 1. InputError when there is no pose or an image cannot
/// be read; OutputError.
ExportReport exportBop(const Session& session, const std::filesystem::path& folder,
                       const std::vector<std::string>& case_ids, bool robust);

/// The same two for poses that the caller chose. Every pose is written with who validated it, or
/// that nobody has: as a comment in images.txt, as a `remark` in scene_gt.json.
ExportReport writeColmapOf(const Session& session, const std::filesystem::path& folder,
                           const CasePoses& poses);
ExportReport writeBopOf(const Session& session, const std::filesystem::path& folder,
                        const CasePoses& poses);

/// Writes a case's marks as points.json, or points.csv where the name ends so. InputError when the
/// case does not exist or has none; OutputError.
void exportMarks(const Session& session, const std::string& case_id,
                 const std::filesystem::path& file);

/// Writes the points of a case as landmarks.json, added to those that the file has; one of the same
/// name is replaced. InputError also for a file that is there and is none; OutputError.
void exportLandmarks(const Session& session, const std::string& case_id,
                     const std::filesystem::path& file);

/// A session with what was imported, not yet saved.
struct ImportReport {
  Session session;
  std::vector<std::string> case_ids;  ///< that were changed
  std::vector<std::string> notes;     ///< what was left out, and why
};

/// The marks of a points.json or points.csv become the case's. InputError when the case has others
/// and they are not to be replaced.
ImportReport importMarks(const Session& session, const std::string& case_id,
                         const std::filesystem::path& file, bool replace);

/// The poses of a COLMAP text model become the truths of the cases whose images it names, by the
/// names of `exportColmap` or by the ends of the images' paths. InputError when it names none, a
/// name fits several cases, or a case has another truth that is not to be replaced. A camera that
/// differs from the case's is noted, and the image left out: its pose holds for that camera only.
ImportReport importColmap(const Session& session, const std::filesystem::path& folder,
                          bool replace);

/// The same of a BOP scene, whose images are numbered as `exportBop` does. Of several objects in an
/// image the one of the case's station counts. Cameras are compared without their distortion.
ImportReport importBop(const Session& session, const std::filesystem::path& folder, bool replace);

}  // namespace boresight::sessions
