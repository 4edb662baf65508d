// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/base/kernels.h"
#include "core/views/views_localizer.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/dataset_file.h"
#include "sessions/run/runner.h"

namespace boresight::sessions {

/// The cases of a dataset that share a rig's id, read and ready to be solved as one. Cameras of a
/// rig, or one camera at known places of its arm: `camera_from_rig` is all that is asked. Points
/// into the dataset.
struct RigViews {
  std::string id;
  std::vector<const Case*> cases;  ///< in the dataset's order; the first leads
  std::vector<Camera> cameras;
  std::vector<GrayImage> images;
  std::vector<std::optional<IgnoreMask>> masks;
  SceneMesh scene;
  std::optional<double> feature_size_m;
};

/// In the order of their first cases.
std::vector<std::string> rigIds(const Dataset& dataset);

/// InputError: there is no such rig, it has more than kMaxViews views, its cases are of several
/// stations, or the first one has no uncertainty.
RigViews readRigViews(const Dataset& dataset, const std::string& id);

struct RigRun {
  ViewsResult result;
  std::size_t views = 0;
  std::string digest;
  double seconds = 0.0;
};

/// From the first case's seed within its uncertainty; the seeds of the others are not used. A
/// problem that cannot run is a result with kFault. Throws std::bad_alloc.
RigRun localizeViews(const RigViews& rig, LocalizerOptions options,
                     const RunSettings& settings = {});

/// Of a view that has a truth.
std::optional<PoseError> viewError(const RigViews& rig, const RigRun& run, std::size_t view);

/// One rig of `whs views --out`: pose and covariance in the rig's frame, and what became of each
/// view, with its errors where it has a truth.
nlohmann::ordered_json toJson(const RigViews& rig, const RigRun& run);

}  // namespace boresight::sessions
