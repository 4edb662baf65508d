// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/base/status.h"

namespace boresight {

/// Metadata of one option; declared once, in the `visitFields` of its struct, and used by
/// validation, the session file, the command line, the panel and the digest.
///
/// An options struct declares
///     template <class Self, class Visitor>
///     static void visitFields(Self& self, Visitor&& visit) {
///       visit(OptionInfo{"canny.gaussian_sigma_px", "px", 0.0, 10.0, "Smoothing before Canny."},
///             self.gaussian_sigma_px);
///     }
/// with fields of type bool, std::int32_t, std::int64_t, double, or an enum with a `std::int32_t`
/// underlying type whose `choices` name the values 0, 1, 2, ...
struct OptionInfo {
  const char* name;                           ///< stage.name_unit, unique in the program
  const char* unit;                           ///< "" where it has none
  double minimum;                             ///< least value allowed
  double maximum;                             ///< largest value allowed
  const char* help;                           ///< one sentence
  std::span<const char* const> choices = {};  ///< names of an enum's values
};

/// The first option outside its range, or nullptr. NaN is outside every range.
template <class Options>
const char* firstInvalidOption(const Options& options) {
  const char* invalid = nullptr;
  Options::visitFields(options, [&invalid](const OptionInfo& info, const auto& field) {
    const double value = static_cast<double>(field);
    if (invalid == nullptr && !(value >= info.minimum && value <= info.maximum))
      invalid = info.name;
  });
  return invalid;
}

}  // namespace boresight
