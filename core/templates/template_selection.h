// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "core/base/arena.h"
#include "core/base/image.h"
#include "core/base/options.h"
#include "core/base/status.h"
#include "core/render/edge_render.h"

namespace boresight {

/// Options of the template selection.
struct TemplateOptions {
  std::int32_t count = 96;
  double feature_size_m = 0.0;
  double size_factor = 2.0;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"templates.count", "", 4, 1024, "Templates per iteration, at most."},
          self.count);
    visit(OptionInfo{"templates.feature_size_m", "m", 0.0, 100.0,
                     "Size of the station's features (sleeves, screws); 0: an eighth of the mesh's "
                     "diagonal."},
          self.feature_size_m);
    visit(OptionInfo{"templates.size_factor", "", 0.25, 16.0,
                     "Side of a template over the projected feature size, before rounding to a "
                     "power of two."},
          self.size_factor);
  }
};

/// One template: the square of the render's edges and mask around an edge pixel. Its bits stay in
/// the render.
struct Template {
  std::int32_t center_x = 0;  ///< px at the level of the render
  std::int32_t center_y = 0;  ///< px at the level of the render
  float depth_m = 0.0F;       ///< z of the edge at the centre
  float distinctness = 0.0F;  ///< smaller eigenvalue of the edge normals' scatter, in edge pixels
  /// Position of the edge at the centre.
  Eigen::Vector3d point_in_station_m = Eigen::Vector3d::Zero();
};

/// The templates of a render.
struct TemplateSet {
  std::span<Template> templates;  ///< capacity; the first `count` are valid
  std::int32_t count = 0;         ///< templates chosen
  std::int32_t side_px = 0;       ///< of their square, px at the level
};

/// The power of two nearest (in ratio) to the projected size of a feature at a depth, at least
/// TemplateSelector::kMinSide_px, times a further attempt's factor (a power of two); at most
/// kMaxSide_px, and a quarter of the image's smaller side.
int templateSide(const TemplateOptions& options, double feature_size_m, double depth_m,
                 const Camera& camera, double attempt_factor);

/// Picks places where edges of more than one direction meet (a straight edge slides along itself).
/// In every cell of a square grid over the render, this is the edge pixel whose surrounding square
/// has the largest smaller eigenvalue of the scatter of edge normals, sum of n n'. The cell size is
/// the smallest one that yields no more than `options.count` templates. Pham 2025, Sec. III-A and
/// III-B, centres templates on edge pixels and states neither their number nor how they are chosen.
/// `ignore` (full resolution, may be nullptr) belongs to the image at `level` 0.
class TemplateSelector {
 public:
  static constexpr int kMinSide_px = 64;   ///< smaller squares match in many places
  static constexpr int kMaxSide_px = 256;  ///< larger squares take long to match
  static constexpr int kMinCount = 6;      ///< the default number of inliers that a pose needs
  /// Least number of edge pixels in a template: fewer match anywhere.
  static constexpr int kMinEdgePixels = 12;
  /// Largest ignored share of a template's predicted area: the rest must suffice to match.
  static constexpr double kMaxIgnoredShare = 0.3;

  /// Takes the memory for renders of up to this size. kArenaTooSmall, kInvalidOption.
  Status create(int max_width, int max_height, const TemplateOptions& options, Arena& arena);
  /// Other options from the next select() on, except those that size the memory (count).
  void setOptions(const TemplateOptions& options) { options_ = options; }
  /// kTooFewTemplates when fewer than kMinCount can be placed; `output` then holds the templates
  /// found.
  Status select(const EdgeRender& render, int side_px, const BitImage* ignore, int level,
                TemplateSet& output);

 private:
  struct Scatter {
    std::uint32_t xx = 0, xy = 0, yy = 0, count = 0;
  };
  struct Best {
    float distinctness = -1.0F;
    std::int32_t pixel = -1;
  };
  static constexpr std::uint16_t kUnoccupied = 0xffff;
  /// Rows of blocks of the summed-area table that are held at a time, a power of two: a square
  /// reaches at most kMaxReach blocks from its middle one.
  static constexpr int kHeldRows = 16;
  static constexpr int kMaxReach = 4;
  static_assert(2 * kMaxReach + 2 <= kHeldRows);

  void beginSums(const EdgeRender& render, int side_px);
  void sumRow(const EdgeRender& render);
  std::span<Scatter> sumsOf(int row);
  std::span<const Scatter> sumsOf(int row) const;
  int reachOf(int side_px) const;
  Scatter scatterAround(int x, int y, int side_px) const;
  float distinctnessOf(const EdgePixel& pixel, int side_px) const;
  bool tooMuchIgnored(const EdgePixel& pixel, int side_px, const BitImage* ignore, int level) const;
  template <class Use>
  void forEachPlace(const EdgeRender& render, int side_px, int cell_px, Use&& use);
  int countCells(const EdgeRender& render, int side_px, int cell_px);
  int cellSize(const EdgeRender& render, int side_px);
  void chooseBest(const EdgeRender& render, int side_px, int cell_px, const BitImage* ignore,
                  int level);

  TemplateOptions options_;
  std::span<Scatter> sums_;         ///< summed-area table over blocks, modulo 2^32: the rows held
  std::span<std::uint16_t> cells_;  ///< per cell its index in best_, or kUnoccupied
  std::span<Best> best_;            ///< one for each occupied cell
  int summed_rows_ = 0;             ///< of the table, so far
  int block_px_ = 0;
  int blocks_x_ = 0;
  int blocks_y_ = 0;
};

/// Sizes a TemplateSet.
TemplateSet createTemplateSet(const TemplateOptions& options, Arena& arena);

}  // namespace boresight
