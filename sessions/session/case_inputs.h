// SPDX-License-Identifier: Apache-2.0
// The input files of a case: validation, and replacement of one by another.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "sessions/session/case_run.h"
#include "sessions/session/session_maker.h"

namespace boresight::sessions {

/// The four input files of a case.
enum class InputKind { kImage, kCamera, kMesh, kSeed };
inline constexpr std::array kAllInputs = {InputKind::kImage, InputKind::kCamera, InputKind::kMesh,
                                          InputKind::kSeed};
inline constexpr int kInputKinds = static_cast<int>(kAllInputs.size());

/// An input that a run would reject.
struct InputConcern {
  InputKind kind = InputKind::kImage;  ///< the input most likely wrong
  std::string text;                    ///< one sentence
};

/// Whether the mesh's format fixes its unit: metres, of glTF and GLB.
bool statesUnit(const std::filesystem::path& mesh);

/// Why requireRunnable() rejects a case; empty when it accepts it, and for a case without a seed,
/// which is to be annotated.
std::optional<InputConcern> inputConcern(const LoadedCase& loaded);

/// Validation of one file of a new case.
struct JudgedFile {
  std::string text;     ///< description: "1024 x 1024 px, 8 bit"; empty: not given
  std::string problem;  ///< why it cannot be used, or does not fit the others; empty: usable
  std::shared_ptr<const GrayImage> image;  ///< of the image, as passed to the core
};
/// By `InputKind`.
using JudgedFiles = std::array<JudgedFile, kInputKinds>;

/// Reads the given files, each by itself, and compares them with each other: sizes of image and
/// camera; the station at the seed, once the mesh's unit is known.
JudgedFiles judgeFiles(const CaseFiles& files);

/// The case with one input replaced by another file, which is read. A mesh replaces the first part
/// and has this unit. A camera includes its calibration, a seed its uncertainty, an image the
/// frames of its label; poses that come from frames follow those of camera and image
/// (followFrames). InputError.
SessionCase withInputFile(SessionCase session_case, InputKind kind,
                          const std::filesystem::path& file, const std::string& mesh_unit = "");

/// The session with one input of a case taken from `changed`, which withInputFile() returned for
/// `before`; the rest of the case stays as it is in the session, but for poses that come from
/// frames (withChangedFrames). Empty when the session has no such case, or that input of the case,
/// or what the file was read by, differs from `before`. InputError of withChangedFrames.
std::optional<Session> withInput(const Session& session, InputKind kind, const SessionCase& before,
                                 const SessionCase& changed);

}  // namespace boresight::sessions
