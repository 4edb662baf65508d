// SPDX-License-Identifier: Apache-2.0
#include "core/search/wider_search.h"

#include "core/base/math.h"

namespace boresight {

SearchProblem widerSearch(const SearchProblem& problem) {
  constexpr double kWider = 2.0;
  SearchProblem wider = problem;
  wider.uncertainty.translation_m *= kWider;
  wider.uncertainty.rotation_rad = (kWider * wider.uncertainty.rotation_rad).cwiseMin(kPi);
  return wider;
}

}  // namespace boresight
