// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace boresight {

/// PCG-XSH-RR 64/32 (O'Neill 2014): small, the same numbers on every machine. The standard
/// library's distributions differ between implementations and are not used.
class Random {
 public:
  /// Streams of the same seed are independent of each other.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint32_t next();  ///< Uniform in 0 ... 2^32 - 1.
  /// Uniform in 0 .. bound - 1, without bias (bounded rejection); bound >= 1.
  std::uint32_t below(std::uint32_t bound);
  /// Uniform in [0, 1), 53 bits.
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high);
  /// Standard normal variate, from + - * / and sqrt only (for tests and reseeding).
  double normal();

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_ = 0;
};

}  // namespace boresight
