// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sessions/session/case_inputs.h"

namespace boresight::ui {

using sessions::InputKind;
using sessions::kAllInputs;

/// Kinds of files that were dropped or opened together.
struct DroppedFiles {
  std::optional<std::filesystem::path> session;
  std::optional<std::filesystem::path> dataset;
  std::optional<std::filesystem::path> results;  ///< of `whs evaluate`
  std::optional<std::filesystem::path> record;   ///< of an onboard run
  sessions::CaseFiles one;                       ///< the files of a case so far
  /// Of an image with a label: why the label has no camera, or "" when it has one.
  std::optional<std::string> label_camera_remark;
  std::vector<std::string> problems;  ///< one sentence each: files of an unknown kind, or two of
                                      ///< the same kind

  /// Whether the file is there; for the camera, the image's label counts, too.
  bool has(InputKind kind) const;
  /// The file, or ""; for the mesh, that of the first part.
  std::filesystem::path fileOf(InputKind kind) const;
  /// The files of a case that are still missing, for the operator: "a camera and a seed", or "".
  std::string missing() const;
  bool isCase() const;         ///< an image, a camera, a mesh and a seed
  bool isSeedless() const;     ///< an image, a camera and a mesh, which can be annotated
  int count() const;           ///< of the four files of a case
  bool isRecordAlone() const;  ///< an onboard record without files of a case
  /// Whether these files start a new case, independent of an earlier drop: a whole case, or another
  /// image together with further files.
  bool startsNewCase(const DroppedFiles& earlier) const;
  /// Names of the files of an earlier drop that these do not replace: "a.png, b.json", or "".
  std::string keptNames(const DroppedFiles& earlier) const;
};

/// Classifies files by their content (JSON by its `format`) and by their extension (".whsr" is a
/// record, ".sqlite" holds results). `earlier` supplies the files of an earlier drop. Two poses are
/// the seed and, if its name indicates it, the truth.
DroppedFiles classify(const std::vector<std::filesystem::path>& files,
                      const DroppedFiles& earlier = {});

}  // namespace boresight::ui
