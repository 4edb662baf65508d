// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "sessions/session/input_check.h"
#include "sessions/session/rig_links.h"
#include "sessions/session/session_maker.h"
#include "tests/support/example_case.h"

namespace boresight::test {

/// Half a turn about the view.
inline Pose halfTurn() { return {Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0), Eigen::Vector3d::Zero()}; }

/// Gives a case another image, of the same size, written into a folder.
inline void giveImage(sessions::SessionCase& session_case, const std::vector<std::uint8_t>& pixels,
                      const std::filesystem::path& file) {
  sessions::writePng(file, pixels, session_case.image.width, session_case.image.height, 1);
  session_case.image.source = {file, sessions::inputSha256(file)};
  session_case.image.pixels_sha256 = sessions::readImage(file).pixels_sha256;
}

/// The same shot by a camera that stands on its head in the same place: the image turned round,
/// pixel by pixel, with a camera that has its centre and tangential distortion accordingly.
inline sessions::SessionCase turnedRound(const sessions::SessionCase& session_case,
                                         const std::filesystem::path& folder) {
  sessions::SessionCase turned = session_case;
  turned.id = session_case.id + "-turned";
  Camera& camera = turned.camera;
  camera.cx = camera.width - 1 - camera.cx;
  camera.cy = camera.height - 1 - camera.cy;
  camera.distortion[2] = -camera.distortion[2];
  camera.distortion[3] = -camera.distortion[3];
  turned.camera_from_station_seed = halfTurn() * session_case.camera_from_station_seed;
  if (session_case.camera_from_station_truth)
    turned.camera_from_station_truth = halfTurn() * *session_case.camera_from_station_truth;
  std::vector<std::uint8_t> pixels = sessions::readImage(session_case.image.source.file).pixels;
  std::reverse(pixels.begin(), pixels.end());
  giveImage(turned, pixels, folder / (turned.id + ".png"));
  return turned;
}

/// The station "os" of the example, and the same turned round, linked as a rig; no other cases.
inline sessions::Session sessionOfTwoViews(const std::filesystem::path& folder) {
  const sessions::Session all = sessions::makeSession(exampleFolder() / "dataset.json");
  sessions::Session two;
  for (const auto& session_case : all.cases)
    if (session_case->station == "os" && two.cases.empty()) two.cases.push_back(session_case);
  const std::string id = two.cases[0]->id;
  two = withCase(two, turnedRound(*two.cases[0], folder));
  return sessions::withRigLink(two, id, id + "-turned", halfTurn());
}

/// With the second view's image black.
inline sessions::Session withBlackSecond(sessions::Session session,
                                         const std::filesystem::path& folder) {
  sessions::SessionCase black = *session.cases[1];
  const auto count = static_cast<std::size_t>(black.image.width * black.image.height);
  giveImage(black, std::vector<std::uint8_t>(count, 0), folder / "black.png");
  return withCase(session, std::move(black));
}

}  // namespace boresight::test
