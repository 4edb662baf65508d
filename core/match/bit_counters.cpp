// SPDX-License-Identifier: Apache-2.0
#include "core/match/bit_counters.h"

#include "core/match/bit_kernels.h"

namespace boresight {
namespace {

using kernels::Word1;
#if defined(__GNUC__) && defined(__SSE2__)
using WideWord = kernels::Word2;
#else
using WideWord = Word1;
#endif
constexpr int kWide = kernels::kWordsIn<WideWord>;

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

}  // namespace

void addPixels(const std::uint8_t* base, const PixelList& pixels, int words, CounterRow& total) {
  // From right to left, as each word takes bits from the one to its right.
  Word1 right[kMaxPlanes] = {};
  int word = (words + kWide - 1) / kWide * kWide;
  while (word > 0) kernels::addPixelsAt<WideWord>(base, pixels, word -= kWide, right, total);
}

void countSignedPixels(const std::uint8_t* base, const SignedPixel* pixels, int count, int words,
                       CounterRow& counters) {
  int word = 0;
  for (; word + kWide <= words; word += kWide) {
    kernels::countSignedPixelsAt<WideWord>(base, pixels, count, word, counters);
  }
  for (; word < words; ++word) {
    kernels::countSignedPixelsAt<Word1>(base, pixels, count, word, counters);
  }
}

void planesToLanes(const CounterRow& counters, int words, std::uint16_t* lanes) {
  int word = 0;
  for (; word + kWide <= words; word += kWide) {
    wordsToLanes<WideWord>(counters, word, lanes + lanesBefore(word));
  }
  for (; word < words; ++word) wordsToLanes<Word1>(counters, word, lanes + lanesBefore(word));
}

void planesToPrefixSums(const CounterRow& counters, int words, std::uint16_t* lanes,
                        std::uint32_t* totals) {
  int word = 0;
  for (; word + kWide <= words; word += kWide) {
    wordsToPrefixSums<WideWord>(counters, word, lanes + lanesBefore(word), totals + word);
  }
  for (; word < words; ++word) {
    wordsToPrefixSums<Word1>(counters, word, lanes + lanesBefore(word), totals + word);
  }
}

void wordToLanes(const CounterRow& counters, int word, std::uint16_t* lanes) {
  wordsToLanes<Word1>(counters, word, lanes);
}

}  // namespace boresight
