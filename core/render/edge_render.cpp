// SPDX-License-Identifier: Apache-2.0
#include "core/render/edge_render.h"

#include <algorithm>
#include <cmath>

#include "core/base/nth.h"
#include "core/render/surface_render.h"

namespace boresight {
namespace {

/// Vertices or faces of one step: about a millisecond on the ground.
constexpr std::size_t kSlice = 16384;
/// Least work of a task: vertices or faces, bands.
constexpr std::size_t kLeastItems = 1024;
constexpr std::size_t kLeastBands = 2;
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
  render.pixels = arena.allocate<PackedEdgePixel>(max_edge_pixels);
  render.row_begin = arena.allocate<std::int32_t>(static_cast<std::size_t>(height) + 1);
  return render;
}

std::int32_t findEdgePixel(const EdgeRender& render, int x, int y) {
  if (!render.edges.contains(x, y) || !render.edges.get(x, y)) return -1;
  std::int32_t low = nth(render.row_begin, y);
  std::int32_t high = render.row_begin[static_cast<std::size_t>(y) + 1];
  while (low < high) {
    const std::int32_t middle = low + (high - low) / 2;
    const int at = nth(render.pixels, middle).x();
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
  Ray ray;
  if (!unprojectRay(render.camera, Eigen::Vector2d(pixel.x, pixel.y), ray)) return false;
  const Eigen::Vector3d point_in_camera_m = ray.at(static_cast<double>(pixel.depth_m));
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
  Ray ray;
  if (!unprojectRay(render.camera, position_px, ray)) return false;

  Corners corner = mesh.corners(static_cast<std::size_t>(pixel.face));
  for (Eigen::Vector3d& point : corner) point = render.camera_from_station * point - ray.origin_m;
  const Eigen::Vector3d normal = crossProduct(corner[1] - corner[0], corner[2] - corner[0]);
  // On the face's plane, and no nearer or farther than the face itself where the plane is steep.
  const double farthest = std::max({corner[0].z(), corner[1].z(), corner[2].z()});
  const double nearest = std::min({corner[0].z(), corner[1].z(), corner[2].z()});
  double depth_m = dotProduct(normal, corner[0]) / dotProduct(normal, ray.direction);
  if (!(depth_m >= nearest)) depth_m = nearest;
  if (depth_m > farthest) depth_m = farthest;
  if (!(depth_m > 0.0)) return false;
  point_in_station_m = render.camera_from_station.inverse() * Eigen::Vector3d(ray.at(depth_m));
  return true;
}

Status EdgeRenderer::create(const MeshView& mesh, const MeshAdjacency& adjacency, int max_width,
                            int max_height, const RenderOptions& options, Arena& kept,
                            Arena& scratch, int band_rows, int workers) {
  if (firstInvalidOption(options) != nullptr || workers < 1) return Status::kInvalidOption;
  if (mesh.faces.size() > PackedEdgePixel::kMostFaces) return Status::kInvalidMesh;
  if (max_width < 1 || max_height < 1 || max_width > kMaxSize_px || max_height > kMaxSize_px ||
      band_rows < 1)
    return Status::kInvalidImage;
  const Status status = CameraScene::create(mesh, adjacency, kept, scratch, scene_);
  if (status != Status::kOk) return status;
  max_width_ = max_width;
  max_height_ = max_height;
  band_rows_ = std::min(band_rows, max_height);
  const int bands = (max_height - 1) / band_rows_ + 1;
  painter_ = BandPainter::create(max_width, band_rows_, scratch);
  bins_ = FaceBins::create(mesh.faces.size(), bands, std::max(mostTasks(workers), 1), scratch);
  createWorkers(workers, max_width * max_height, options, kept, scratch);
  phase_ = Phase::kIdle;
  if (kept.exhausted() || scratch.exhausted()) return Status::kArenaTooSmall;
  return Status::kOk;
}

void EdgeRenderer::createWorkers(int workers, int max_pixels, const RenderOptions& options,
                                 Arena& kept, Arena& scratch) {
  workers_ = {};
  if (workers < 2) return;
  workers_ = kept.allocate<Worker>(workers);
  blocks_ = scratch.allocate<Block>(mostTasks(workers));
  for (int i = 0; i < workers; ++i) {
    Worker counted;
    Worker& worker = workers_.empty() ? counted : nth(workers_, i);
    // The first worker's memory equals that of a render by one worker.
    worker.painter = i == 0 ? painter_ : BandPainter::create(max_width_, band_rows_, scratch);
    worker.pixels = scratch.allocate<PackedEdgePixel>(
        static_cast<std::size_t>(std::min(options.max_edge_pixels, max_pixels)));
  }
}

Status EdgeRenderer::begin(const RayGrid& rays, const Pose& camera_from_station, EdgeRender& output,
                           const SurfaceRender& surfaces, const Pose& view_from_camera) {
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
  SalientEdges::clear(output);
  rays_ = &rays;
  output_ = &output;
  surfaces_ = surfaces;
  scene_.begin(camera_from_station, rays, view_from_camera);
  bins_.begin(scene_, rays, band_rows_, plain_, std::max(tasksOf(Phase::kFaces), 1));
  enter(Phase::kVertices);
  return Status::kOk;
}

/// Items of a phase.
std::size_t EdgeRenderer::itemsOf(Phase phase) const {
  if (phase == Phase::kVertices) return scene_.mesh.vertices_in_station_m.size();
  if (phase == Phase::kFaces) return scene_.mesh.faces.size();
  return static_cast<std::size_t>(covered_count_);
}

int EdgeRenderer::tasksOf(Phase phase) const {
  if (workers_.empty()) return 0;
  const bool bands = phase == Phase::kBands;
  if (bands && band_rows_ < 2) return 1;
  const std::size_t worthwhile = itemsOf(phase) / (bands ? kLeastBands : kLeastItems);
  return static_cast<int>(std::clamp<std::size_t>(worthwhile, 1, blocks_.size()));
}

void EdgeRenderer::enter(Phase phase) {
  phase_ = phase;
  next_ = 0;
  if (phase == Phase::kBands) {
    bins_.finish();
    findCoveredBands();
    painter_.begin(source(), 0, source().bands(), *output_);
  }
  task_count_ = tasksOf(phase);
  for (Worker& worker : workers_) worker.pixel_count = 0;
}

void EdgeRenderer::findCoveredBands() {
  int first = source().bands();
  int end = 0;
  for (int band = 0; band < source().bands(); ++band) {
    if (bins_.columns(band).last < bins_.columns(band).first) continue;
    first = std::min(first, band);
    end = band + 1;
  }
  covered_first_ = first;
  covered_count_ = std::max(end - first, 0);
}

Status EdgeRenderer::step(bool& done) {
  done = phase_ == Phase::kIdle;
  if (done) return Status::kOk;
  if (workers_.empty()) return stepAlone(done);
  if (phase_ == Phase::kVertices) {
    enter(Phase::kFaces);
  } else if (phase_ == Phase::kFaces) {
    enter(Phase::kBands);
  } else {
    phase_ = Phase::kIdle;
    done = true;
    return joinBlocks();
  }
  return Status::kOk;
}

Status EdgeRenderer::stepWhole(bool& done) {
  for (int task = 0; task < tasks(); ++task) runTask(task, 0);
  return step(done);
}

Status EdgeRenderer::stepAlone(bool& done) {
  if (phase_ == Phase::kBands) {
    const Status status = painter_.step(source(), *output_, done);
    if (done) phase_ = Phase::kIdle;
    return status;
  }
  const std::size_t count = itemsOf(phase_);
  const std::size_t last = std::min(next_ + kSlice, count);
  transformOrBin(next_, last, 0);
  next_ = last;
  if (last == count) enter(phase_ == Phase::kVertices ? Phase::kFaces : Phase::kBands);
  return Status::kOk;
}

void EdgeRenderer::runTask(int task, int worker) {
  if (task < 0 || task >= tasks() || worker < 0 ||
      static_cast<std::size_t>(worker) >= workers_.size())
    return;
  if (phase_ == Phase::kBands) return drawBlock(task, worker);
  const std::size_t count = itemsOf(phase_);
  const auto tasks = static_cast<std::size_t>(task_count_);
  const std::size_t first = count * static_cast<std::size_t>(task) / tasks;
  const std::size_t last = count * (static_cast<std::size_t>(task) + 1) / tasks;
  transformOrBin(first, last, task);
}

/// Transforms vertices, or bins faces into a share of the lists, as the phase needs.
void EdgeRenderer::transformOrBin(std::size_t first, std::size_t last, int share) {
  if (phase_ == Phase::kVertices)
    scene_.transform(*rays_, first, last);
  else
    bins_.add(scene_, *rays_, first, last, share);
}

/// Divides the bands with faces into equal blocks; the outermost blocks also take the bands above
/// and below.
int EdgeRenderer::beginOfBlock(int block) const {
  if (block <= 0) return 0;
  if (block >= task_count_) return source().bands();
  return covered_first_ + covered_count_ * block / task_count_;
}

/// Bits are written to rows of the output that belong to this block; edge pixels to the worker's
/// list, with row indices relative to the block's first pixel.
void EdgeRenderer::drawBlock(int index, int worker_index) {
  Worker& worker = nth(workers_, worker_index);
  Block& block = nth(blocks_, index);
  EdgeRender rows = *output_;
  rows.pixels = worker.pixels.subspan(static_cast<std::size_t>(worker.pixel_count));
  rows.pixel_count = 0;
  const BandSource source = this->source();
  worker.painter.begin(source, beginOfBlock(index), beginOfBlock(index + 1), rows);
  const Status status = worker.painter.drawAll(source, rows);
  block = {worker_index, worker.pixel_count, rows.pixel_count, status == Status::kOk};
  worker.pixel_count += rows.pixel_count;
}

/// Joins the blocks' edge pixels. When the capacity is exceeded, one worker renders the image
/// again, so that the partial output equals that of a render by one worker.
Status EdgeRenderer::joinBlocks() {
  EdgeRender& output = *output_;
  const int height = output.camera.height;
  bool fits = true;
  for (int index = 0; index < task_count_ && fits; ++index) {
    const Block& block = nth(blocks_, index);
    const auto begin = static_cast<std::size_t>(output.pixel_count);
    const auto count = static_cast<std::size_t>(block.count);
    fits = block.complete && count <= output.pixels.size() - begin;
    if (!fits) break;
    const Worker& worker = nth(workers_, block.worker);
    std::copy_n(worker.pixels.begin() + block.first, block.count,
                output.pixels.begin() + output.pixel_count);
    const int first_row = BandPainter::firstRow(beginOfBlock(index), band_rows_);
    const int end_row = index + 1 < task_count_
                            ? BandPainter::firstRow(beginOfBlock(index + 1), band_rows_)
                            : height;
    for (int y = first_row; y < end_row; ++y)
      output.row_begin[static_cast<std::size_t>(y) + 1] += output.pixel_count;
    output.pixel_count += block.count;
  }
  if (fits) return Status::kOk;
  SalientEdges::clear(output);
  painter_.begin(source(), 0, source().bands(), output);
  return painter_.drawAll(source(), output);
}

}  // namespace boresight
