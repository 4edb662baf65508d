// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <QColor>
#include <QPointF>
#include <QPolygonF>
#include <QRectF>
#include <QString>

#include "core/base/image.h"
#include "sessions/session/case_run.h"
#include "sessions/trace/edge_lines.h"
#include "sessions/trace/picture_data.h"
#include "sessions/trace/trace.h"
#include "ui/style/tokens.h"

namespace boresight::ui {

/// Layers over the image, from the lowest to the highest.
enum class LayerId : std::uint8_t {
  kIgnoreMask,
  kTestEdges,
  kMask,
  kAgreement,
  kSeedEdges,
  kIterationEdges,
  kTruthEdges,  ///< thin, above the pose
  kNudgedEdges,
  kAnnotationBand,
  kAnnotationEdges,
  kChosenEdges,
  kHypothesisEdges,
  kWindows,
  kTemplates,
  kMatches,
  kResiduals,
  kAnnotationResiduals,
  kProposals,
  kPoints,
};
inline constexpr int kLayerCount = 19;

/// Colour of the pose solved from annotations, in all views.
inline const QColor kAnnotatedColor(178, 120, 255);

struct LayerStyle {
  bool visible = false;
  QColor color;
  double opacity = 1.0;  ///< 0 .. 1

  bool operator==(const LayerStyle&) const = default;
};

/// Description of a layer for the operator: its name, its key, its default look.
struct LayerInfo {
  LayerId id = LayerId::kTestEdges;
  const char* name = "";
  const char* key = "";  ///< key sequence that shows and hides it
  const char* help = "";
  LayerStyle style;
  LineToken line = kPoseLine;  ///< of its edges; the style has the colour
};
const LayerInfo& layerInfo(LayerId id);

/// Whether the run ended without an accepted pose, which must not look like a result.
inline bool isRejected(const sessions::LocalizationTrace& run) {
  return run.status != LocalizationStatus::kRunning && !run.converged();
}

/// Lines that a layer draws.
using LinesPtr = std::shared_ptr<const sessions::EdgeLines>;
LinesPtr linesOf(const sessions::RenderTrace& render, int level);
/// Salient edges of a case rendered from a pose; nullptr if the core rejects it.
LinesPtr linesOf(const sessions::LoadedCase& loaded_case, const Pose& camera_from_station);

/// A packed binary image of a pyramid level; `owner` keeps its words alive.
struct LayerBits {
  std::shared_ptr<const void> owner;
  BitImage bits;
  int level = 0;  ///< its pixel (x, y) covers 2^level x 2^level pixels of the image
  QColor color;   ///< instead of the layer's, where valid
};

enum class MarkShape : std::uint8_t {
  kCross,
  kCircle,
  kSquare,
  kDiamond,
  kTriangle,
  kTarget,  ///< a cross that leaves its middle free, in a ring
  kStruck,  ///< a circle struck through
  kArrow,
  kSegment,
  kRectangle,
  kStrip,  ///< between two lines, lightly filled
};

/// A symbol drawn with lines of constant width. Coordinates are pixels of the full image; the
/// centre of the top-left pixel is (0, 0).
struct Mark {
  MarkShape shape = MarkShape::kCross;
  QPointF at;                     ///< centre, or start of an arrow or a segment
  QPointF to;                     ///< end of an arrow or a segment
  QRectF area;                    ///< of a rectangle
  QPolygonF outline;              ///< of a strip: along one side and back along the other
  double size_px = 9.0;           ///< on the screen, at any zoom
  QColor color;                   ///< instead of the layer's, where valid
  bool dashed = false;            ///< a second distinction in addition to the colour
  bool cased = false;             ///< with a dark rim, to be seen on any image
  double width = 1.5;             ///< of its lines, on the screen
  std::optional<LineToken> line;  ///< width, pattern and halo instead of these three
  int item = -1;                  ///< its object (a template, a point), or -1: cannot be picked
  QString label;
};

/// One layer as the image view draws it.
struct Layer {
  LayerId id = LayerId::kTestEdges;
  LayerStyle style;
  std::vector<LayerBits> bits;
  std::vector<Mark> marks;
  LinesPtr lines;
  std::optional<LineToken> line;  ///< current look of the lines, instead of the layer's own
  QString name;                   ///< name of its current content, instead of the layer's name
  bool faded = false;             ///< drawn faintly while other layers are compared

  bool isShown() const { return style.visible && style.opacity > 0.0; }
  bool empty() const { return bits.empty() && marks.empty() && (!lines || lines->empty()); }
  /// With the colour of the style, unless `line` replaces it.
  LineToken shownLine() const;
};

/// Magnification of residual vectors on the image.
inline constexpr double kResidualMagnification = 40.0;

std::vector<LayerBits> testEdgeBits(const std::shared_ptr<const sessions::EdgeMapTrace>& edges,
                                    int level);
std::vector<LayerBits> ignoreBits(const std::shared_ptr<const sessions::LoadedCase>& loaded_case);
/// Mask of an iteration's render.
std::vector<LayerBits> maskBits(const std::shared_ptr<const sessions::IterationTrace>& iteration);
/// Three colours: both, only rendered, only image.
std::vector<LayerBits> agreementBits(const std::shared_ptr<const sessions::AgreementMaps>& maps,
                                     int level);

/// The chosen template, and from the search on its window; empty when none is chosen.
std::vector<Mark> chosenMarks(const sessions::IterationTrace& iteration, int selected_template,
                              bool searched);
std::vector<Mark> templateMarks(const sessions::IterationTrace& iteration, int selected_template);
std::vector<Mark> matchMarks(const sessions::IterationTrace& iteration, int selected_template);
std::vector<Mark> residualMarks(const sessions::IterationTrace& iteration, const Camera& camera);

}  // namespace boresight::ui
