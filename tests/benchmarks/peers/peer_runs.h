// SPDX-License-Identifier: Apache-2.0
// Runs of peers as `whs evaluate` keeps its own.
#pragma once

#include <string>

#include "sessions/evaluation/batch.h"
#include "sessions/evaluation/batch_facts.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/dataset_file.h"
#include "tests/benchmarks/peers/peer.h"

namespace boresight::peers {

struct RunLimits {
  double seconds = 120.0;  ///< of wall time for one run
  double reseed_scale = 1.0;
};

/// The same run by `whs` (`peer` null: the profile "default", one thread) or by a peer, in a child
/// process. The image is read as `whs` reads it and rid of lens distortion for peers; seed, errors
/// and judgement are those of sessions/evaluation. A run that is lost ends with "killed", and
/// without success.
sessions::RunResult runOne(const sessions::Dataset& dataset, const sessions::PlannedRun& planned,
                           Peer* peer, const RunLimits& limits);

/// How a peer was run, for a results file.
sessions::MethodFacts peerFacts(Peer& peer, const RunLimits& limits);

}  // namespace boresight::peers
