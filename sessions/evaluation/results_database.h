// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sessions/evaluation/run_result.h"

namespace boresight::sessions {

/// What a batch was: name and value, e.g. {"dataset_sha256", "..."}.
using BatchFacts = std::vector<std::pair<std::string, std::string>>;

/// Writes a batch as an SQLite file, whole or not at all, replacing an older one. OutputError.
///
///     fact (name TEXT PRIMARY KEY, value TEXT)      what the batch was: version, dataset, options
///     run  one row per run, in the order of the dataset:
///       id INTEGER PRIMARY KEY, case_id TEXT, reseed INTEGER (0: the dataset's own seed),
///       station TEXT, method TEXT, status TEXT, message TEXT,
///       completed, success, false_positive, gross_false_positive INTEGER (0 or 1; success is NULL
///         without truth or requirement), iterations, matches, inliers INTEGER, edge_support REAL,
///       normal_mm, lateral_mm, rotation_mrad, in_plane_mrad, geodesic_mrad, projection_px REAL
///         (NULL without truth), the same with the prefix seed_ for the seed,
///       s_initialization, s_rendering, s_matching, s_pose, s_refinement, s_total REAL (seconds),
///       camera_from_station, camera_from_station_seed TEXT (JSON, 4x4 row-major), digest TEXT
///     tag  (run_id INTEGER REFERENCES run(id), tag TEXT)
void writeResultsDatabase(const std::filesystem::path& file, std::span<const RunResult> results,
                          const BatchFacts& facts);

}  // namespace boresight::sessions
