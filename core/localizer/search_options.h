// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/base/options.h"

namespace boresight {

/// Options of the search before the first iteration.
struct SearchOptions {
  bool enabled = true;
  bool color = true;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"search.enabled", "", 0, 1,
                     "Search the whole object over the seed's uncertainty before the first "
                     "iteration."},
          self.enabled);
    visit(OptionInfo{"search.color", "", 0, 1,
                     "The search and its evidence use the image's colour, where it has any."},
          self.color);
  }
};

}  // namespace boresight
