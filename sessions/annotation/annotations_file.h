// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/annotation/annotations.h"
#include "sessions/io/json/json_reader.h"

namespace boresight::sessions {

/// points.json (`boresight-points`, version 1):
///
///     {"format": "boresight-points", "version": 1,
///      "points": [{"id": "p1", "point_in_station_m": [x, y, z], "pixel": [u, v], "sigma_px": 0.3,
///                  "enabled": true, "locked": false, "comment": "left screw"}],
///      "lines": [{"id": "l1", "edge_in_station_m": [[x, y, z], [x, y, z]],
///                 "line_px": [[u, v], [u, v]], "sigma_px": 0.3, "enabled": true, ...}]}
///
/// The centre of the top-left pixel is (0, 0). Only `id` is required; the defaults are sigma_px 1,
/// enabled true, locked false. In an incomplete pair the station's or the image's side is missing.
/// Unknown members are rejected. InputError.
Annotations readAnnotations(const std::filesystem::path& file);

/// Writes points.json, or a table where the name ends in .csv; reading it back gives the same
/// values. OutputError.
void writeAnnotations(const std::filesystem::path& file, const Annotations& annotations);

/// Annotations as a table for spreadsheets, RFC 4180, a header and one row per annotation:
///
///     kind,id,x1_px,y1_px,x2_px,y2_px,x1_m,y1_m,z1_m,x2_m,y2_m,z2_m,sigma_px,enabled,locked,comment
///
/// A point uses the first position of each side, a line both; a missing side is empty. Metres in
/// the station's frame, the centre of the top-left pixel is (0, 0). Numbers are written so that
/// reading gives the same bits.
std::string annotationsCsv(const Annotations& annotations);

/// Parses such a table. InputError with line and column; `file` is the name used in messages.
Annotations parseAnnotationsCsv(const std::filesystem::path& file, std::string_view text);

/// Annotations inside another file: an object with `points` and `lines`, of which either may be
/// missing.
Annotations readAnnotations(const JsonReader& json);
nlohmann::ordered_json toJson(const Annotations& annotations);

/// rig.json (`boresight-rig`, version 1): cameras that are solved as one, or images of cameras of a
/// rig that did not move between them. Files are relative to rig.json.
///
///     {"format": "boresight-rig", "version": 1,
///      "views": [{"name": "left", "camera": "left.json", "points": "left_points.json",
///                 "camera_from_rig": [[4x4]]}, ...]}
///
/// InputError, also for no view and for a name given twice.
std::vector<AnnotatedView> readRig(const std::filesystem::path& file);

}  // namespace boresight::sessions
