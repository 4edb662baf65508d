// SPDX-License-Identifier: Apache-2.0
// Every reader, with the corpus and with files that are nearly like it: what is wrong is said by an
// InputError, and by nothing else. The long runs are libFuzzer's (README.md).
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "tests/fuzz/readers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kMostMutatedBytes = 1 << 20;

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

/// Some changes, the same for the same generator: bits and bytes, pieces left out, doubled and
/// moved, the end cut off, numbers of a text made strange.
Bytes mutated(Bytes bytes, Random& random) {
  using Change = void (*)(Bytes&, Random&);
  constexpr Change kChanges[] = {flip, set,         leaveOut,    repeat,
                                 cut,  makeStrange, makeStrange, setCount};
  const std::uint32_t changes = 1 + random.below(4);
  for (std::uint32_t i = 0; i < changes; ++i) kChanges[random.below(8)](bytes, random);
  if (bytes.size() > kMostMutatedBytes) bytes.resize(kMostMutatedBytes);
  return bytes;
}

constexpr std::size_t kMostBytes = 1 << 22;

/// BORESIGHT_MUTANTS asks for more.
int mutantCount() {
  const char* wanted = std::getenv("BORESIGHT_MUTANTS");
  return wanted != nullptr ? std::atoi(wanted) : 150;
}

std::vector<Bytes> corpusOf(std::string_view name) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(BORESIGHT_CORPUS) / name))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Bytes> corpus;
  for (const auto& file : files) corpus.push_back(sessions::readFileBytes(file, kMostBytes));
  return corpus;
}

class Readers : public testing::TestWithParam<FuzzedReader> {};

TEST_P(Readers, SayWhatIsWrongWithEveryMutantAndNothingElse) {
  const TemporaryFolder folder;
  Random random(GetParam().name.size());
  const std::vector<Bytes> corpus = corpusOf(GetParam().name);
  ASSERT_FALSE(corpus.empty());
  // A corpus that nothing can be read of tests the first line of a reader at most.
  const auto first = folder.write(GetParam().file_name, corpus.front());
  EXPECT_NO_THROW(GetParam().read(first));
  ASSERT_NO_THROW(feed(GetParam(), {}, folder.path())) << "of an empty file";
  const int count = mutantCount();
  for (int i = 0; i < count; ++i) {
    const Bytes& seed = corpus[random.below(static_cast<std::uint32_t>(corpus.size()))];
    const Bytes bytes = mutated(seed, random);
    SCOPED_TRACE(i);
    ASSERT_NO_THROW(feed(GetParam(), bytes, folder.path()));
  }
}

/// A seal that were wrong would keep all mutants out.
TEST(Seals, ValidFiles_KeepTheirChecksums) {
  int sealed = 0;
  for (const FuzzedReader& reader : fuzzedReaders()) {
    if (reader.seal == nullptr) continue;
    ++sealed;
    for (const Bytes& bytes : corpusOf(reader.name)) {
      Bytes result = bytes;
      reader.seal(result);
      EXPECT_EQ(result, bytes) << reader.name;
    }
  }
  EXPECT_EQ(sealed, 3);
}

INSTANTIATE_TEST_SUITE_P(All, Readers,
                         testing::ValuesIn(fuzzedReaders().begin(), fuzzedReaders().end()),
                         [](const auto& result) { return std::string(result.param.name); });

}  // namespace
}  // namespace boresight::test
