// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <gtest/gtest.h>

/// Whether stated sigmas hold the share of errors that they should.
namespace boresight::test {

/// Share of Gaussian errors within 1, 2 and 3 sigma.
inline constexpr std::array<double, 3> kGaussianShare = {0.682689, 0.954500, 0.997300};

/// Share of the errors (in units of their stated sigma) within 1, 2 and 3 sigma.
inline std::array<double, 3> shareWithinSigmas(std::span<const double> errors_in_sigmas) {
  std::array<double, 3> share{};
  for (std::size_t i = 0; i < share.size(); ++i)
    share[i] = static_cast<double>(std::ranges::count_if(
                   errors_in_sigmas,
                   [&](double error) { return std::abs(error) < static_cast<double>(i + 1); })) /
               static_cast<double>(errors_in_sigmas.size());
  return share;
}

/// Fails where 1, 2 or 3 sigma hold fewer errors than of a Gaussian, beyond four standard
/// deviations of the binomial distribution; without `conservative` also where they hold more.
inline void expectGaussianCoverage(std::span<const double> errors_in_sigmas,
                                   bool conservative = false) {
  const std::array<double, 3> share = shareWithinSigmas(errors_in_sigmas);
  for (std::size_t i = 0; i < share.size(); ++i) {
    const double expected = kGaussianShare[i];
    const double bound =
        4.0 * std::sqrt(expected * (1.0 - expected) / static_cast<double>(errors_in_sigmas.size()));
    EXPECT_GE(share[i], expected - bound) << i + 1 << " sigma";
    if (!conservative) {
      EXPECT_LE(share[i], expected + bound) << i + 1 << " sigma";
    }
  }
}

}  // namespace boresight::test
