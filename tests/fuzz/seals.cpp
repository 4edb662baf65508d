// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/seals.h"

#include <algorithm>
#include <span>
#include <string>

#include "core/base/crc32.h"
#include "core/base/digest.h"
#include "sessions/io/file_bytes.h"

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
  const auto end = std::find(bytes.begin(), bytes.end(), '\n');
  if (end == bytes.end()) return;
  const std::string sum = sessions::sha256Text(std::span(end + 1, bytes.end()));
  bytes.erase(bytes.begin(), end);
  bytes.insert(bytes.begin(), sum.begin(), sum.end());
}

}  // namespace boresight::test
