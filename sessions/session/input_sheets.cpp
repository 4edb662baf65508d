// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/input_sheets.h"

#include "sessions/session/input_check.h"

namespace boresight::sessions {
namespace {

/// Meshes are large: so many are kept.
constexpr std::size_t kMostStations = 8;

}  // namespace

const InputSheets::Image& InputSheets::imageOf(const ImageInput& input) {
  const auto [place, added] = images_.try_emplace(input.source.file);
  Image& known = place->second;
  if (added || !(known.input == input)) {
    ++files_read_;
    known = {input, {}, {}, nullptr};
    try {
      known.image = loadImage(input);
      known.sheet = imageSheet(known.image);
      known.image.pixels = {};
    } catch (...) {
      known.problem = std::current_exception();
    }
  }
  if (known.problem) std::rethrow_exception(known.problem);
  return known;
}

const InputSheets::Station& InputSheets::stationOf(const std::vector<MeshInput>& parts) {
  const std::filesystem::path key = parts.empty() ? "" : parts.front().source.mesh;
  if (stations_.size() >= kMostStations && !stations_.contains(key)) stations_.clear();
  const auto [place, added] = stations_.try_emplace(key);
  Station& known = place->second;
  if (added || !(known.parts == parts)) {
    ++files_read_;
    known = {parts, {}, {}, nullptr};
    try {
      known.scene = readKnownScene(parts);
      known.bounds = matchedBounds(known.scene.view());
    } catch (...) {
      known.problem = std::current_exception();
    }
  }
  if (known.problem) std::rethrow_exception(known.problem);
  return known;
}

InputSheet InputSheets::of(const SessionCase& one) {
  if (one.ignore || !one.ignore_strokes.empty()) return inputSheet(*loadCase(one));
  const Image& image = imageOf(one.image);
  const Station& station = stationOf(one.parts);
  return inputSheet({one, image.image, image.sheet, station.scene, station.bounds, std::nullopt});
}

}  // namespace boresight::sessions
