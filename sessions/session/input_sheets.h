// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <filesystem>
#include <map>
#include <vector>

#include "sessions/session/input_sheet.h"

namespace boresight::sessions {

/// Sheets of the cases of a session. An image or a station that many of them share is read once.
class InputSheets {
 public:
  /// As inputSheet(*loadCase(one)), and throws as that does.
  InputSheet of(const SessionCase& one);
  /// Images and stations that were read so far.
  int filesRead() const { return files_read_; }

 private:
  struct Image {
    ImageInput input;
    GrayImage image;  ///< without its pixels
    ImageSheet sheet;
    std::exception_ptr problem;
  };
  struct Station {
    std::vector<MeshInput> parts;
    SceneMesh scene;
    BoundingBox bounds;
    std::exception_ptr problem;
  };

  const Image& imageOf(const ImageInput& input);
  const Station& stationOf(const std::vector<MeshInput>& parts);

  std::map<std::filesystem::path, Image> images_;
  std::map<std::filesystem::path, Station> stations_;  ///< by the mesh of the first part
  int files_read_ = 0;
};

}  // namespace boresight::sessions
