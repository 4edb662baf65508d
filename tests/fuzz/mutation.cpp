// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/mutation.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace boresight::test {
namespace {

constexpr std::size_t kMostBytes = 1 << 20;

constexpr std::array<std::string_view, 18> kStrange = {
    "0",      "-1",          "1e999",      "-1e999",
    "1e-320", "NaN",         "4294967296", "18446744073709551616",
    "null",   "true",        "[]",         "{}",
    "\"\"",   "\"\\u0000\"", "[[[[",       "2147483648",
    "0.5",    "99999999"};

std::size_t placeIn(const Bytes& bytes, Random& random) {
  return bytes.empty() ? 0 : random.below(static_cast<std::uint32_t>(bytes.size()));
}

using Place = Bytes::difference_type;

Place at(std::size_t index) { return static_cast<Place>(index); }

void flip(Bytes& bytes, Random& random) {
  if (!bytes.empty())
    bytes[placeIn(bytes, random)] ^= static_cast<std::uint8_t>(1u << random.below(8));
}

void set(Bytes& bytes, Random& random) {
  if (!bytes.empty()) bytes[placeIn(bytes, random)] = static_cast<std::uint8_t>(random.below(256));
}

/// Takes up to 64 bytes out.
void leaveOut(Bytes& bytes, Random& random) {
  const std::size_t first = placeIn(bytes, random);
  const std::size_t last = std::min(bytes.size(), first + 1 + random.below(64));
  if (first < last) bytes.erase(bytes.begin() + at(first), bytes.begin() + at(last));
}

/// Puts a piece in once more, somewhere.
void repeat(Bytes& bytes, Random& random) {
  const std::size_t first = placeIn(bytes, random);
  const std::size_t last = std::min(bytes.size(), first + 1 + random.below(64));
  const Bytes piece(bytes.begin() + at(first), bytes.begin() + at(last));
  bytes.insert(bytes.begin() + at(placeIn(bytes, random)), piece.begin(), piece.end());
}

void cut(Bytes& bytes, Random& random) { bytes.resize(placeIn(bytes, random)); }

bool isOfNumber(std::uint8_t byte) {
  return (byte >= '0' && byte <= '9') || byte == '-' || byte == '+' || byte == '.' || byte == 'e';
}

/// A number of a text becomes another one, or no number.
void makeStrange(Bytes& bytes, Random& random) {
  auto first = std::find_if(bytes.begin() + at(placeIn(bytes, random)), bytes.end(), isOfNumber);
  while (first != bytes.begin() && isOfNumber(*(first - 1))) --first;
  const auto last = std::find_if_not(first, bytes.end(), isOfNumber);
  const std::string_view strange = kStrange[random.below(kStrange.size())];
  const auto place = bytes.erase(first, last);
  bytes.insert(place, strange.begin(), strange.end());
}

/// Four bytes become a count that is at the end of some range.
void setCount(Bytes& bytes, Random& random) {
  constexpr std::uint8_t kPatterns[4][4] = {
      {0xff, 0xff, 0xff, 0xff}, {0x7f, 0xff, 0xff, 0xff}, {0, 0, 0, 0}, {0, 0, 1, 0}};
  if (bytes.size() < 4) return;
  const std::size_t first = random.below(static_cast<std::uint32_t>(bytes.size() - 3));
  std::copy_n(kPatterns[random.below(4)], 4, bytes.begin() + at(first));
}

}  // namespace

Bytes mutated(Bytes bytes, Random& random) {
  using Change = void (*)(Bytes&, Random&);
  constexpr Change kChanges[] = {flip, set,         leaveOut,    repeat,
                                 cut,  makeStrange, makeStrange, setCount};
  const std::uint32_t changes = 1 + random.below(4);
  for (std::uint32_t i = 0; i < changes; ++i) kChanges[random.below(8)](bytes, random);
  if (bytes.size() > kMostBytes) bytes.resize(kMostBytes);
  return bytes;
}

}  // namespace boresight::test
