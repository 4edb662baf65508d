// SPDX-License-Identifier: Apache-2.0
#include "ui/views/layer.h"

#include <array>

namespace boresight::ui {
namespace {

/// Colours that differ in lightness too, as red and green must not be the only difference.
const std::array<LayerInfo, kLayerCount>& infos() {
  static const std::array<LayerInfo, kLayerCount> made = {{
      {LayerId::kIgnoreMask,
       "Ignore mask",
       "G",
       "Pixels that are not trusted",
       {true, QColor(200, 60, 200), 0.35}},
      {LayerId::kTestEdges,
       "Test edges",
       "E",
       "Canny's edges of the image, as the core has them",
       {false, QColor(255, 255, 255), 0.8}},
      {LayerId::kMask,
       "Rendered mask",
       "K",
       "Where the station was rendered",
       {false, QColor(90, 200, 255), 0.25}},
      {LayerId::kSeedEdges,
       "Seed edges",
       "S",
       "Salient edges rendered from the seed",
       {true, QColor(255, 70, 60), 0.9}},
      {LayerId::kTruthEdges,
       "Truth edges",
       "T",
       "Salient edges rendered from the true pose",
       {false, QColor(70, 140, 255), 0.9}},
      {LayerId::kIterationEdges,
       "Iteration edges",
       "I",
       "Salient edges as the shown iteration rendered them",
       {true, QColor(80, 235, 90), 0.9}},
      {LayerId::kAgreement,
       "Agreement",
       "A",
       "Where rendered and test edges meet, only the render has one, only the image has one",
       {false, QColor(255, 220, 60), 0.9}},
      {LayerId::kNudgedEdges,
       "Nudged edges",
       "N",
       "Salient edges of the pose being nudged",
       {true, QColor(255, 160, 30), 1.0}},
      {LayerId::kAnnotationBand,
       "Annotation's band",
       "U",
       "Where 95 % of the poses that the marks allow put the salient edges",
       {false, kAnnotatedColor, 0.6}},
      {LayerId::kAnnotationEdges,
       "Annotation's edges",
       "O",
       "Salient edges rendered from the pose that the marks give; while they show, Ctrl+click "
       "picks "
       "the station on them",
       {true, kAnnotatedColor, 0.6}},
      {LayerId::kChosenEdges,
       "Chosen pose's edges",
       "F",
       "Salient edges of the pose that the run went on with, while another hypothesis is shown",
       {true, QColor(255, 250, 170), 0.9}},
      {LayerId::kHypothesisEdges,
       "Hypothesis' edges",
       "H",
       "Salient edges of the hypothesis chosen under Hypotheses",
       {true, QColor(255, 60, 230), 0.9}},
      {LayerId::kWindows,
       "Search windows",
       "W",
       "Where each template was searched",
       {false, QColor(180, 180, 255), 0.6}},
      {LayerId::kTemplates,
       "Templates",
       "P",
       "Where the templates were taken from the render",
       {false, QColor(255, 235, 120), 0.9}},
      {LayerId::kMatches,
       "Matches",
       "M",
       "From where a template was predicted to where it was found; outliers are dashed",
       {true, QColor(120, 255, 240), 0.9}},
      {LayerId::kResiduals,
       "Residuals",
       "R",
       "What the solved pose leaves of each match, magnified",
       {false, QColor(255, 120, 200), 0.9}},
      {LayerId::kMarkResiduals,
       "Marks' residuals",
       "X",
       "From where the solved pose puts a mark to where it was marked, magnified; dashed while the "
       "pose is not up to date",
       {true, QColor(255, 120, 200), 0.9}},
      {LayerId::kProposals,
       "Proposed marks",
       "Y",
       "Where named points of the station should be; a click takes one as it is",
       {true, QColor(140, 230, 255), 0.9}},
      {LayerId::kPoints,
       "Marks",
       "D",
       "Points and lines marked by hand",
       {true, QColor(255, 210, 0), 1.0}},
  }};
  return made;
}

}  // namespace

const LayerInfo& layerInfo(LayerId id) { return infos()[static_cast<std::size_t>(id)]; }

}  // namespace boresight::ui
