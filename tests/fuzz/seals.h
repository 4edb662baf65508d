// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace boresight::test {

// Make the checksums of a file right again, so that what was changed in it gets behind them. Bytes
// that are too few for the format stay as they are.
void sealTrace(std::vector<std::uint8_t>& bytes);   ///< length and SHA-256 of a trace
void sealRecord(std::vector<std::uint8_t>& bytes);  ///< the CRC of every block of an onboard record
void sealJournal(std::vector<std::uint8_t>& bytes);  ///< the SHA-256 of a journal

}  // namespace boresight::test
