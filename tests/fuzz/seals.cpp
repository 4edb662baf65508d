// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/seals.h"

#include <algorithm>
#include <cstdio>
#include <span>
#include <string>

#include "core/base/crc32.h"
#include "core/base/digest.h"

namespace boresight::test {
namespace {

void putBigEndian(std::uint64_t value, std::span<std::uint8_t> to) {
  for (std::size_t i = to.size(); i-- > 0; value >>= 8) to[i] = static_cast<std::uint8_t>(value);
}

std::uint64_t bigEndian(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

}  // namespace

void sealTrace(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kHeader = 20, kSum = 32;
  if (bytes.size() < kHeader + kSum) return;
  const std::span<std::uint8_t> all(bytes);
  putBigEndian(bytes.size() - kHeader - kSum, all.subspan(12, 8));
  Sha256 sha;
  sha.update(all.first(bytes.size() - kSum));
  const auto sum = sha.digest();
  std::copy(sum.begin(), sum.end(), bytes.end() - static_cast<std::ptrdiff_t>(kSum));
}

void sealRecord(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kHeader = 12, kBlockHeader = 12, kSum = 4;
  std::span<std::uint8_t> left(bytes);
  if (left.size() < kHeader) return;
  left = left.subspan(kHeader);
  while (left.size() >= kBlockHeader + kSum) {
    const std::uint64_t content = bigEndian(left.subspan(8, 4));
    if (content > left.size() - kBlockHeader - kSum) return;
    const std::size_t length = kBlockHeader + static_cast<std::size_t>(content);
    putBigEndian(crc32(left.first(length)), left.subspan(length, kSum));
    left = left.subspan(length + kSum);
  }
}

void sealJournal(std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kSum = 8;
  std::string before;
  for (auto line = bytes.begin(); line != bytes.end();) {
    const auto end = std::find(line, bytes.end(), '\n');
    if (end - line > static_cast<std::ptrdiff_t>(kSum)) {
      std::string summed = before;
      summed.append(line + kSum + 1, end);
      char sum[kSum + 1];
      std::snprintf(sum, sizeof(sum), "%08x",
                    crc32({reinterpret_cast<const std::uint8_t*>(summed.data()), summed.size()}));
      std::copy_n(sum, kSum, line);
      before = sum;
    }
    line = end == bytes.end() ? end : end + 1;
  }
}

}  // namespace boresight::test
