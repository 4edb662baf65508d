// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tests/benchmarks/peers/peer.h"

namespace boresight::peers {

enum class RapidKind { kRapid, kOls, kGos };

/// OpenCV's trackers of silhouettes: RAPID itself, optimal local and global optimal searching. The
/// latter two tell object from background by hue and saturation, and answer nothing without colour.
std::unique_ptr<Peer> makeRapidPeer(RapidKind kind);

}  // namespace boresight::peers
