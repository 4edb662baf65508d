// SPDX-License-Identifier: Apache-2.0
// The files that a case is made of: judged as they come, and one put in place of another.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "sessions/session/case_run.h"
#include "sessions/session/session_maker.h"

namespace boresight::sessions {

/// The four files that make a case.
enum class InputKind { kImage, kCamera, kMesh, kSeed };
inline constexpr int kInputKinds = 4;

/// An input that a run would refuse.
struct InputConcern {
  InputKind kind = InputKind::kImage;  ///< the one that is most likely wrong
  std::string text;                    ///< one sentence
};

/// Whether the mesh's format fixes its unit: metres, of glTF and GLB.
bool statesUnit(const std::filesystem::path& mesh);

/// Why `requireRunnable` refuses a case, or nothing. A case without a seed is not asked: it is to
/// be annotated.
std::optional<InputConcern> inputConcern(const LoadedCase& loaded);

/// One file of a case in the making.
struct JudgedFile {
  std::string text;     ///< what it is: "1024 x 1024 px, 8 bit"; empty: not given
  std::string problem;  ///< why it cannot be used, or does not fit the others; empty: it can
};
/// By `InputKind`.
using JudgedFiles = std::array<JudgedFile, kInputKinds>;

/// Reads the files that there are, each alone, and compares them with each other: sizes of image
/// and camera; the station at the seed, once the mesh's unit is known.
JudgedFiles judgeFiles(const CaseFiles& files);

/// The case with another file in place of one of its inputs, which is read. A mesh takes the place
/// of the first part and has this unit. A camera brings its calibration, a seed its uncertainty.
/// InputError.
SessionCase withInputFile(SessionCase session_case, InputKind kind,
                          const std::filesystem::path& file, const std::string& mesh_unit = "");

/// The case with its first mesh in another unit. InputError.
SessionCase withMeshUnit(SessionCase session_case, const std::string& mesh_unit);

}  // namespace boresight::sessions
