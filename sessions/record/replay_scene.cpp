// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/replay_scene.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "core/edges/edge_map.h"
#include "core/pnp/correspondence.h"

namespace boresight::sessions {

bool ReplayScene::render(const Pose& camera_from_station, int level, RenderTrace& output) {
  if (level < 0 || level >= kPyramidLevels || !isUsable(camera_from_station)) return false;
  auto found = levels_.find(level);
  if (found == levels_.end()) {
    SceneRenderer made;
    const Camera camera = cameraAtLevel(ground_.camera, level);
    if (made.create(camera, ground_.mesh) != Status::kOk) return false;
    found = levels_.emplace(level, std::move(made)).first;
  }
  SceneRenderer& renderer = found->second;
  Status status = renderer.begin(camera_from_station, {});
  bool done = false;
  while (status == Status::kOk && !done) status = renderer.step(done);
  if (status != Status::kOk) return false;
  output = renderer.record();
  return true;
}

std::vector<Template> ReplayScene::choose(const RenderTrace& render, int level, int side_px,
                                          const TemplateOptions& options) const {
  const int width = render.edges.width;
  const int height = render.edges.height;
  if (side_px < 2 || side_px > std::min(width, height)) return {};
  Arena counter;
  TemplateSelector selector;
  if (selector.create(width, height, options, counter) != Status::kOk) return {};
  (void)createTemplateSet(options, counter);
  const std::size_t bytes = counter.highWater();
  const auto memory = std::make_unique_for_overwrite<std::byte[]>(bytes);
  Arena arena({memory.get(), bytes});
  if (selector.create(width, height, options, arena) != Status::kOk) return {};
  TemplateSet chosen = createTemplateSet(options, arena);
  (void)selector.select(render.view(), side_px, ground_.ignore, level, chosen);
  const auto count = static_cast<std::size_t>(chosen.count);
  return {chosen.templates.begin(), chosen.templates.begin() + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace boresight::sessions
