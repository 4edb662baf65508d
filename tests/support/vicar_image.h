// SPDX-License-Identifier: Apache-2.0
// A VICAR file as a mission would send it, written byte by byte.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "core/geometry/cahv_model.h"
#include "sessions/io/cameras/camera_file.h"

namespace boresight::test {

inline std::string vicarNumber(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

inline std::string vicarVector(const Eigen::Vector3d& v) {
  return "(" + vicarNumber(v.x()) + "," + vicarNumber(v.y()) + "," + vicarNumber(v.z()) + ")";
}

/// The label's group of a camera model, its components by name.
inline std::string vicarCamera(const CahvModel& cahv, const sessions::FrameName& frame) {
  const bool radial = cahv.model != CameraModel::kCahv;
  std::string text = "PROPERTY='GEOMETRIC_CAMERA_MODEL'  MODEL_TYPE='";
  text += radial ? "CAHVOR'  MODEL_COMPONENT_ID=('C','A','H','V','O','R')"
                 : "CAHV'  MODEL_COMPONENT_ID=('C','A','H','V')";
  const Eigen::Vector3d vectors[] = {cahv.c_m, cahv.a, cahv.h_px, cahv.v_px, cahv.o, cahv.r};
  for (int i = 0; i < (radial ? 6 : 4); ++i)
    text += "  MODEL_COMPONENT_" + std::to_string(i + 1) + "=" + vicarVector(vectors[i]);
  text += "  REFERENCE_COORD_SYSTEM_NAME='" + frame.name + "'  REFERENCE_COORD_SYSTEM_INDEX=(";
  for (std::size_t i = 0; i < frame.index.size(); ++i)
    text += (i > 0 ? "," : "") + std::to_string(frame.index[i]);
  return text + ")  ";
}

/// 16-bit samples, the most significant byte first; `groups` follow the system's own items.
inline std::vector<std::uint8_t> vicarImage(int width, int height,
                                            const std::vector<std::uint16_t>& samples,
                                            const std::string& groups) {
  const std::string ns = std::to_string(width), nl = std::to_string(height);
  const std::string record = std::to_string(2 * width);
  const std::string rest =
      "  FORMAT='HALF'  TYPE='IMAGE'  BUFSIZ=" + record + "  DIM=3  EOL=0  RECSIZE=" + record +
      "  ORG='BSQ'  NL=" + nl + "  NS=" + ns + "  NB=1  N1=" + ns + "  N2=" + nl +
      "  N3=1  N4=0  NBB=0  NLB=0  HOST='JAVA'  INTFMT='HIGH'  REALFMT='RIEEE'  BHOST='JAVA'  "
      "BINTFMT='HIGH'  BREALFMT='RIEEE'  BLTYPE=''  COMPRESS='NONE'  EOCI1=0  EOCI2=0  " +
      groups;
  const std::size_t row = 2 * static_cast<std::size_t>(width);
  const std::size_t size = (rest.size() + 20 + row - 1) / row * row;
  std::string label = "LBLSIZE=" + std::to_string(size) + rest;
  label.resize(size, '\0');
  std::vector<std::uint8_t> bytes(label.begin(), label.end());
  for (const std::uint16_t sample : samples) {
    bytes.push_back(static_cast<std::uint8_t>(sample >> 8));
    bytes.push_back(static_cast<std::uint8_t>(sample & 255));
  }
  return bytes;
}

}  // namespace boresight::test
