// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

namespace boresight::peers {

/// A number that a peer can be tuned by.
struct Setting {
  std::string name;  ///< "visp.mask_px"
  double value = 0.0;
  std::string help;  ///< with its unit
};

/// The settings of one peer.
class Settings {
 public:
  explicit Settings(std::vector<Setting> settings) : settings_(std::move(settings)) {}

  const std::vector<Setting>& all() const { return settings_; }
  /// Of one that exists; std::out_of_range otherwise.
  double value(const std::string& name) const;
  int whole(const std::string& name) const { return static_cast<int>(value(name)); }
  /// Takes over what of `values` is this peer's.
  void take(const std::map<std::string, double>& values);

 private:
  std::vector<Setting> settings_;
};

}  // namespace boresight::peers
