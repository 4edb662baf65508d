// SPDX-License-Identifier: Apache-2.0
#include "sessions/trace/searched_template.h"

#include <memory>

namespace boresight::sessions {

SearchedTemplate::SearchedTemplate(const IterationTrace& iteration, std::size_t index)
    : edges_(iteration.render.edges.view()), mask_(iteration.render.mask.view()) {
  const Template& item = iteration.templates[index];
  view_ = {&edges_, &mask_, item.center_x, item.center_y, iteration.template_side_px};
  const TemplateWarp warp =
      index < iteration.matches.size() ? iteration.matches[index].warp : TemplateWarp();
  if (warp == TemplateWarp()) return;
  Arena counter;
  warped_.create(view_.side_px, counter);
  memory_.resize(counter.highWater() + Arena::kAlignment);
  void* block = memory_.data();
  std::size_t room = memory_.size();
  std::align(Arena::kAlignment, counter.highWater(), block, room);
  Arena arena({static_cast<std::byte*>(block), counter.highWater()});
  warped_.create(view_.side_px, arena);
  view_ = warped_.warp(view_, warp);
}

}  // namespace boresight::sessions
