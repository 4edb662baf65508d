// SPDX-License-Identifier: Apache-2.0
#include "core/render/salient_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "core/base/nth.h"
#include "core/render/rounding.h"

namespace boresight {
namespace {

/// Two surfaces meet, rather than one hiding the other, when their depths at the line differ by
/// less than this share.
constexpr double kContact = 2e-4;
/// Sine of the angle between ray and face below which an extended plane is uncertain.
constexpr double kGrazing = 0.15;

/// Pixels that are compared together; a run does not straddle the words of a bit image.
constexpr int kRun_px = 16;

/// Whether the faces of a whole run are equal, two at a time.
inline bool equalRuns(const std::int32_t* a, const std::int32_t* b) {
  std::uint64_t differing = 0;
  for (int i = 0; i < kRun_px; i += 2) {
    std::uint64_t two_a = 0;
    std::uint64_t two_b = 0;
    std::memcpy(&two_a, a + i, sizeof two_a);
    std::memcpy(&two_b, b + i, sizeof two_b);
    differing |= two_a ^ two_b;
  }
  return differing == 0;
}

/// Whether each pair of a run differs. Inlined, it becomes 16 single comparisons.
[[gnu::noinline]] void compareRun(const std::int32_t* __restrict a,
                                  const std::int32_t* __restrict b,
                                  std::uint8_t* __restrict differs) {
  for (int i = 0; i < kRun_px; ++i) differs[i] = a[i] != b[i] ? 1 : 0;
}

/// One bit for each of up to 16 pixels whose faces in `a` and `b` differ: most do not, which is
/// seen of all at once.
inline unsigned differingFaces(const std::int32_t* a, const std::int32_t* b, int count) {
  unsigned differing = 0;
  if (count < kRun_px) {
    for (int i = 0; i < count; ++i) differing |= static_cast<unsigned>(a[i] != b[i]) << i;
    return differing;
  }
  if (equalRuns(a, b)) return 0;
  std::uint8_t differs[kRun_px];
  compareRun(a, b, differs);
  for (int half = 0; half < 2; ++half) {
    const std::uint8_t* of = differs + 8 * half;
    std::uint64_t bytes = 0;
    for (int i = 0; i < 8; ++i) bytes |= static_cast<std::uint64_t>(of[i]) << (8 * i);
    // Byte i times 2^(56 - 7 i) is bit i of the highest byte.
    differing |= static_cast<unsigned>((bytes * 0x0102040810204080U) >> 56) << (8 * half);
  }
  return differing;
}

/// |z - z_extended| > threshold, from the inverse depths; a plane that is not met in front of the
/// camera is infinitely far off.
bool depthDiffers(double inverse_depth, double inverse_extended, double threshold_m) {
  if (!(inverse_extended > 0.0)) return true;
  return std::abs(inverse_extended - inverse_depth) >
         threshold_m * inverse_depth * inverse_extended;
}

[[gnu::always_inline]] inline Eigen::Vector3d between(const Eigen::Vector3d& from,
                                                      const Eigen::Vector3d& to, double s) {
  return from + (to - from) * s;
}

bool flatter(const FaceCache::Plane& a, const FaceCache::Plane& b) {
  return a.inverse_norm > b.inverse_norm || (a.inverse_norm == b.inverse_norm && a.face < b.face);
}

std::int8_t rounded8(double value) {
  return static_cast<std::int8_t>(floorClamped(value + 0.5, -127, 127));
}

/// Whether both pixels show faces of one smooth surface, as most pairs do.
bool isPlain(const CameraScene& scene, std::int32_t face, std::int32_t other) {
  return face >= 0 && other >= 0 && scene.continues(face, other);
}

/// Order among the candidates of several pairs for one pixel.
bool preferred(const EdgePixel& a, const EdgePixel& b) {
  if (a.depth_m != b.depth_m) return a.depth_m < b.depth_m;
  return std::abs(a.offset) < std::abs(b.offset);
}

}  // namespace

// Steps of a pair that are called at one place are inlined: a call is a tenth of their work.

SalientEdges SalientEdges::create(int max_width, Arena& arena) {
  SalientEdges edges;
  edges.faces_ = FaceCache::create(arena);
  edges.stride_ = max_width;
  edges.candidates_ = arena.allocate<EdgePixel>(2 * static_cast<std::size_t>(max_width));
  return edges;
}

void SalientEdges::begin(int first_y, int last_y) {
  faces_.clear();
  first_y_ = first_y;
  last_y_ = last_y;
}

void SalientEdges::clear(EdgeRender& output) {
  output.edges.clear();
  output.mask.clear();
  output.pixel_count = 0;
  output.row_begin[0] = 0;
}

[[gnu::always_inline]] inline bool SalientEdges::crossBorder(const Context& context,
                                                             const Sample& p, const Sample& q,
                                                             Crossing& crossing) {
  crossing.nearer_is_p = p.face >= 0;
  const Sample& nearer = crossing.nearer_is_p ? p : q;
  const Sample& farther = crossing.nearer_is_p ? q : p;
  if (!context.scene.part(nearer.face).match) return false;
  const SurfaceEnd end =
      traceSurface(context.scene, faces_, nearer.face, nearer.ray, farther.ray, -1);
  if (!end.ends) {
    // The near plane cuts the surface here: not an end of the surface.
    const FaceCache::Plane plane = faces_.plane(context.scene, nearer.face);
    if (dotProduct(plane.plane, farther.ray) * CameraScene::kNearPlane_m >= 1.0) return false;
  }
  const double s = std::min(end.s, 1.0);
  crossing.s = crossing.nearer_is_p ? s : 1.0 - s;
  crossing.face = end.face;
  crossing.has_line = end.ends;
  crossing.line = end.line;
  crossing.edge_of = end.face;
  crossing.edge = end.edge;
  crossing.kind = kEdgeOccluding | kEdgeBorder;
  return true;
}

/// Surfaces that differ: where one ends and the other begins.
[[gnu::always_inline]] inline bool SalientEdges::crossSurfaces(const Context& context,
                                                               const Sample& p, const Sample& q,
                                                               const Difference& difference,
                                                               Crossing& crossing) {
  const CameraScene& scene = context.scene;
  crossing.nearer_is_p = difference.nearer_is_p;
  const SurfaceEnd end_p = traceSurface(scene, faces_, p.face, p.ray, q.ray, q.face);
  SurfaceEnd end_q;
  if (!end_p.reached) end_q = traceSurface(scene, faces_, q.face, q.ray, p.ray, p.face);
  if (!end_p.reached && !end_q.reached) {
    crossing.kind = static_cast<std::uint8_t>((difference.crease ? kEdgeCrease : 0) |
                                              (difference.occluding ? kEdgeOccluding : 0));
    return crossOverlap(context, p, q, end_p, end_q, crossing) &&
           scene.part(crossing.nearer_is_p ? p.face : q.face).match;
  }

  // One connected surface: never a depth edge, a crease where it turns enough.
  if (!difference.crease || !scene.part(crossing.nearer_is_p ? p.face : q.face).match) return false;
  crossing.kind = kEdgeCrease;
  crossing.s = end_p.reached ? end_p.s : 1.0 - end_q.s;
  crossing.has_line = true;
  crossing.line = end_p.reached ? end_p.line : Eigen::Vector3d(-end_q.line);
  crossing.edge_of = end_p.reached ? end_p.face : end_q.face;
  crossing.edge = end_p.reached ? end_p.edge : end_q.edge;
  // Both faces contain the line; the plane of the flatter one is better known next to it.
  const FaceCache::Plane plane_p = faces_.plane(scene, p.face);
  crossing.nearer_is_p = flatter(plane_p, faces_.plane(scene, q.face));
  if (!crossing.nearer_is_p) crossing.line = -crossing.line;
  crossing.face = crossing.nearer_is_p ? p.face : q.face;
  return scene.part(crossing.face).match;
}

/// Surfaces that are not connected: both may cover a stretch between the pixels, and the one that
/// is nearer there is seen until it ends.
[[gnu::always_inline]] inline bool SalientEdges::crossOverlap(const Context& context,
                                                              const Sample& p, const Sample& q,
                                                              const SurfaceEnd& end_p,
                                                              const SurfaceEnd& end_q,
                                                              Crossing& crossing) {
  const CameraScene& scene = context.scene;
  const FaceCache::Plane plane_p = faces_.plane(scene, p.face);
  const FaceCache::Plane plane_q = faces_.plane(scene, q.face);
  const double s_p = end_p.s;                                        // p's surface covers 0 .. s_p
  const double s_q = 1.0 - end_q.s;                                  // q's surface covers s_q .. 1
  const Eigen::Vector3d difference = plane_p.plane - plane_q.plane;  // > 0 where p's is nearer
  bool intersect = false;
  if (s_p >= s_q) {
    const double low = std::max(s_q, 0.0);
    const double high = std::min(s_p, 1.0);
    const Eigen::Vector3d ray_low = between(p.ray, q.ray, low);
    const Eigen::Vector3d ray_high = between(p.ray, q.ray, high);
    const double ahead_low = dotProduct(plane_p.plane, ray_low) -
                             dotProduct(faces_.plane(scene, end_q.face).plane, ray_low);
    const double ahead_high = dotProduct(faces_.plane(scene, end_p.face).plane, ray_high) -
                              dotProduct(plane_q.plane, ray_high);
    if (ahead_low > 0.0 && ahead_high > 0.0) crossing.nearer_is_p = true;
    if (ahead_low < 0.0 && ahead_high < 0.0) crossing.nearer_is_p = false;
    intersect = ahead_low > 0.0 && ahead_high < 0.0;
    if (intersect) {
      crossing.line = difference;
      const double at_p = dotProduct(difference, p.ray);
      const double at_q = dotProduct(difference, q.ray);
      const double s = at_p / (at_p - at_q);
      crossing.s = s > low ? std::min(s, high) : low;
      crossing.has_line = true;
    }
  }
  const SurfaceEnd& end = crossing.nearer_is_p ? end_p : end_q;
  if (!intersect) {
    const Sample& farther = crossing.nearer_is_p ? q : p;
    const Eigen::Vector3d& plane = crossing.nearer_is_p ? plane_p.plane : plane_q.plane;
    // Cut by the near plane, which is no end of the surface.
    if (!end.ends && dotProduct(plane, farther.ray) * CameraScene::kNearPlane_m >= 1.0)
      return false;
    crossing.s = crossing.nearer_is_p ? std::min(s_p, 1.0) : std::max(s_q, 0.0);
    crossing.has_line = true;
    crossing.line = end.line;
    if (end.ends) {
      crossing.edge_of = end.face;
      crossing.edge = end.edge;
    }
    // It covers the other pixel and is hidden there: the two planes meet in that pixel.
    if (!end.ends) crossing.line = crossing.nearer_is_p ? difference : Eigen::Vector3d(-difference);
  }
  crossing.face = end.face;

  // Where the surfaces touch, neither hides the other: the plane of the flatter one is better
  // known.
  const Eigen::Vector3d ray = between(p.ray, q.ray, crossing.s);
  const double depth_p = dotProduct(plane_p.plane, ray);
  const double depth_q = dotProduct(plane_q.plane, ray);
  if (intersect || std::abs(depth_p - depth_q) <= kContact * std::abs(depth_p)) {
    const bool p_flatter = flatter(plane_p, plane_q);
    const bool line_from_p = intersect || crossing.nearer_is_p;
    const bool both_match = scene.part(p.face).match && scene.part(q.face).match;
    if (both_match) crossing.nearer_is_p = p_flatter;
    crossing.face = crossing.nearer_is_p ? p.face : q.face;
    if (line_from_p != crossing.nearer_is_p) crossing.line = -crossing.line;
  }
  return true;
}

[[gnu::always_inline]] inline bool SalientEdges::surfacesDiffer(const Context& context,
                                                                std::size_t p, std::size_t q,
                                                                Difference& difference) {
  const CameraScene& scene = context.scene;
  const RasterBand& band = context.band;
  const FaceCache::Plane plane_p = faces_.plane(scene, band.face[p]);
  const FaceCache::Plane& plane_q = faces_.plane(scene, band.face[q]);
  const auto inverseDepth = [&band](const Eigen::Vector3d& plane, std::size_t at) {
    return plane.x() * band.ray_x[at] + (plane.y() * band.ray_y[at] + plane.z());
  };
  const double inverse_p = inverseDepth(plane_p.plane, p);
  const double inverse_q = inverseDepth(plane_q.plane, q);
  difference.nearer_is_p =
      inverse_p > inverse_q || (inverse_p == inverse_q && plane_p.face < plane_q.face);
  const std::size_t part = scene.partIndex(difference.nearer_is_p ? plane_p.face : plane_q.face);
  const double threshold_m = scene.mesh.parts[part].depth_threshold_m;
  difference.crease = normalsDiffer(plane_p, plane_q, scene.cos_normal_threshold[part]);
  difference.occluding = depthDiffers(inverse_q, inverseDepth(plane_p.plane, q), threshold_m) &&
                         depthDiffers(inverse_p, inverseDepth(plane_q.plane, p), threshold_m);
  return difference.crease || difference.occluding;
}

void SalientEdges::comparePair(const Context& context, int x_p, int row_p, int x_q, int row_q) {
  const RasterBand& band = context.band;
  const std::size_t at_p = band.index(x_p, row_p);
  const std::size_t at_q = band.index(x_q, row_q);
  const std::int32_t face_p = band.face[at_p];
  const std::int32_t face_q = band.face[at_q];
  const bool border = face_p < 0 || face_q < 0;
  Difference difference;
  if (border ? face_p == RasterBand::kInvalid || face_q == RasterBand::kInvalid
             : !surfacesDiffer(context, at_p, at_q, difference))
    return;
  const Sample p{x_p, row_p, face_p, band.ray(x_p, row_p)};
  const Sample q{x_q, row_q, face_q, band.ray(x_q, row_q)};
  Crossing crossing;
  if (border ? crossBorder(context, p, q, crossing)
             : crossSurfaces(context, p, q, difference, crossing))
    mark(context, p, q, crossing);
}

/// z of the nearer surface for the marked pixel; 0 when there is none. `own` is the nearer
/// surface's pixel of the pair.
[[gnu::always_inline]] inline float SalientEdges::depthOf(const Context& context, const Sample& own,
                                                          const Sample& marked,
                                                          const Eigen::Vector3d& ray_at_line,
                                                          std::int32_t face) {
  const CameraScene& scene = context.scene;
  const FaceCache::Plane plane = faces_.plane(scene, face);
  double inverse_depth = dotProduct(plane.plane, marked.ray);
  const bool extended = own.x != marked.x || own.row != marked.row;
  const bool grazing =
      !(inverse_depth > 0.0) ||
      inverse_depth * plane.inverse_norm < kGrazing * std::sqrt(dotProduct(marked.ray, marked.ray));
  if (extended && grazing) inverse_depth = dotProduct(plane.plane, ray_at_line);
  if (!extended || grazing) {
    const auto& [v0, v1, v2] = faces_.corners(scene, face);
    const double farthest = std::max({v0.z(), v1.z(), v2.z()});
    const double nearest = std::max(std::min({v0.z(), v1.z(), v2.z()}), CameraScene::kNearPlane_m);
    inverse_depth = std::max(inverse_depth, 1.0 / farthest);
    inverse_depth = std::min(inverse_depth, 1.0 / nearest);
  }
  const double depth_m = 1.0 / inverse_depth;
  return depth_m > 0.0 && depth_m < 1e30 ? static_cast<float>(depth_m) : 0.0F;
}

/// The line as a pixel sees it. Where the entrance pupil moves, vertices are seen from the pupils
/// of their own rays, which bends the line between them by the deviation of the pupil's place along
/// the edge from linear; from this pixel's own pupil the edge's line is exact.
Eigen::Vector3d SalientEdges::lineAt(const Context& context, const Crossing& crossing, int x,
                                     int y) {
  const EdgeRender& output = context.output;
  Ray ray;
  if (crossing.edge_of < 0 || crossing.edge < 0 ||
      !unprojectRay(output.camera, Eigen::Vector2d(x, y), ray))
    return crossing.line;
  const Corners corners = context.scene.mesh.corners(static_cast<std::size_t>(crossing.edge_of));
  const auto seen = [&](int corner) {
    return Eigen::Vector3d(output.camera_from_station * nth(corners, corner % 3) - ray.origin_m);
  };
  const Eigen::Vector3d line = crossProduct(seen(crossing.edge), seen(crossing.edge + 1));
  return dotProduct(line, crossing.line) < 0.0 ? Eigen::Vector3d(-line) : line;
}

[[gnu::always_inline]] inline void SalientEdges::mark(const Context& context, const Sample& p,
                                                      const Sample& q, const Crossing& crossing) {
  const RasterBand& band = context.band;
  const bool mark_p = crossing.s <= 0.5;
  const Sample& marked = mark_p ? p : q;
  const int y = band.first_y + marked.row - 1;
  if (y < first_y_ || y > last_y_) return;
  const Sample& own = crossing.nearer_is_p ? p : q;
  const bool is_own = mark_p == crossing.nearer_is_p;

  EdgePixel pixel;
  pixel.x = static_cast<std::int16_t>(marked.x);
  pixel.y = static_cast<std::int16_t>(y);
  pixel.kind = crossing.kind;
  pixel.face = is_own ? own.face : crossing.face;
  pixel.depth_m = depthOf(context, own, marked, between(p.ray, q.ray, crossing.s), pixel.face);
  if (!(pixel.depth_m > 0.0F)) return;

  // Without a line to differentiate: across the pair.
  const double towards_q = crossing.nearer_is_p ? 1.0 : -1.0;
  double normal_x = (q.x - p.x) * towards_q;
  double normal_y = (q.row - p.row) * towards_q;
  double distance_px = (crossing.s - (mark_p ? 0.0 : 1.0)) * towards_q;
  // The line's value and its derivative along the image axes. The rows and columns that are
  // differenced depend on the image alone, not on how it is cut into bands.
  const std::size_t at = band.index(marked.x, marked.row);
  const std::size_t left = marked.x + 1 < band.x_end ? at : at - 1;
  const int top_row = p.row != q.row ? p.row : (p.row < band.rows ? p.row : p.row - 1);
  const std::size_t top = band.index(marked.x, top_row);
  const std::size_t below = top + static_cast<std::size_t>(band.stride);
  const bool columns_known = left == at || marked.x > band.x_begin;
  const bool rows_known = top_row >= 1 || (top_row == 0 && band.first_y > 0);
  if (crossing.has_line && columns_known && rows_known && band.face[left] != RasterBand::kInvalid &&
      band.face[left + 1] != RasterBand::kInvalid && band.face[top] != RasterBand::kInvalid &&
      band.face[below] != RasterBand::kInvalid) {
    const Eigen::Vector3d line =
        pupilMoves(context.output.camera) ? lineAt(context, crossing, marked.x, y) : crossing.line;
    const auto valueAt = [&](std::size_t entry) {
      return line.x() * band.ray_x[entry] + line.y() * band.ray_y[entry] + line.z();
    };
    const double along_x = valueAt(left + 1) - valueAt(left);
    const double along_y = valueAt(below) - valueAt(top);
    const double norm = std::sqrt(along_x * along_x + along_y * along_y);
    if (norm > 0.0 && norm < 1e300) {
      normal_x = -along_x / norm;
      normal_y = -along_y / norm;
      distance_px = dotProduct(line, marked.ray) / norm;
    }
  }
  pixel.normal_x = rounded8(normal_x * 127.0);
  pixel.normal_y = rounded8(normal_y * 127.0);
  pixel.offset = rounded8(distance_px * 100.0);

  EdgePixel& slot = nth(candidates_, (y & 1) * stride_ + marked.x);
  BitImage& edges = context.output.edges;
  if (!edges.get(marked.x, y) || preferred(pixel, slot)) slot = pixel;
  edges.set(marked.x, y);
}

/// Pairs of neighbours within a row, and the row's mask.
void SalientEdges::compareWithin(const Context& context, int row, int x_first, int x_last) {
  const CameraScene& scene = context.scene;
  const std::int32_t* face = &context.band.face[context.band.index(0, row)];
  std::uint64_t* mask = context.output.mask.row(context.band.first_y + row - 1);
  const auto isMatched = [&scene](std::int32_t at) -> unsigned {
    return at >= 0 && scene.part(at).match ? ~0U : 0U;
  };
  unsigned matched = 0;  // all bits, for the current face
  if (x_first <= x_last) matched = isMatched(face[x_first]);
  for (int x = x_first; x <= x_last;) {
    const int end = std::min((x / kRun_px + 1) * kRun_px, x_last + 1);
    const int count = end - x;
    unsigned differing = differingFaces(face + x, face + x + 1, std::min(count, x_last - x));
    unsigned bits = matched;
    for (; differing != 0; differing &= differing - 1) {
      const int i = std::countr_zero(differing);
      if (!isPlain(scene, face[x + i], face[x + i + 1]))
        comparePair(context, x + i, row, x + i + 1, row);
      matched = isMatched(face[x + i + 1]);
      const unsigned after = ~0U << (i + 1);
      bits = (bits & ~after) | (matched & after);
    }
    mask[x >> 6] |= static_cast<std::uint64_t>(bits & ((1U << count) - 1U)) << (x & 63);
    x = end;
  }
}

/// Pairs of a row with the row below.
void SalientEdges::compareBelow(const Context& context, int row, int x_first, int x_last) {
  const std::int32_t* face = &context.band.face[context.band.index(0, row)];
  const std::int32_t* below = &context.band.face[context.band.index(0, row + 1)];
  for (int x = x_first; x <= x_last; x += kRun_px) {
    unsigned differing = differingFaces(face + x, below + x, std::min(kRun_px, x_last + 1 - x));
    for (; differing != 0; differing &= differing - 1) {
      const int at = x + std::countr_zero(differing);
      if (!isPlain(context.scene, face[at], below[at])) comparePair(context, at, row, at, row + 1);
    }
  }
}

/// Ends the rows from y on with the pixels found so far.
void SalientEdges::endRows(int y, EdgeRender& output) const {
  for (int row = y; row <= last_y_; ++row)
    output.row_begin[static_cast<std::size_t>(row) + 1] = output.pixel_count;
}

/// The row's edge pixels into the mask and the output.
Status SalientEdges::finishRow(const Context& context, int row) {
  EdgeRender& output = context.output;
  const int y = context.band.first_y + row - 1;
  std::uint64_t* mask = output.mask.row(y);
  const std::uint64_t* edges = output.edges.row(y);
  for (int word = 0; word < output.edges.words_per_row; ++word) {
    mask[word] |= edges[word];
    for (std::uint64_t bits = edges[word]; bits != 0; bits &= bits - 1) {
      const int x = word * 64 + std::countr_zero(bits);
      if (static_cast<std::size_t>(output.pixel_count) >= output.pixels.size()) {
        endRows(y, output);
        return Status::kCapacityExceeded;
      }
      nth(output.pixels, output.pixel_count++) =
          PackedEdgePixel(nth(candidates_, (y & 1) * stride_ + x));
    }
  }
  output.row_begin[static_cast<std::size_t>(y) + 1] = output.pixel_count;
  return Status::kOk;
}

void SalientEdges::addRowAbove(const CameraScene& scene, const RasterBand& band, int x_first,
                               int x_last, EdgeRender& output) {
  compareBelow({scene, band, output}, 1, x_first, x_last);
}

Status SalientEdges::addBand(const CameraScene& scene, const RasterBand& band, int x_first,
                             int x_last, bool final, EdgeRender& output) {
  const Context context{scene, band, output};
  const int first_row = band.first_y > 0 ? 0 : 1;
  const int last_row = final ? band.rows : band.rows - 1;
  for (int row = first_row; row <= last_row; ++row) {
    compareWithin(context, row, x_first, x_last);
    if (row < band.rows) compareBelow(context, row, x_first, x_last);
    const Status status = finishRow(context, row);
    if (status != Status::kOk) return status;
  }
  return Status::kOk;
}

}  // namespace boresight
