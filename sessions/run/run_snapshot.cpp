// SPDX-License-Identifier: Apache-2.0
#include "sessions/run/run_snapshot.h"

#include <utility>

namespace boresight::sessions {
namespace {

/// What both have in common, field by field.
template <class From, class To>
void copyHead(const From& from, To& to) {
  to.version = from.version;
  to.options = from.options;
  to.changes = from.changes;
  to.camera = from.camera;
  to.camera_from_station_seed = from.camera_from_station_seed;
  to.uncertainty = from.uncertainty;
  to.attempts = from.attempts;
  to.rivals = from.rivals;
  to.support = from.support;
  to.partial = from.partial;
  to.status = from.status;
  to.fault = from.fault;
  to.camera_from_station = from.camera_from_station;
  to.covariance = from.covariance;
  to.digest = from.digest;
  to.seconds = from.seconds;
  to.arena_bytes = from.arena_bytes;
  to.memory = from.memory;
}

}  // namespace

RunSnapshot snapshotOf(LocalizationTrace&& trace) {
  RunSnapshot snapshot;
  copyHead(trace, snapshot);
  snapshot.edges = std::make_shared<const EdgeMapTrace>(std::move(trace.edges));
  snapshot.iterations.reserve(trace.iterations.size());
  for (IterationTrace& iteration : trace.iterations)
    snapshot.iterations.push_back(std::make_shared<const IterationTrace>(std::move(iteration)));
  snapshot.finished = trace.status != LocalizationStatus::kRunning;
  snapshot.stage = snapshot.finished ? Stage::kFinished : Stage::kEdges;
  return snapshot;
}

LocalizationTrace traceOf(const RunSnapshot& snapshot) {
  LocalizationTrace trace;
  copyHead(snapshot, trace);
  if (snapshot.edges) trace.edges = *snapshot.edges;
  trace.iterations.reserve(snapshot.iterations.size());
  for (const auto& iteration : snapshot.iterations) trace.iterations.push_back(*iteration);
  return trace;
}

}  // namespace boresight::sessions
