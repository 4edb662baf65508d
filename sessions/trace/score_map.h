// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "core/match/whs.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// WHS at every offset of a template's search window, for display; the flight loop keeps
/// the peaks alone.
struct ScoreMap {
  SearchWindow window;  ///< at the iteration's level
  int level = 0;
  WhsNorms norms;
  std::vector<WhsCounts> counts;  ///< row by row, window.width() * window.height()
  double lowest = 0.0;            ///< of S over the window
  double highest = 0.0;

  /// (x, y) is a place of the template's centre, inside the window.
  const WhsCounts& countsAt(int x, int y) const;
  double scoreAt(int x, int y) const { return whsScore(countsAt(x, y), norms); }
};

/// The map of one template of an iteration that was recorded in full, by the core's own function.
/// Empty when the template was not searched, its level's edges are missing, or it was stopped
/// (checked between two rows of the window).
std::optional<ScoreMap> scoreMap(const EdgeMapTrace& edges, const IterationTrace& iteration,
                                 int template_index, const std::stop_token& stop = {});

}  // namespace boresight::sessions
