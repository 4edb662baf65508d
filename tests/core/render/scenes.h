// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/base/random.h"
#include "core/geometry/camera.h"
#include "core/geometry/mesh.h"
#include "core/geometry/pose.h"
#include "core/render/edge_render.h"

namespace boresight::testing {

/// A mesh that owns its memory.
struct SceneMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Face> faces;
  std::vector<std::uint16_t> part_of_face;
  std::vector<ScenePart> parts{ScenePart()};

  MeshView view() const { return {vertices, faces, part_of_face, parts}; }
  std::int32_t addVertex(const Eigen::Vector3d& p);
  void addFace(std::int32_t a, std::int32_t b, std::int32_t c, int part = 0);
  /// A quadrilateral as two triangles, with vertices of its own.
  void addQuad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
               const Eigen::Vector3d& d, int part = 0);
  /// A closed box, outward faces, vertices shared.
  void addBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& half, const Pose& placed,
              int part = 0);
  /// An open tube about the y axis through `centre`, with `facets` sides and, with caps, closed.
  void addCylinder(const Eigen::Vector3d& centre, double radius, double half_height, int facets,
                   bool caps, int part = 0);
  /// A closed ball of rings about the y axis, outward faces. The radius of each vertex deviates at
  /// random, by a share of `bumps`.
  void addBall(const Eigen::Vector3d& centre, double radius, int rings, int around,
               double bumps = 0.0, std::uint64_t seed = 1, int part = 0);
  /// Two triangles in each cell of a grid of vertices that begins at `first`, row by row; cut along
  /// alternating diagonals.
  void addGridFaces(int first, int columns, int rows);
  Corners corners(const Face& face) const;
  /// The same faces, each with vertices of its own.
  SceneMesh loose() const;
};

/// Boxes, some of them not matched, and a cylinder; many `facets` make the mesh large.
SceneMesh scattered(std::uint64_t seed, int facets = 64);

Camera pinholeCamera(int width, int height, double focal_px);
/// Brown-Conrady with 5 coefficients; k1 = -0.28 is a strong barrel.
Camera brownCamera(int width, int height, double focal_px, double k1);
Camera fisheyeCamera(int width, int height, double focal_px,
                     const std::array<double, 8>& distortion = {0.02, -0.01, 0.003, -0.0005});
/// CAHVOR: image axes not square to each other, y up the image, the optical axis not along z.
Camera skewMirroredCamera(int width, int height, double focal_px);
/// CAHVORE: fisheye with an entrance pupil that moves; `entrance_m` is e0.
Camera pupilCamera(int width, int height, double focal_px, double entrance_m);

Pose poseOf(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& translation_m);
/// Sees all of scattered().
inline const Pose kAhead = poseOf({0.1, 0.2, 0.3}, {0.01, 0.0, 0.5});

/// A renderer of a mesh, which must outlive it, with all its memory and output.
struct Rendered {
  static constexpr std::size_t kBytes = std::size_t{96} << 20;
  /// Not initialized: memory that is not used takes no time.
  std::unique_ptr<std::byte[]> memory = std::make_unique_for_overwrite<std::byte[]>(kBytes);
  Arena arena{{memory.get(), kBytes}};
  MeshAdjacency adjacency;
  RayGrid rays;
  EdgeRenderer renderer;
  EdgeRender edges;
  std::vector<float> depth_m;
  std::vector<std::int32_t> face;
  std::vector<std::uint8_t> intensity;
  std::vector<Eigen::Vector3f> normal;
  int steps = 0;

  Rendered(const SceneMesh& mesh, const Camera& camera, const RenderOptions& options = {},
           int band_rows = EdgeRenderer::kBandRows, int workers = 1);
  /// Begins a render of edges and surfaces.
  Status begin(const Pose& camera_from_station) {
    return renderer.begin(rays, camera_from_station, edges, {depth_m, face, intensity, normal});
  }
  /// Steps to the end of the render: the status of the last step.
  Status finish();

  float depthAt(int x, int y) const { return depth_m[at(x, y)]; }
  std::int32_t faceAt(int x, int y) const { return face[at(x, y)]; }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(edges.camera.width) +
           static_cast<std::size_t>(x);
  }
};

/// Renders everything; a failing status fails the test. `plainly`: see EdgeRenderer::drawPlainly.
Rendered render(const SceneMesh& mesh, const Camera& camera, const Pose& camera_from_station,
                const RenderOptions& options = {}, int band_rows = EdgeRenderer::kBandRows,
                bool plainly = false);

/// The edge pixels that a render has.
inline std::vector<EdgePixel> pixelsOf(const EdgeRender& edges) {
  std::vector<EdgePixel> pixels;
  for (const EdgePixel& pixel : edges.eachPixel()) pixels.push_back(pixel);
  return pixels;
}

inline int edgesInRow(const EdgeRender& edges, int y) {
  const auto row = static_cast<std::size_t>(y);
  return edges.row_begin[row + 1] - edges.row_begin[row];
}

/// Expects two renders to agree in every bit of edges, mask and edge pixels; `complete`: neither
/// ended with a fault, after which the rest of row_begin is not set.
void expectEqual(const EdgeRender& a, const EdgeRender& b, bool complete = true);

}  // namespace boresight::testing
