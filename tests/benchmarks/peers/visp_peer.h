// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tests/benchmarks/peers/peer.h"

namespace boresight::peers {

/// vpMbGenericTracker with moving edges.
std::unique_ptr<Peer> makeVispPeer();

}  // namespace boresight::peers
