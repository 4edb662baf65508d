// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sessions/annotation/marks.h"

namespace boresight::sessions {

/// Marks as a table for spreadsheets, RFC 4180, a header and one row a mark:
///
///     kind,id,x1_px,y1_px,x2_px,y2_px,x1_m,y1_m,z1_m,x2_m,y2_m,z2_m,sigma_px,enabled,locked,comment
///
/// A point has the first place of each side, a line both; the side of a half-made pair is empty.
/// Metres in the station's frame, the centre of the top-left pixel is (0, 0). Numbers are written
/// so that reading gives the same bits.
std::string marksCsv(const Marks& marks);

/// InputError (`file` names the text) with line and column for anything else.
Marks parseMarksCsv(const std::filesystem::path& file, std::string_view text);

}  // namespace boresight::sessions
