// SPDX-License-Identifier: Apache-2.0
// The operator's document: one plain value. Operations on it (files, journal, lock, undo) are in
// the other headers of this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "core/geometry/pose.h"
#include "core/localizer/localizer_options.h"
#include "sessions/annotation/annotation_round.h"
#include "sessions/annotation/annotations.h"
#include "sessions/decision/decision.h"
#include "sessions/io/cameras/frame_transform.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/images/image_file.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/io/json/config_file.h"
#include "sessions/session/block_map.h"
#include "sessions/session/ignore_strokes.h"
#include "sessions/session/keyed_list.h"
#include "sessions/session/run_record.h"

namespace boresight::sessions {

/// A file that a session depends on, and the bytes that it must have.
struct InputFile {
  std::filesystem::path file;  ///< absolute
  std::string sha256;          ///< 64 lower-case hexadecimal digits

  bool operator==(const InputFile&) const = default;
};

struct ImageInput {
  InputFile source;
  int width = 0;  ///< px
  int height = 0;
  ImageReadOptions eight_bit;  ///< how its samples become 8 bit
  std::string pixels_sha256;   ///< of the 8-bit pixels that the core sees
  /// Of its 8-bit colours, which a search uses; empty: it has none, or version 1.0 read it.
  std::string color_sha256 = {};
  /// Identifiers from the label of a planetary image, for provenance; else empty.
  std::vector<LabelItem> label = {};

  bool operator==(const ImageInput&) const = default;
};

/// One part of the station. For glTF the hash includes the buffers next to the file.
struct MeshInput {
  PartSource source;  ///< its path is absolute
  std::string sha256;

  bool operator==(const MeshInput&) const = default;
};

/// Where the truth of a case comes from. A pose of a run is no evidence about runs.
enum class TruthOrigin { kGiven, kAnnotated, kImported, kRun };
struct TruthSource {
  TruthOrigin origin = TruthOrigin::kGiven;
  std::string file;    ///< name of its file or folder, or empty
  std::string sha256;  ///< of the file; empty: not a file
  std::string run;     ///< digest, of kRun

  bool operator==(const TruthSource&) const = default;
};

/// All inputs of a run of one image, and the data by which its result is judged.
struct SessionCase {
  std::string id;       ///< unique in the session, not empty
  std::string station;  ///< display name, may be empty
  ImageInput image;
  Camera camera;
  /// Of the CAHV family: pose of the camera model's frame. No input of a run.
  std::optional<CameraReference> camera_reference;
  /// At least one is matched; each has a place in the scene by the case's frames.
  std::vector<MeshInput> parts;
  /// Of the station: poses that differ by one of them count as the same. No input of a run.
  Symmetries symmetries;
  std::optional<double> feature_size_m;
  /// Relative, one sigma; empty: kAssumedMeshScaleSigma. No input of a run.
  std::optional<double> mesh_scale_sigma;
  /// What is empty: the defaults of CalibrationSigma. No input of a run.
  std::optional<StatedCalibration> calibration_sigma;
  /// Of the camera's vectors, in its own frame: used instead of calibration_sigma. No input of a
  /// run.
  std::optional<CameraCovariance> camera_covariance;
  /// False: the case can be annotated, but not run, and its seed is the identity.
  bool has_seed = true;
  Pose camera_from_station_seed;
  /// Of a seed that was given in a named frame. No input of a run.
  std::optional<FrameName> station_frame;
  DeclaredUncertainty uncertainty;
  std::optional<Pose> camera_from_station_truth;
  /// Of a truth that was given in a named frame. No input of a run.
  std::optional<FrameName> truth_frame;
  /// Of a truth that was measured (by annotations): left perturbation, camera frame, of the
  /// annotations alone. Empty: exact. No input of a run.
  std::optional<Matrix6d> truth_covariance;
  std::optional<TruthSource> truth_source;          ///< empty: not known, of version 1.0
  std::optional<Pose> camera_from_station_working;  ///< nudged by hand; no input of any pose
  std::optional<InputFile> ignore;                  ///< mask image
  MaskStrokes ignore_strokes;                       ///< edits of the mask, applied in their order
  std::optional<InputFile> onboard_record;
  std::optional<Rig> rig;
  std::vector<std::string> tags;
  std::optional<Requirement> requirement;
  std::optional<Pose> camera_from_end_effector;
  /// Between named frames, without loops (frame_tree.h); `file` is absolute, of a session by
  /// version 1.0 a name alone. An input of a run only where they place a part.
  std::vector<FrameTransform> frames;
  /// landmarks.json with the station's named points, absolute; may not exist yet. No input of a
  /// run, and annotators add to it: the session does not store its hash.
  std::optional<std::filesystem::path> landmarks;

  bool operator==(const SessionCase&) const = default;
};

/// The tree of the case's frames, with that of its camera model.
FrameTree framesOf(const SessionCase& session_case);
/// The case's parts, as readScene takes them.
std::vector<PartSource> partsOf(const SessionCase& session_case);

/// Whether two cases have the same scene: parts, their states, and the frames that place them.
bool sameScene(const SessionCase& a, const SessionCase& b);
/// Whether two cases have the same meshes in the same places, in any states.
bool sameMeshes(const SessionCase& a, const SessionCase& b);

/// Sets the camera of a case with its reference frame and its uncertainty.
void setCamera(SessionCase& session_case, const CameraFile& camera);

/// Sets the seed of a case, which is in no named frame, and drops a nudged pose.
void setSeed(SessionCase& session_case, const Pose& camera_from_station);

/// Sets the truth of a case and drops all data about a former truth.
void setTruth(SessionCase& session_case, const Pose& camera_from_station, const TruthSource& source,
              const std::optional<Matrix6d>& covariance = std::nullopt);
/// "given, truth.json", "annotated", "imported, scene", "the pose of run 0123456789abcdef"; "" when
/// the case has no truth, or its source is not known.
std::string truthSourceText(const SessionCase& session_case);
/// The truth by which poses are judged; nullptr: there is none, or it is the pose of a run.
const Pose* judgingTruth(const SessionCase& session_case);

/// View state that belongs to the document; windows and layout do not.
struct DocumentView {
  std::string case_id;          ///< chosen case, or empty
  std::string digest;           ///< chosen run, or empty
  std::int32_t iteration = -1;  ///< chosen iteration of that run, -1: the last

  bool operator==(const DocumentView&) const = default;
};

/// Id of the case that an element of a session is or belongs to.
struct CaseIdOf {
  const std::string& operator()(const SharedValue<SessionCase>& shared_value) const {
    return shared_value->id;
  }
  const std::string& operator()(const Decision& decision) const { return decision.case_id; }
  const std::string& operator()(const RunRecord& run) const { return run.case_id; }
};

struct RigIdOf {
  const std::string* operator()(const SharedValue<SessionCase>& shared_value) const {
    return shared_value->rig ? &shared_value->rig->id : nullptr;
  }
};

/// Copies share their cases, annotations, decisions and runs (KeyedList, BlockMap).
struct Session {
  std::string profile = "default";
  OptionList options;  ///< differences from the profile, in alphabetical order
  KeyedList<SharedValue<SessionCase>, CaseIdOf, RigIdOf> cases;
  BlockMap<std::string, SharedValue<Annotations>> annotations;  ///< by case; no element is empty
  /// Completed annotation rounds by case, in order of completion; no element is empty.
  BlockMap<std::string, SharedValue<AnnotationRounds>> rounds;
  bool robust_annotations = false;  ///< outliers among annotations get less weight
  ReviewSettings review;
  KeyedList<Decision, CaseIdOf> decisions;  ///< in the order in which they were made
  KeyedList<RunRecord, CaseIdOf> runs;      ///< in the order in which they were made
  DocumentView view;

  /// nullptr when no case has this id.
  const SessionCase* findCase(const std::string& id) const;
  /// The last decision on a case, or nullptr.
  const Decision* decisionOn(const std::string& case_id) const;
  /// The latest run of a case, or nullptr.
  const RunRecord* lastRunOf(const std::string& case_id) const;

  bool operator==(const Session&) const = default;
};

/// The last run of a case with this digest, or with any if `digest` is empty; nullptr: none.
const RunRecord* findRun(const Session& session, const std::string& case_id,
                         const std::string& digest);
/// The case of this id. InputError when there is none.
const SessionCase& knownCase(const Session& session, const std::string& case_id);
/// The same session with a case changed; unchanged when there is no such case.
Session withChanged(const Session& session, const std::string& case_id,
                    const std::function<void(SessionCase&)>& change);
/// The same session with this case in place of the one of its id, or at the end.
Session withCase(const Session& session, SessionCase changed);
/// The id itself when no case has it, else with the first free number from 2 on: "bc-2".
std::string freeCaseId(const Session& session, const std::string& id);
/// The same session without a case and all its data.
Session withoutCase(const Session& session, const std::string& case_id);
/// The same session with these annotations of a case; empty ones are removed.
Session withAnnotations(const Session& session, const std::string& case_id,
                        Annotations annotations);
/// The same session with the completed annotation rounds of a case; an empty list is removed.
Session withRounds(const Session& session, const std::string& case_id, AnnotationRounds rounds);

/// The same session with a part of a case in this state. InputError for an unknown case or part, a
/// matched part that is fixed to the camera, and when no matched part is left.
Session withPartState(const Session& session, const std::string& case_id, std::size_t part_index,
                      const PartState& state);

/// The same session with these options, stored as differences from an existing profile.
Session withOptions(const Session& session, const std::string& profile,
                    const LocalizerOptions& options);

/// The options of the session's runs before a case's feature size. InputError (`file` names the
/// session) when the profile or an option does not exist or cannot have its value.
LocalizerOptions sessionOptions(const Session& session, const std::filesystem::path& file);
/// The options that a case is run with: a feature size of 0 is replaced by the case's.
LocalizerOptions caseOptions(const Session& session, const SessionCase& session_case,
                             const std::filesystem::path& file);

/// SHA-256 over all inputs of a run of the case: pixels, mask, camera, parts in use with their
/// places, seed, uncertainty; not names, truth, tags or requirement.
std::string inputsDigest(const SessionCase& session_case);

/// Differences of a run from a run with the current inputs and options.
struct Staleness {
  bool inputs_changed = false;
  bool options_changed = false;

  bool stale() const { return inputs_changed || options_changed; }
};
/// Whether a run has other inputs than its case has now, or is of a case that no longer exists; of
/// a run of several views the inputs of each count. Options do not: the pose stays the one that the
/// run found.
bool inputsChangedSince(const RunRecord& run, const Session& session);
/// Whether the run used another end effector than its case (of views the first's) has now.
bool endEffectorChangedSince(const RunRecord& run, const Session& session);
/// The last run of a case. InputError when there is none, or its inputs have changed since.
const RunRecord& currentRunOf(const Session& session, const std::string& case_id);
/// inputsChangedSince(), and whether the options at the end of the run are the case's.
Staleness stalenessOf(const RunRecord& run, const Session& session,
                      const std::filesystem::path& file);

/// Ids of the later session's cases that were edited since the earlier one (the case itself, its
/// annotations or rounds, decisions on it); new ones too, in their order. Runs and the view do not
/// count.
std::vector<std::string> changedCases(const Session& before, const Session& after);

/// Caches stalenessOf() for a session that is being edited: results for unchanged cases and options
/// are kept.
class StaleRuns {
 public:
  /// As `stalenessOf(run, session, file).stale()`; `shared_value` is the run's case in the session.
  /// InputError of options that cannot be read.
  bool isStale(const RunRecord& run, const SharedValue<SessionCase>& shared_value,
               const Session& session, const std::filesystem::path& file);

 private:
  struct Inputs {
    SharedValue<SessionCase> of_case;
    std::string digest;
  };
  void takeOptions(const Session& session);

  std::map<std::string, Inputs> inputs_;  ///< by case
  std::string profile_;
  OptionList options_;
  std::map<double, std::string> options_digests_;  ///< by the case's feature size, m
};

/// A case's own requirement, else that of the session's preset. InputError when there is no such
/// preset.
Requirement requirementOf(const Session& session, const SessionCase& session_case);

}  // namespace boresight::sessions
