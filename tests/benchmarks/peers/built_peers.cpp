// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/peer.h"
#ifdef BORESIGHT_HAS_RAPID
#include "tests/benchmarks/peers/rapid_peer.h"
#endif
#ifdef BORESIGHT_HAS_VISP
#include "tests/benchmarks/peers/visp_peer.h"
#endif

namespace boresight::peers {

std::vector<std::unique_ptr<Peer>> builtPeers() {
  std::vector<std::unique_ptr<Peer>> peers;
#ifdef BORESIGHT_HAS_VISP
  peers.push_back(makeVispPeer());
#endif
#ifdef BORESIGHT_HAS_RAPID
  peers.push_back(makeRapidPeer(RapidKind::kRapid));
  peers.push_back(makeRapidPeer(RapidKind::kOls));
  peers.push_back(makeRapidPeer(RapidKind::kGos));
#endif
  return peers;
}

}  // namespace boresight::peers
