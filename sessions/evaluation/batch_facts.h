// SPDX-License-Identifier: Apache-2.0
// Dataset, methods and processes of the runs in a results file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/localizer/localizer_options.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/json/option_value.h"

namespace boresight::sessions {

/// The dataset and the program version that all runs of a results file share.
struct DatasetFacts {
  std::string dataset;         ///< dataset.json, or the folder of a BOP dataset; absolute
  std::string dataset_sha256;  ///< Dataset::sha256
  std::int64_t cases = 0;
  std::string version;  ///< of the program
};

/// Settings that all runs of one method in a results file share.
struct MethodFacts {
  std::string method;
  std::string profile;
  std::string options;         ///< JSON: differences from the profile
  std::string options_sha256;  ///< optionsDigest over all of them
  double reseed_scale = 1.0;
  std::string mesh_of;  ///< deliberately wrong meshes: another station's,
  std::string mirror;   ///< or mirrored across this axis; empty: correct meshes
  std::string note;     ///< display text, e.g. the network that was used

  bool wrongMesh() const { return !mesh_of.empty() || !mirror.empty(); }
};

/// One process that ran cases into a results file.
struct BatchRun {
  std::string began;  ///< UTC
  std::string ended;  ///< UTC; empty while it runs, and when it was killed
  std::string version;
  std::string machine;    ///< name
  std::string processor;  ///< model and number
  std::string system;
  std::string command;
  std::string folder;  ///< in which the command was given
  std::int64_t jobs = 1;
  std::int64_t threads = 1;  ///< of each run
  std::string kernels;
  std::string shard;  ///< "2/8", or empty
  std::int64_t reseeds = 0;
  std::int64_t runs = 0;  ///< that it added
  double seconds = 0.0;   ///< of wall time, up to its last run
};

/// Facts of `method`, `profile` and `options`; deliberately wrong meshes and note stay unset.
MethodFacts methodFacts(const std::string& method, const std::string& profile,
                        const LocalizerOptions& options);

/// Adds options of the method itself that differ from its defaults.
void addMethodOptions(const OptionList& changed, MethodFacts& facts);

DatasetFacts datasetFacts(const Dataset& dataset);

/// Why runs with `given` cannot be added to those with `held`: one readable clause ("its runs are
/// of another dataset, ..."); empty when they can.
std::optional<std::string> contradiction(const DatasetFacts& held, const DatasetFacts& given);
std::optional<std::string> contradiction(const MethodFacts& held, const MethodFacts& given);

/// Name, processor and system of this machine, as far as known; the caller sets the rest.
BatchRun thisBatchRun();

}  // namespace boresight::sessions
