// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/peer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

namespace boresight::peers {

PinholeImage atLevel(const PinholeImage& image, int level) {
  if (level == 0) return image;
  const double scale = std::ldexp(1.0, -level);
  PinholeImage smaller;
  cv::resize(image.gray, smaller.gray, {}, scale, scale, cv::INTER_AREA);
  if (!image.colour.empty())
    cv::resize(image.colour, smaller.colour, {}, scale, scale, cv::INTER_AREA);
  smaller.fx = image.fx * scale;
  smaller.fy = image.fy * scale;
  smaller.cx = (image.cx + 0.5) * scale - 0.5;
  smaller.cy = (image.cy + 0.5) * scale - 0.5;
  return smaller;
}

int levelsOf(const PinholeImage& image, int levels, int least_side_px) {
  int fitting = 1;
  while (fitting < levels &&
         (std::min(image.gray.cols, image.gray.rows) >> fitting) >= least_side_px)
    ++fitting;
  return fitting;
}

double Settings::value(const std::string& name) const {
  for (const Setting& setting : settings_)
    if (setting.name == name) return setting.value;
  throw std::out_of_range("no setting " + name);
}

void Settings::take(const std::map<std::string, double>& values) {
  for (Setting& setting : settings_)
    if (const auto found = values.find(setting.name); found != values.end())
      setting.value = found->second;
}

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
