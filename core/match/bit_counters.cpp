// SPDX-License-Identifier: Apache-2.0
#include "core/match/bit_counters.h"

#include "core/match/bit_kernels.h"

namespace boresight {
namespace {

using kernels::kWordsIn;
using kernels::Word1;

template <class Word>
void wordsToLanes(const CounterRow& counters, int word, std::uint16_t* lanes) {
  Word lane_words[kernels::kLaneWords];
  kernels::planesToLanesAt(counters, word, lane_words);
  kernels::storeLanes(lane_words, lanes);
}

template <class Word>
void wordsToPrefixSums(const CounterRow& counters, int word, std::uint16_t* lanes,
                       std::uint32_t* totals) {
  Word lane_words[kernels::kLaneWords];
  kernels::planesToLanesAt(counters, word, lane_words);
  kernels::addUpLanes(lane_words, totals);
  kernels::storeLanes(lane_words, lanes);
}

template <class Word>
void addPixels(const std::uint8_t* base, const PixelList& pixels, int words, CounterRow& total) {
  // From right to left, as each word takes bits from the one to its right.
  Word1 right[kMaxPlanes] = {};
  int word = (words + kWordsIn<Word> - 1) / kWordsIn<Word> * kWordsIn<Word>;
  while (word > 0) {
    kernels::addPixelsAt<Word>(base, pixels, word -= kWordsIn<Word>, right, total);
  }
}

template <class Word>
void countSignedPixels(const std::uint8_t* base, const SignedPixel* pixels, int count, int words,
                       CounterRow& counters) {
  int word = 0;
  for (; word + kWordsIn<Word> <= words; word += kWordsIn<Word>) {
    kernels::countSignedPixelsAt<Word>(base, pixels, count, word, counters);
  }
  for (; word < words; ++word) {
    kernels::countSignedPixelsAt<Word1>(base, pixels, count, word, counters);
  }
}

template <class Word>
void planesToLanes(const CounterRow& counters, int words, std::uint16_t* lanes) {
  int word = 0;
  for (; word + kWordsIn<Word> <= words; word += kWordsIn<Word>) {
    wordsToLanes<Word>(counters, word, lanes + lanesBefore(word));
  }
  for (; word < words; ++word) wordsToLanes<Word1>(counters, word, lanes + lanesBefore(word));
}

template <class Word>
void planesToPrefixSums(const CounterRow& counters, int words, std::uint16_t* lanes,
                        std::uint32_t* totals) {
  int word = 0;
  for (; word + kWordsIn<Word> <= words; word += kWordsIn<Word>) {
    wordsToPrefixSums<Word>(counters, word, lanes + lanesBefore(word), totals + word);
  }
  for (; word < words; ++word) {
    wordsToPrefixSums<Word1>(counters, word, lanes + lanesBefore(word), totals + word);
  }
}

template <class Word>
constexpr BitKernels kBitKernels{addPixels<Word>, countSignedPixels<Word>, planesToLanes<Word>,
                                 planesToPrefixSums<Word>};

}  // namespace

const BitKernels& bitKernels(Kernels set) {
#if defined(__GNUC__) && defined(__SSE2__)
  if (set != Kernels::kPortable) return kBitKernels<kernels::Word2>;
#else
  (void)set;
#endif
  return kBitKernels<Word1>;
}

void wordToLanes(const CounterRow& counters, int word, std::uint16_t* lanes) {
  wordsToLanes<Word1>(counters, word, lanes);
}

}  // namespace boresight
