// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/bytes.h"
#include "core/localizer/localizer.h"
#include "core/record/record_format.h"

namespace boresight {

/// SHA-256 of a run's inputs, computed by the caller.
struct RecordInputs {
  using Hash = std::array<std::uint8_t, 32>;  ///< SHA-256
  Hash pixels{};  ///< the decoded 8-bit pixels that the core saw, row by row
  Hash ignore{};  ///< of the mask's words; zeros without a mask
  Hash scene{};   ///< of the parts, vertices and faces
  Hash camera{};  ///< of its canonical bytes
};

/// Writes the onboard record of a run into the caller's memory, without allocation:
///
///     RecordWriter record(bytes);
///     record.begin(inputs, problem, options);
///     while (!finished) { report = localizer.step(); record.note(localizer, report); }
///     record.end(localizer);
///     downlink(record.bytes());
///
/// A block that does not fit is left out, and a reader detects the gap; room for the end block is
/// reserved. A default run of the shipped example takes 8 kB.
class RecordWriter {
 public:
  /// `out` must outlive the writer. With fewer than kMinimumBytes, bytes() stays empty.
  explicit RecordWriter(std::span<std::uint8_t> out);
  /// Bytes of an empty record.
  static constexpr std::size_t kMinimumBytes = kRecordHeaderBytes + kBlockBytes + kEndBytes;

  /// Writes the inputs of the run, before the first step.
  void begin(const RecordInputs& inputs, const LocalizationProblem& problem,
             const LocalizerOptions& options);
  /// Writes the options that hold from the next iteration on (Localizer::changeOptions).
  void changeOptions(const LocalizerOptions& options, std::int32_t first_iteration);
  /// Writes the results of a step; call after every step.
  void note(const Localizer& localizer, const StepReport& report);
  void end(const Localizer& localizer);  ///< Writes how the run ended, after the last step

  /// The bytes written: a whole record after end().
  std::span<const std::uint8_t> bytes() const { return out_.first(used_); }
  /// Whether every block has fitted.
  bool complete() const { return complete_; }

 private:
  template <class Fill>
  void add(RecordBlock type, const Fill& fill);

  std::span<std::uint8_t> out_;
  std::size_t used_ = 0;
  std::size_t kept_free_ = kBlockBytes + kEndBytes;
  std::uint32_t blocks_ = 0;  ///< including blocks that did not fit
  std::int32_t iterations_ = 0;
  bool complete_ = true;
};

}  // namespace boresight
