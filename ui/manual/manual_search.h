// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QString>

#include "ui/manual/manual_folder.h"

namespace boresight::ui {

/// A page that holds every word that was looked for.
struct ManualHit {
  ManualPage page;
  int count = 0;   ///< how often the words are there, all together
  QString around;  ///< the line of the first one, shortened
};

/// The pages that hold all words of `query`, whatever their case: first those whose title does,
/// then those that hold them most often. An empty query finds nothing.
std::vector<ManualHit> searchManual(const QString& folder, const QString& query);

}  // namespace boresight::ui
