// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tests/support/example_run.h"
#include "tests/support/loaded_example.h"
#include "ui/state/view_state.h"

namespace boresight::test {

/// The example station whose run exampleRun() is, made once per program.
inline const std::shared_ptr<const sessions::LoadedCase>& sceneCase() {
  static const auto made = loadedExample("os");
  return made;
}

/// A view state with the case and its finished run, at the last iteration that has templates.
inline void showRun(ui::ViewState& state) {
  state.setCase(sceneCase());
  state.setSnapshot(exampleRun());
  for (int i = static_cast<int>(exampleRun()->iterations.size()) - 1; i >= 0; --i)
    if (!exampleRun()->iterations[static_cast<std::size_t>(i)]->templates.empty()) {
      state.setCursor({i, Stage::kFinished});
      return;
    }
}

}  // namespace boresight::test
