// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/search/search_problem.h"

namespace boresight {

/// The search over twice the seed's uncertainty: a seed may be farther off than stated. A wrong
/// pose within the stated range then explains less of the image than the correct pose outside.
SearchProblem widerSearch(const SearchProblem& problem);

}  // namespace boresight
