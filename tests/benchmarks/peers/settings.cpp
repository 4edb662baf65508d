// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/settings.h"

#include <stdexcept>

namespace boresight::peers {

double Settings::value(const std::string& name) const {
  for (const Setting& setting : settings_)
    if (setting.name == name) return setting.value;
  throw std::out_of_range("no setting " + name);
}

void Settings::take(const std::map<std::string, double>& values) {
  for (Setting& setting : settings_)
    if (const auto found = values.find(setting.name); found != values.end())
      setting.value = found->second;
}

}  // namespace boresight::peers
