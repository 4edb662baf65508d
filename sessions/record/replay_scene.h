// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "core/localizer/localizer_options.h"
#include "core/localizer/problem.h"
#include "core/templates/template_selection.h"
#include "sessions/run/scene_render.h"

namespace boresight::sessions {

/// Renders the scene level by level as a run would, and chooses templates in what it shows.
class ReplayScene {
 public:
  /// What `ground` points to must outlive the object.
  explicit ReplayScene(const LocalizationProblem& ground) : ground_(ground) {}

  /// False when the scene cannot be rendered from there.
  bool render(const Pose& camera_from_station, int level, RenderTrace& output);
  /// Templates that the core chooses in a render of that level; none when it cannot.
  std::vector<Template> choose(const RenderTrace& render, int level, int side_px,
                               const TemplateOptions& options) const;

 private:
  const LocalizationProblem& ground_;
  std::map<int, SceneRenderer> levels_;
};

}  // namespace boresight::sessions
