// SPDX-License-Identifier: Apache-2.0
#include "core/render/edge_render.h"

#include <algorithm>
#include <cmath>

#include "core/render/surface_render.h"

namespace boresight {
namespace {

/// Vertices or faces of one step: about a millisecond on the ground.
constexpr std::size_t kSlice = 16384;
/// Faces drawn in one step, wide ones counting several times: some milliseconds on the ground.
constexpr int kDrawnSlice = 16384;
/// The largest image: coordinates are recorded in 16 bits.
constexpr int kMaxSize_px = 32766;

/// Gives an image the size of this level, out of the words for the largest.
bool resize(BitImage& image, std::span<std::uint64_t>& words, int width, int height) {
  if (words.empty()) words = image.words;
  const int words_per_row = BitImage::wordsPerRow(width);
  const std::size_t count =
      static_cast<std::size_t>(words_per_row) * static_cast<std::size_t>(height);
  if (words.size() < count) return false;
  image = {words.first(count), width, height, words_per_row};
  return true;
}

}  // namespace

EdgeRender createEdgeRender(int width, int height, std::int32_t max_edge_pixels, Arena& arena) {
  EdgeRender render;
  render.edges = BitImage::create(arena, width, height);
  render.mask = BitImage::create(arena, width, height);
  render.edge_words = render.edges.words;
  render.mask_words = render.mask.words;
  render.pixels = arena.allocate<EdgePixel>(static_cast<std::size_t>(max_edge_pixels));
  render.row_begin = arena.allocate<std::int32_t>(static_cast<std::size_t>(height) + 1);
  return render;
}

std::int32_t findEdgePixel(const EdgeRender& render, int x, int y) {
  if (!render.edges.contains(x, y) || !render.edges.get(x, y)) return -1;
  std::int32_t low = render.row_begin[static_cast<std::size_t>(y)];
  std::int32_t high = render.row_begin[static_cast<std::size_t>(y) + 1];
  while (low < high) {
    const std::int32_t middle = low + (high - low) / 2;
    const int at = render.pixels[static_cast<std::size_t>(middle)].x;
    if (at == x) return middle;
    if (at < x)
      low = middle + 1;
    else
      high = middle;
  }
  return -1;
}

bool edgePointInStation(const EdgeRender& render, const EdgePixel& pixel,
                        Eigen::Vector3d& point_in_station_m) {
  Eigen::Vector3d ray;
  if (!unproject(render.camera, Eigen::Vector2d(pixel.x, pixel.y), ray)) return false;
  const Eigen::Vector3d point_in_camera_m = ray * static_cast<double>(pixel.depth_m);
  point_in_station_m = render.camera_from_station.inverse() * point_in_camera_m;
  return pixel.depth_m > 0.0F;
}

bool edgeLinePoint(const EdgeRender& render, const MeshView& mesh, const EdgePixel& pixel,
                   Eigen::Vector2d& position_px, Eigen::Vector3d& point_in_station_m) {
  const double norm = std::sqrt(
      static_cast<double>(pixel.normal_x * pixel.normal_x + pixel.normal_y * pixel.normal_y));
  if (!(norm > 0.0)) return false;
  const double distance_px = pixel.offset / (100.0 * norm);
  position_px = {pixel.x + distance_px * pixel.normal_x, pixel.y + distance_px * pixel.normal_y};
  Eigen::Vector3d ray;
  if (!unproject(render.camera, position_px, ray)) return false;

  const Face& face = mesh.faces[static_cast<std::size_t>(pixel.face)];
  Eigen::Vector3d corner[3];
  for (std::size_t i = 0; i < 3; ++i)
    corner[i] = render.camera_from_station *
                mesh.vertices_in_station_m[static_cast<std::size_t>(face.vertex[i])].cast<double>();
  const Eigen::Vector3d normal = crossProduct(corner[1] - corner[0], corner[2] - corner[0]);
  // On the face's plane, and no nearer or farther than the face itself where the plane is steep.
  const double farthest = std::max({corner[0].z(), corner[1].z(), corner[2].z()});
  const double nearest = std::min({corner[0].z(), corner[1].z(), corner[2].z()});
  double depth_m = dotProduct(normal, corner[0]) / dotProduct(normal, ray);
  if (!(depth_m >= nearest)) depth_m = nearest;
  if (depth_m > farthest) depth_m = farthest;
  if (!(depth_m > 0.0)) return false;
  point_in_station_m = render.camera_from_station.inverse() * Eigen::Vector3d(ray * depth_m);
  return true;
}

Status EdgeRenderer::create(const MeshView& mesh, const MeshAdjacency& adjacency, int max_width,
                            int max_height, const RenderOptions& options, Arena& kept,
                            Arena& scratch, int band_rows) {
  if (firstInvalidOption(options) != nullptr) return Status::kInvalidOption;
  if (max_width < 1 || max_height < 1 || max_width > kMaxSize_px || max_height > kMaxSize_px ||
      band_rows < 1)
    return Status::kInvalidImage;
  const Status status =
      CameraScene::create(mesh, adjacency, options.near_plane_m, kept, scratch, scene_);
  if (status != Status::kOk) return status;
  max_width_ = max_width;
  max_height_ = max_height;
  band_rows_ = std::min(band_rows, max_height);
  const int bands = (max_height - 1) / band_rows_ + 1;
  band_ = RasterBand::create(max_width, band_rows_, scratch);
  salient_edges_ = SalientEdges::create(max_width, scratch);
  bins_ = FaceBins::create(mesh.faces.size(), bands, scratch);
  phase_ = Phase::kIdle;
  if (kept.exhausted() || scratch.exhausted()) return Status::kArenaTooSmall;
  return Status::kOk;
}

Status EdgeRenderer::begin(const RayGrid& rays, const Pose& camera_from_station, EdgeRender& output,
                           const SurfaceRender& surfaces) {
  phase_ = Phase::kIdle;
  const Camera& camera = rays.camera();
  if (!camera_from_station.isFinite()) return Status::kInvalidPose;
  if (camera.width < 1 || camera.height < 1 || camera.width > max_width_ ||
      camera.height > max_height_ ||
      !resize(output.edges, output.edge_words, camera.width, camera.height) ||
      !resize(output.mask, output.mask_words, camera.width, camera.height) ||
      output.row_begin.size() < static_cast<std::size_t>(camera.height) + 1 ||
      !surfaceRenderFits(surfaces, camera.width, camera.height))
    return Status::kInvalidImage;
  output.camera = camera;
  output.camera_from_station = camera_from_station;
  salient_edges_.begin(output);
  scene_.begin(camera_from_station, rays);
  bins_.begin(scene_, rays, band_rows_, plain_);
  band_.rows = 0;
  band_.x_begin = 0;
  band_.x_end = 0;
  rays_ = &rays;
  output_ = &output;
  surfaces_ = surfaces;
  phase_ = Phase::kVertices;
  next_ = 0;
  band_open_ = false;
  next_drawn_ = -1;
  return Status::kOk;
}

Status EdgeRenderer::step(bool& done) {
  done = phase_ == Phase::kIdle;
  if (phase_ == Phase::kVertices) {
    const std::size_t count = scene_.vertex_in_camera_m.size();
    const std::size_t last = std::min(next_ + kSlice, count);
    scene_.transform(output_->camera_from_station, *rays_, next_, last);
    next_ = last;
    if (last == count) {
      phase_ = Phase::kFaces;
      next_ = 0;
    }
  } else if (phase_ == Phase::kFaces) {
    const std::size_t count = scene_.mesh.faces.size();
    const std::size_t last = std::min(next_ + kSlice, count);
    bins_.add(scene_, *rays_, next_, last);
    next_ = last;
    if (last == count) {
      phase_ = Phase::kBands;
      next_ = 0;
    }
  } else if (phase_ == Phase::kBands) {
    if (!band_open_) openBand();
    if (!drawSome()) return Status::kOk;
    const Status status = closeBand();
    ++next_;
    const bool last = static_cast<int>(next_) * band_rows_ >= output_->camera.height;
    if (status != Status::kOk || last) phase_ = Phase::kIdle;
    done = phase_ == Phase::kIdle;
    return status;
  }
  return Status::kOk;
}

/// Columns covered in bands band - before .. band + after, and `before + after` more on both sides,
/// within the image.
EdgeRenderer::Columns EdgeRenderer::columnsAround(int band, int before, int after) const {
  Columns columns;
  const int bands = (output_->camera.height - 1) / band_rows_ + 1;
  for (int i = std::max(band - before, 0); i <= std::min(band + after, bands - 1); ++i)
    columns.include(bins_.columns(i).first, bins_.columns(i).last);
  if (columns.last < columns.first) return columns;
  const int margin = before + after;
  columns.first = static_cast<std::int16_t>(std::max(columns.first - margin, 0));
  columns.last =
      static_cast<std::int16_t>(std::min(columns.last + margin, output_->camera.width - 1));
  return columns;
}

void EdgeRenderer::openBand() {
  const auto band = static_cast<int>(next_);
  const int y = band * band_rows_;
  // Pairs of pixels reach one pixel beyond the faces, and the derivatives of rays there another
  // one; rows at the borders of bands are also used with the neighbouring band.
  const Columns prepared = columnsAround(band, 1, 1);
  band_.advance(*rays_, y, std::min(band_rows_, output_->camera.height - y), prepared.first,
                prepared.last);
  band_open_ = true;
  list_ = 0;
  next_drawn_ = bins_.firstFace(band, list_);
}

/// Draws faces of the open band; true when all are drawn. Bands that hold very many faces take
/// several slices.
bool EdgeRenderer::drawSome() {
  int work = 0;
  while (work < kDrawnSlice) {
    if (next_drawn_ < 0) {
      if (++list_ == bins_.lists()) return true;
      next_drawn_ = bins_.firstFace(static_cast<int>(next_), list_);
      continue;
    }
    const std::int32_t face = next_drawn_;
    next_drawn_ = bins_.nextFace(face);
    ++work;
    if (list_ >= bins_.firstSmallList()) {
      bins_.smallFaces().draw(scene_, face, band_);
      continue;
    }
    const PixelBounds bounds = faceBounds(scene_, *rays_, face);
    drawFace(scene_, *rays_, face, bounds, band_);
    work += (bounds.x_last - bounds.x_first) / 16;
  }
  return false;
}

Status EdgeRenderer::closeBand() {
  band_open_ = false;
  if (surfaces_.wanted()) {
    resolveDepths(scene_, band_);
    copySurfaces(scene_, band_, output_->camera, surfaces_);
  }
  const Columns compared = columnsAround(static_cast<int>(next_), 1, 0);
  const bool final = band_.first_y + band_.rows >= output_->camera.height;
  return salient_edges_.addBand(scene_, band_, compared.first, compared.last, final, *output_);
}

}  // namespace boresight
