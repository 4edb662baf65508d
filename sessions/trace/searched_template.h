// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "core/match/template_warp.h"
#include "sessions/trace/trace.h"

namespace boresight::sessions {

/// The bits of a template as it was looked for: those of the iteration's render, warped as its
/// match says.
class SearchedTemplate {
 public:
  /// `index` is that of a template; the iteration was recorded in full and outlives this.
  SearchedTemplate(const IterationTrace& iteration, std::size_t index);
  SearchedTemplate(const SearchedTemplate&) = delete;
  SearchedTemplate& operator=(const SearchedTemplate&) = delete;

  const TemplateView& view() const { return view_; }

 private:
  BitImage edges_;
  BitImage mask_;
  std::vector<std::byte> memory_;
  WarpedTemplate warped_;
  TemplateView view_;
};

}  // namespace boresight::sessions
