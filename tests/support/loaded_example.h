// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "tests/support/example_case.h"
#include "ui/state/loaded_case.h"

namespace boresight::test {

/// A station of the example that ships, as the desktop program holds a case.
inline std::shared_ptr<const ui::LoadedCase> loadedExample(const std::string& station) {
  const ExampleCase example(station);
  auto loaded = std::make_shared<ui::LoadedCase>();
  loaded->image = example.image;
  loaded->camera = example.camera;
  loaded->scene = example.scene;
  loaded->camera_from_station_seed = example.seed.camera_from_station;
  loaded->uncertainty = example.problem().uncertainty;
  loaded->camera_from_station_truth = example.truth.camera_from_station;
  return loaded;
}

}  // namespace boresight::test
