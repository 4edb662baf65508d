// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/scene_render.h"

#include <algorithm>
#include <cstddef>

#include "sessions/trace/iteration_trace.h"

namespace boresight::sessions {

Status SceneRenderer::Equipment::create(const Camera& camera, const MeshView& mesh, Arena& arena) {
  RenderOptions options;
  options.max_edge_pixels = std::clamp(camera.width * camera.height / 4, 200000, 4000000);
  Status status = buildAdjacency(mesh, arena, adjacency);
  if (status == Status::kOk) status = RayGrid::create(camera, arena, rays);
  if (status == Status::kOk)
    status = renderer.create(mesh, adjacency, camera.width, camera.height, options, arena);
  if (status != Status::kOk) return status;
  render = createEdgeRender(camera.width, camera.height, options, arena);
  return arena.exhausted() ? Status::kArenaTooSmall : status;
}

Status SceneRenderer::create(const Camera& camera, const MeshView& mesh) {
  equipment_.reset();
  Status status = validateMesh(mesh);
  if (status != Status::kOk) return status;
  Arena counter;
  Equipment counted;
  status = counted.create(camera, mesh, counter);
  if (status != Status::kOk) return status;
  auto result = std::make_unique<Equipment>();
  result->memory = std::make_unique_for_overwrite<std::byte[]>(counter.highWater());
  Arena arena({result->memory.get(), counter.highWater()});
  status = result->create(camera, mesh, arena);
  if (status == Status::kOk) equipment_ = std::move(result);
  return status;
}

Status SceneRenderer::begin(const Pose& camera_from_station, const SurfaceRender& surfaces) {
  if (!equipment_) return Status::kInvalidMesh;
  return equipment_->renderer.begin(equipment_->rays, camera_from_station, equipment_->render,
                                    surfaces);
}

Status SceneRenderer::step(bool& done) {
  if (!equipment_) return Status::kInvalidMesh;
  return equipment_->renderer.step(done);
}

RenderTrace SceneRenderer::record() const {
  return equipment_ ? recordRender(equipment_->render) : RenderTrace();
}

Status SceneRenderer::render(const Pose& camera_from_station, RenderTrace& output,
                             const SurfaceRender& surfaces) {
  Status status = begin(camera_from_station, surfaces);
  bool done = false;
  while (status == Status::kOk && !done) status = step(done);
  if (status == Status::kOk) output = record();
  return status;
}

Status renderScene(const Camera& camera, const MeshView& mesh, const Pose& camera_from_station,
                   RenderTrace& output, const SurfaceRender& surfaces) {
  SceneRenderer renderer;
  const Status status = renderer.create(camera, mesh);
  return status == Status::kOk ? renderer.render(camera_from_station, output, surfaces) : status;
}

}  // namespace boresight::sessions
