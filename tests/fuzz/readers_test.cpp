// SPDX-License-Identifier: Apache-2.0
// Every reader, with the corpus and with files that are nearly like it: what is wrong is said by an
// InputError, and by nothing else. The long runs are libFuzzer's (README.md).
#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/readers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

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

class Readers : public testing::TestWithParam<FuzzedReader> {
 protected:
  TemporaryFolder folder_;
};

/// A corpus that nothing can be read of tests the first line of a reader at most.
TEST_P(Readers, ReadTheFirstFileOfTheirCorpus) {
  const std::vector<Bytes> corpus = corpusOf(GetParam().name);
  ASSERT_FALSE(corpus.empty());
  const auto file = folder_ / GetParam().file_name;
  folder_.write(GetParam().file_name,
                {reinterpret_cast<const char*>(corpus.front().data()), corpus.front().size()});
  EXPECT_NO_THROW(GetParam().read(file));
}

TEST_P(Readers, SayWhatIsWrongWithEveryMutantAndNothingElse) {
  Random random(GetParam().name.size());
  const std::vector<Bytes> corpus = corpusOf(GetParam().name);
  const int count = mutantCount();
  for (int i = 0; i < count; ++i) {
    const Bytes& seed = corpus[random.below(static_cast<std::uint32_t>(corpus.size()))];
    const Bytes bytes = mutated(seed, random);
    SCOPED_TRACE(i);
    ASSERT_NO_THROW(feed(GetParam(), bytes, folder_.path()));
  }
}

TEST_P(Readers, RefuseAnEmptyFile) { ASSERT_NO_THROW(feed(GetParam(), {}, folder_.path())); }

/// A seal that were wrong would keep all mutants out.
TEST(Seals, LeaveWholeFilesAsTheyAre) {
  int sealed = 0;
  for (const FuzzedReader& reader : fuzzedReaders()) {
    if (reader.seal == nullptr) continue;
    ++sealed;
    for (const Bytes& bytes : corpusOf(reader.name)) {
      Bytes made = bytes;
      reader.seal(made);
      EXPECT_EQ(made, bytes) << reader.name;
    }
  }
  EXPECT_EQ(sealed, 3);
}

INSTANTIATE_TEST_SUITE_P(All, Readers,
                         testing::ValuesIn(fuzzedReaders().begin(), fuzzedReaders().end()),
                         [](const auto& made) { return std::string(made.param.name); });

}  // namespace
}  // namespace boresight::test
