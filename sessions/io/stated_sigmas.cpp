// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/stated_sigmas.h"

#include <nlohmann/json.hpp>

namespace boresight::sessions {

double readMeshScaleSigma(const JsonReader& json) { return json.number(0.0, kMaxScaleSigma); }

CalibrationSigma readCalibrationSigma(const JsonReader& json) {
  return {json.at("focal_relative").number(0.0, kMaxFocalSigma),
          json.at("principal_point_px").number(0.0, kMaxPrincipalPointSigma_px)};
}

nlohmann::ordered_json toJson(const CalibrationSigma& sigma) {
  return {{"focal_relative", sigma.focal_relative},
          {"principal_point_px", sigma.principal_point_px}};
}

}  // namespace boresight::sessions
