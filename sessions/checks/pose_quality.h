// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sessions/checks/review_subject.h"
#include "sessions/decision/check.h"

namespace boresight::sessions {

/// "0.37 of 0.40 mm": two digits of the limit, more where the two numbers would read alike.
std::string ofLimitText(double found, double limit, const std::string& unit);

/// Standard deviation of a pose in one of the terms of a requirement.
struct PrecisionFigure {
  CheckName check;                 ///< the check that judges it
  const char* where = "";          ///< "across the view axis"
  const char* unit = "";           ///< of the next three
  std::optional<double> required;  ///< empty: the requirement does not limit it
  std::optional<double> found;     ///< by all causes together; empty without a covariance
  std::optional<double> by_image;  ///< by the image, or the annotations, alone
  std::string place;               ///< " at the end effector"; "" where it is the same everywhere

  bool judged() const { return required && found; }
  bool holds() const { return judged() && *found <= *required; }
  /// ofLimitText(); only when judged().
  std::string text() const { return ofLimitText(*found, *required, unit); }
};

/// A pose's quality: the standard deviations that the requirement limits, including mesh scale and
/// calibration, at the end effector, or at the camera if that is not known.
struct PoseQuality {
  double sigmas = 3.0;                   ///< number of standard deviations that each figure is
  std::vector<PrecisionFigure> figures;  ///< always the same four, in the order of the checks

  /// The judged figure that takes the largest share of its limit; nullptr: none is judged.
  const PrecisionFigure* worst() const;
  /// Whether all limited figures are known and within their limits, and at least one is limited.
  bool holds() const;
  /// "3 sigma"
  std::string sigmasText() const;
  /// "0.37 of 0.40 mm (3 sigma across the view axis at the end effector)"; otherwise the reason why
  /// there is no figure.
  std::string text() const;
};

PoseQuality poseQuality(const ReviewSubject& subject, double sigmas);

/// Why annotations with these degrees of freedom do not show whether they are as accurate as their
/// sigmas state, and what to do: a sentence; "" for 6 and more.
std::string unconfirmedSigmasText(int degrees_of_freedom);

/// Quality of a run's pose with the session's limits; `loaded` is the case that ran.
PoseQuality runQuality(const Session& session, const std::shared_ptr<const LoadedCase>& loaded,
                       const LocalizationTrace& run);

}  // namespace boresight::sessions
