// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "sessions/evaluation/bop_dataset.h"

namespace boresight::app {

/// What --dataset names: a dataset.json, or a BOP folder with what is chosen of it.
struct DatasetArguments {
  std::string path;
  std::string split;
  std::string sensor;
  std::vector<int> scenes;
  std::vector<int> objects;
  std::vector<double> uncertainty;
  std::string pivot;
  bool every_instance = false;

  /// --split, --scene, --obj, --sensor, --every-instance, --uncertainty and --pivot. The path's own
  /// option is the caller's.
  void addTo(CLI::App& command);
  /// InputError; CLI::ValidationError when a choice is given for what is no folder.
  sessions::Dataset open() const;

 private:
  bool chooses() const;
  sessions::BopSelection selection() const;
};

}  // namespace boresight::app
