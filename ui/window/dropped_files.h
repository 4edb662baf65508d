// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sessions/session/session_maker.h"

namespace boresight::ui {

/// What files that were dropped or opened together are.
struct DroppedFiles {
  std::optional<std::filesystem::path> session;
  std::optional<std::filesystem::path> dataset;
  std::optional<std::filesystem::path> results;  ///< of `whs evaluate`
  std::optional<std::filesystem::path> record;   ///< of an onboard run
  sessions::CaseFiles one;                       ///< as far as it goes
  /// Of an image with a label: why that has no camera, or "" where it has one.
  std::optional<std::string> label_camera_remark;
  std::vector<std::string> problems;  ///< one sentence each: files that are nothing known, twice
                                      ///< the same kind

  /// What of a case is still missing, for the operator: "a camera and a seed", or "".
  std::string missing() const;
  bool isCase() const;         ///< an image, a camera, a mesh and a seed
  bool isSeedless() const;     ///< an image, a camera and a mesh, which can be annotated
  int count() const;           ///< of the four that make a case
  bool hasCamera() const;      ///< a file of its own, or the label of the image
  bool isRecordAlone() const;  ///< an onboard record, and nothing of a case
  /// Whether these have nothing to do with files of an earlier drop: a whole case, or another image
  /// that comes with files of its own.
  bool beginsAnew(const DroppedFiles& earlier) const;
  /// Names of the files of an earlier drop that these leave in place: "a.png, b.json", or "".
  std::string keptNames(const DroppedFiles& earlier) const;
};

/// Tells files by their content (JSON by its `format`) and by their extension (".whsr" is a
/// record, ".sqlite" holds results). Files of an earlier drop are completed by `earlier`. Two poses
/// are the seed and, if its name says so, the truth.
DroppedFiles classify(const std::vector<std::filesystem::path>& files,
                      const DroppedFiles& earlier = {});

}  // namespace boresight::ui
