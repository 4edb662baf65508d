// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/digest.h"
#include "core/localizer/localizer_options.h"
#include "core/localizer/problem.h"
#include "core/localizer/workspace.h"

namespace boresight {

/// The serialization behind the digest of a run: big-endian, in declaration order, no times,
/// addresses, thread or memory figures. Images, masks, mesh, edges, renders and samples enter with
/// their CRC-32: it shows errors and other data (all but one in 2^32), but data can be made to have
/// the CRC-32 of other data. Onboard records and sessions state the SHA-256 of the inputs as well.
void digestOptions(const LocalizerOptions& options, DigestWriter& writer);
void digestProblem(const LocalizationProblem& problem, DigestWriter& writer);
/// Digest of options and problem, the start of the digest of a run.
std::array<std::uint8_t, 32> inputDigest(const LocalizerOptions& options,
                                         const LocalizationProblem& problem);
void digestPose(const Pose& pose, DigestWriter& writer);
void digestEdgeMap(const EdgeMap& edges, DigestWriter& writer);
void digestRender(const EdgeRender& render, DigestWriter& writer);
void digestTemplates(const TemplateSet& templates, DigestWriter& writer);
void digestMatches(const MatchSet& matches, DigestWriter& writer);
void digestPnp(const PnpSolution& solution, DigestWriter& writer);
void digestSupport(const EdgeSupport& support, DigestWriter& writer);
void digestCandidates(std::span<const PoseCandidate> candidates, DigestWriter& writer);
void digestFocal(const FocalFit& focal, DigestWriter& writer);
void digestEdgeWidth(const EdgeWidth& width, DigestWriter& writer);
void digestEvidence(const PoseEvidence& evidence, DigestWriter& writer);
void digestHypotheses(std::span<const PoseHypothesis> hypotheses, DigestWriter& writer);
void digestCompetingPoses(std::span<const CompetingPose> poses, DigestWriter& writer);
void digestRefinement(const RefinementResult& refinement, DigestWriter& writer);

}  // namespace boresight
