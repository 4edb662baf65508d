// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/scene_render.h"

#include <algorithm>
#include <memory>

#include "sessions/trace/record.h"

namespace boresight::sessions {
namespace {

RenderOptions optionsFor(const Camera& camera) {
  RenderOptions options;
  options.max_edge_pixels = std::clamp(camera.width * camera.height / 4, 200000, 4000000);
  return options;
}

/// What one render needs besides the mesh.
struct Equipment {
  MeshAdjacency adjacency;
  RayGrid rays;
  EdgeRenderer renderer;
  EdgeRender render;

  Status create(const Camera& camera, const MeshView& mesh, Arena& arena) {
    const RenderOptions options = optionsFor(camera);
    Status status = buildAdjacency(mesh, arena, adjacency);
    if (status == Status::kOk) status = RayGrid::create(camera, arena, rays);
    if (status == Status::kOk)
      status = renderer.create(mesh, adjacency, camera.width, camera.height, options, arena);
    if (status == Status::kOk)
      render = createEdgeRender(camera.width, camera.height, options, arena);
    return status == Status::kOk && arena.exhausted() ? Status::kArenaTooSmall : status;
  }
};

}  // namespace

Status renderScene(const Camera& camera, const MeshView& mesh, const Pose& camera_from_station,
                   RenderTrace& output) {
  Status status = validateMesh(mesh);
  if (status != Status::kOk) return status;
  Arena counter;
  Equipment counted;
  status = counted.create(camera, mesh, counter);
  if (status != Status::kOk) return status;
  const auto memory = std::make_unique_for_overwrite<std::byte[]>(counter.highWater());
  Arena arena({memory.get(), counter.highWater()});
  Equipment equipment;
  status = equipment.create(camera, mesh, arena);
  if (status == Status::kOk)
    status = equipment.renderer.begin(equipment.rays, camera_from_station, equipment.render);
  bool done = false;
  while (status == Status::kOk && !done) status = equipment.renderer.step(done);
  if (status == Status::kOk) output = recordRender(equipment.render);
  return status;
}

}  // namespace boresight::sessions
