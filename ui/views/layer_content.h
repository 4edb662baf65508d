// SPDX-License-Identifier: Apache-2.0
// What the records of a run look like as layers.
#pragma once

#include <memory>

#include "sessions/run/picture_data.h"
#include "sessions/run/trace.h"
#include "sessions/session/case_run.h"
#include "ui/views/layer.h"

namespace boresight::ui {

/// How much residual vectors are magnified on the image.
inline constexpr double kResidualMagnification = 40.0;

std::vector<LayerBits> bitsOf(const std::shared_ptr<const sessions::RenderTrace>& render,
                              bool mask);
std::vector<LayerBits> testEdgeBits(const std::shared_ptr<const sessions::EdgeMapTrace>& edges,
                                    int level);
std::vector<LayerBits> ignoreBits(const std::shared_ptr<const sessions::LoadedCase>& one);
/// Edges or mask of an iteration's render.
std::vector<LayerBits> iterationBits(
    const std::shared_ptr<const sessions::IterationTrace>& iteration, bool mask);
/// Three colours: both, only rendered, only image.
std::vector<LayerBits> agreementBits(const std::shared_ptr<const sessions::AgreementMaps>& maps,
                                     int level);

std::vector<Mark> windowMarks(const sessions::IterationTrace& iteration, int selected_template);
std::vector<Mark> templateMarks(const sessions::IterationTrace& iteration, int selected_template);
std::vector<Mark> matchMarks(const sessions::IterationTrace& iteration, int selected_template);
std::vector<Mark> residualMarks(const sessions::IterationTrace& iteration, const Camera& camera);

}  // namespace boresight::ui
