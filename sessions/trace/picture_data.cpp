// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/picture_data.h"

#include <algorithm>

namespace boresight::sessions {
namespace {

bool anyWithinOne(const BitImage& bits, int x, int y) {
  for (int v = std::max(0, y - 1); v <= std::min(bits.height - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(bits.width - 1, x + 1); ++u)
      if (bits.get(u, v)) return true;
  }
  return false;
}

}  // namespace

AgreementMaps agreementOf(const RenderTrace& render, const BitMap& test_edges) {
  if (render.edges.width != test_edges.width || render.edges.height != test_edges.height ||
      render.mask.width != test_edges.width || render.mask.height != test_edges.height)
    return {};
  BitMap empty = test_edges;
  std::ranges::fill(empty.words, 0);
  AgreementMaps maps{empty, empty, empty};
  const BitImage rendered = render.edges.view();
  const BitImage mask = render.mask.view();
  const BitImage seen = test_edges.view();
  BitImage both = maps.both.view();
  BitImage only_rendered = maps.only_rendered.view();
  BitImage only_image = maps.only_image.view();
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < seen.width; ++x) {
      if (rendered.get(x, y)) {
        (anyWithinOne(seen, x, y) ? both : only_rendered).set(x, y);
      } else if (seen.get(x, y) && mask.get(x, y) && !anyWithinOne(rendered, x, y)) {
        only_image.set(x, y);
      }
    }
  }
  return maps;
}

std::vector<ResidualVector> residualVectors(const IterationTrace& iteration, const Camera& camera) {
  std::vector<ResidualVector> vectors;
  const Pose& camera_from_station = iteration.camera_from_station;
  for (std::size_t i = 0; i < iteration.correspondences.size(); ++i) {
    const Correspondence& pair = iteration.correspondences[i];
    ResidualVector vector;
    if (!project(camera, camera_from_station * pair.point_in_station_m, vector.projected)) continue;
    vector.template_index = i < iteration.template_of.size() ? iteration.template_of[i] : -1;
    vector.found = pair.pixel;
    vector.inlier = i < iteration.pnp.inlier.size() && iteration.pnp.inlier[i] != 0;
    vectors.push_back(vector);
  }
  for (const EdgeSample& sample : iteration.refinement.samples) {
    if (sample.gradient == 0.0) continue;
    ResidualVector vector;
    if (!project(camera, camera_from_station * sample.point_in_station_m, vector.projected))
      continue;
    vector.found = vector.projected + sample.residual_px * sample.normal();
    vector.inlier = sample.weight > 0.5;
    vectors.push_back(vector);
  }
  return vectors;
}

}  // namespace boresight::sessions
