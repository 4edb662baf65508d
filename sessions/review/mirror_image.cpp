// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/mirror_image.h"

#include <utility>

namespace boresight::sessions {

void mirrorScene(SceneMesh& scene, int axis, double plane_m) {
  for (Eigen::Vector3f& vertex : scene.vertices_in_station_m)
    vertex(axis) = static_cast<float>(2.0 * plane_m) - vertex(axis);
  for (Face& face : scene.faces) std::swap(face.vertex[1], face.vertex[2]);
}

std::unique_ptr<const LoadedCase> mirrorImageOf(const LoadedCase& loaded, int axis) {
  auto made = std::make_unique<LoadedCase>();
  made->source = loaded.source;
  made->image = loaded.image;
  made->scene = loaded.scene;
  made->ignore = loaded.ignore;
  if (made->ignore) made->ignore_bits = made->ignore->view();
  mirrorScene(made->scene, axis, matchedBounds(loaded.scene.view()).centre()(axis));
  return made;
}

}  // namespace boresight::sessions
