// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "core/render/edge_render.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// Renders one scene with one camera from many poses; data that does not depend on the pose is
/// computed once. It owns its memory, and its capacity for edge pixels follows the image. Like the
/// core's stages it does one slice per step, so that a caller with a newer pose can stop in
/// between.
class SceneRenderer {
 public:
  /// The mesh must outlive the renderer. Returns the core's status, such as kInvalidMesh. Throws
  /// std::bad_alloc.
  Status create(const Camera& camera, const MeshView& mesh);
  /// Starts a render, whether or not the one before was done; the surfaces must outlive its steps.
  Status begin(const Pose& camera_from_station, const SurfaceRender& surfaces = {});
  Status step(bool& done);
  /// A copy of the render, after `done`.
  RenderTrace record() const;
  /// All steps of a render at once.
  Status render(const Pose& camera_from_station, RenderTrace& output,
                const SurfaceRender& surfaces = {});

 private:
  /// Inputs of a render apart from the mesh.
  struct Equipment {
    std::unique_ptr<std::byte[]> memory;
    MeshAdjacency adjacency;
    RayGrid rays;
    EdgeRenderer renderer;
    EdgeRender render;

    Status create(const Camera& camera, const MeshView& mesh, Arena& arena);
  };

  std::unique_ptr<Equipment> equipment_;
};

/// Salient edges of a scene from one pose, rendered whole.
Status renderScene(const Camera& camera, const MeshView& mesh, const Pose& camera_from_station,
                   RenderTrace& output, const SurfaceRender& surfaces = {});

}  // namespace boresight::sessions
