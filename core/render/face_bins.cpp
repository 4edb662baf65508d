// SPDX-License-Identifier: Apache-2.0
#include "core/render/face_bins.h"

#include <algorithm>
#include <cstring>

#include "core/base/nth.h"

namespace boresight {
namespace {

/// Faces that are looked at together.
constexpr std::size_t kChunk = 128;

/// The pixels of some faces' vertices, x and y alternating: the same comparison applies to both.
class Chunk {
 public:
  void gather(const CameraScene& scene, std::size_t first, std::size_t count) {
    static_assert(sizeof(FixedPixel) == 2 * sizeof(std::int16_t));
    const FixedPixel* pixels = scene.vertex_px.data();
    scene.mesh.faces.forEach(first, count, [&](std::size_t i, const auto& vertex) {
      for (std::size_t k = 0; k < 3; ++k)
        std::memcpy(&value_[k][2 * i], &pixels[vertex[k]], sizeof(FixedPixel));
    });
  }

  /// Finds the faces whose boxes hold the centre of a pixel.
  void findCentres(const SmallFaces& small) {
    const auto slack = static_cast<std::uint16_t>(small.slack());
    const auto whole = static_cast<std::uint16_t>(-small.scale().steps());
    for (std::size_t i = 0; i < 2 * kChunk; ++i) {
      const std::int16_t a = value_[0][i];
      const std::int16_t b = value_[1][i];
      const std::int16_t c = value_[2][i];
      const std::int16_t low_ab = a < b ? a : b;
      const std::int16_t high_ab = a < b ? b : a;
      const std::int16_t low = low_ab < c ? low_ab : c;
      const std::int16_t high = high_ab < c ? c : high_ab;
      // The last centre up to the upper end is not before the lower end.
      const auto to = static_cast<std::uint16_t>(high);
      const auto from = static_cast<std::uint16_t>(low);
      const auto centre = static_cast<std::int16_t>(static_cast<std::uint16_t>(to + slack) & whole);
      const auto begin = static_cast<std::int16_t>(static_cast<std::uint16_t>(from - slack));
      holds_[i] = static_cast<std::uint16_t>(centre >= begin ? 0xFFFF : 0);
    }
  }

  bool holdsCentre(std::size_t i) const { return (holds_[2 * i] & holds_[2 * i + 1]) != 0; }
  FixedPixel corner(std::size_t k, std::size_t i) const {
    return {value_[k][2 * i], value_[k][2 * i + 1]};
  }

 private:
  std::int16_t value_[3][2 * kChunk] = {};
  std::uint16_t holds_[2 * kChunk] = {};
};

}  // namespace

FaceBins FaceBins::create(std::size_t faces, int max_bands, int max_shares, Arena& arena) {
  FaceBins bins;
  bins.next_ = IndexList::create(faces, faces, arena);
  // Level k has a block for every 2^k bands: fewer than two per band and one per level in all.
  const int blocks = 2 * max_bands + kMostLevels;
  bins.heads_ = static_cast<std::size_t>(blocks + 2 * max_bands) * 2;
  bins.bands_ = static_cast<std::size_t>(max_bands);
  const auto shares = static_cast<std::size_t>(max_shares);
  bins.head_ = arena.allocate<std::int32_t>(shares * bins.heads_);
  bins.columns_ = arena.allocate<Columns>(shares * bins.bands_);
  return bins;
}

void FaceBins::begin(const CameraScene& scene, const RayGrid& rays, int band_rows, bool plain,
                     int shares) {
  shares_ = shares;
  small_ = plain ? SmallFaces() : SmallFaces(scene, rays);
  band_rows_ = band_rows;
  const int bands = (rays.camera().height - 1) / band_rows + 1;
  first_of_kind_[kSmallFront] = 0;
  first_of_kind_[kSmallBack] = bands;
  levels_ = 0;
  for (int first = 2 * bands; levels_ < kMostLevels; ++levels_) {
    nth(first_of_level_, levels_) = first;
    first += ((bands - 1) >> levels_) + 1;
    if ((bands - 1) >> levels_ == 0) break;
  }
  ++levels_;
  std::fill(head_.begin(), head_.end(), -1);
  std::fill(columns_.begin(), columns_.end(), Columns());
}

std::int32_t FaceBins::firstFace(int band, int list) const {
  // Each block three times: within it, with the next, and with the one before; and that of every
  // share.
  const int share = list % shares_;
  const int group = list / shares_ / 3;
  const int relation = list / shares_ % 3;
  const int level = levels_ - 1 - group;
  int block = level >= 0 ? band >> level : band;
  if (relation == 2) --block;
  if (block < 0) return -1;
  const int first = level >= 0 ? nth(first_of_level_, level) : nth(first_of_kind_, -1 - level);
  return head_[static_cast<std::size_t>(share) * heads_ +
               static_cast<std::size_t>((first + block) * 2 + (relation > 0 ? 1 : 0))];
}

[[gnu::always_inline]] inline void FaceBins::enter(std::int32_t face, Kind kind,
                                                   const PixelBounds& bounds, const Share& share) {
  const int first_band = bounds.y_first / band_rows_;
  const int last_band = bounds.y_last / band_rows_;
  for (int band = first_band; band <= last_band; ++band)
    nth(share.columns, band).include(bounds.x_first, bounds.x_last);
  int level = 0;
  while ((last_band >> level) - (first_band >> level) > 1) ++level;
  const int block = first_band >> level;
  const int further = (last_band >> level) - block;
  const int first = kind == kWide || level > 0 ? nth(first_of_level_, level) : first_of_kind_[kind];
  std::int32_t& head = nth(share.head, (first + block) * 2 + further);
  next_.set(static_cast<std::size_t>(face), head);
  head = face;
}

void FaceBins::addWide(CameraScene& scene, const RayGrid& rays, std::int32_t face,
                       const Share& share) {
  const PixelBounds bounds = faceBounds(scene, rays, face);
  if (bounds.empty()) return;
  scene.orient(face);
  enter(face, kWide, bounds, share);
}

/// A face that its chunk could not rule out. Called at one place.
[[gnu::always_inline]] inline void FaceBins::addOne(CameraScene& scene, const RayGrid& rays,
                                                    std::int32_t face, const FixedFace& fixed,
                                                    const Share& share) {
  if (fixed.low_x == FixedPixel::kNotProjected || !small_.isSmall(fixed))
    return addWide(scene, rays, face, share);
  const PixelBox box = small_.box(fixed);
  const FixedScale& scale = small_.scale();
  const int tolerance = small_.tolerance(fixed);
  const int area2 = fixed.area2();
  if (box.x_first == box.x_last && box.y_first == box.y_last) {
    const int x = box.x_first * scale.steps();
    const int y = box.y_first * scale.steps();
    const int ab = fixed.lineAb(x, y);
    const int bc = fixed.lineBc(x, y);
    if (FixedFace::locate(ab, bc, area2 - ab - bc, tolerance) < 0) return;
  }
  const Camera& camera = rays.camera();
  PixelBounds bounds;
  bounds.x_first = std::max(box.x_first + scale.middle_x, 0);
  bounds.x_last = std::min(box.x_last + scale.middle_x, camera.width - 1);
  bounds.y_first = std::max(box.y_first + scale.middle_y, 0);
  bounds.y_last = std::min(box.y_last + scale.middle_y, camera.height - 1);
  if (bounds.empty()) return;
  if (area2 > tolerance || area2 < -tolerance)
    scene.setFrontFacing(face, (area2 < 0) != isMirrored(camera));
  else
    scene.orient(face);
  enter(face, scene.isFrontFacing(face) ? kSmallFront : kSmallBack, bounds, share);
}

/// Most faces of a fine mesh lie between the centres of pixels: such faces are found many at a
/// time.
void FaceBins::add(CameraScene& scene, const RayGrid& rays, std::size_t first, std::size_t last,
                   int share) {
  const Share entered = shareOf(share);
  if (!small_.possible()) {
    for (std::size_t face = first; face < last; ++face)
      addWide(scene, rays, static_cast<std::int32_t>(face), entered);
    return;
  }
  Chunk chunk;
  for (std::size_t begin = first; begin < last; begin += kChunk) {
    const std::size_t count = std::min(kChunk, last - begin);
    chunk.gather(scene, begin, count);
    chunk.findCentres(small_);
    for (std::size_t i = 0; i < count; ++i)
      if (chunk.holdsCentre(i))
        addOne(scene, rays, static_cast<std::int32_t>(begin + i),
               FixedFace(chunk.corner(0, i), chunk.corner(1, i), chunk.corner(2, i)), entered);
  }
}

void FaceBins::finish() {
  for (int share = 1; share < shares_; ++share) {
    const Share other = shareOf(share);
    for (std::size_t band = 0; band < bands_; ++band)
      columns_[band].include(other.columns[band].first, other.columns[band].last);
  }
}

}  // namespace boresight
