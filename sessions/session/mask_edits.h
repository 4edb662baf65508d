// SPDX-License-Identifier: Apache-2.0
// What a person does to the ignore masks of a session; each gives the session as it is afterwards.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sessions/session/session.h"

namespace boresight::sessions {

/// The case with these strokes in place of its own; unchanged when there is no such case.
Session withStrokes(const Session& session, const std::string& case_id, MaskStrokes strokes);
/// One more stroke, after the others.
Session withStroke(const Session& session, const std::string& case_id, MaskStroke stroke);

/// Strokes that leave no pixel ignored: none, or where the case has a mask image one that trusts
/// every pixel of it again.
MaskStrokes clearedStrokes(const SessionCase& one);

/// Other cases whose pixels mean the same: of an equal camera and image size.
std::vector<std::string> casesOfSameCamera(const Session& session, const std::string& case_id);
/// A stroke of one case added to all others of its camera that do not have it yet.
Session copyingStroke(const Session& session, const std::string& case_id, std::size_t stroke);
/// Strokes with a name of other cases of the same camera that this case does not have, each once.
MaskStrokes namedStrokesOfCamera(const Session& session, const std::string& case_id);

/// "brush, 12 px wide", "gripper (polygon of 5 corners)", "erase: pixels of at least 250".
std::string strokeText(const MaskStroke& stroke);

}  // namespace boresight::sessions
