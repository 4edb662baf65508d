// SPDX-License-Identifier: Apache-2.0
#include "core/edges/hysteresis.h"

#include <algorithm>

#include "core/base/nth.h"

namespace boresight {
namespace {

/// Word w of `row` (nullptr: outside the image) spread by one pixel to both sides.
std::uint64_t spreadWord(const std::uint64_t* row, int w, int words) {
  if (row == nullptr) return 0;
  const std::uint64_t before = w > 0 ? row[w - 1] >> 63 : 0;
  const std::uint64_t after = w + 1 < words ? row[w + 1] << 63 : 0;
  return row[w] | (row[w] << 1) | (row[w] >> 1) | before | after;
}

/// Fills the runs of `open` from `seeds` (a subset) towards higher bits: adding a seed to its run
/// carries through to the run's end. `carry` (0 or 1) seeds bit 0.
std::uint64_t fillUp(std::uint64_t open, std::uint64_t seeds, std::uint64_t carry) {
  return seeds | (open & ~(open + seeds + carry));
}

/// Towards lower bits there is no carry: the reach doubles six times.
std::uint64_t fillDown(std::uint64_t open, std::uint64_t seeds) {
  for (int shift = 1; shift < 64; shift *= 2) {
    seeds |= open & (seeds >> shift);
    open &= open >> shift;
  }
  return seeds;
}

}  // namespace

void Hysteresis::begin(int width, int height, Arena& arena) {
  *this = Hysteresis();
  words_per_row_ = BitImage::wordsPerRow(width);
  height_ = height;
  open_rows_ = height;
  first_ = arena.allocate<std::int32_t>(height);
  last_ = arena.allocate<std::int32_t>(height);
  for (std::int32_t& word : last_) word = words_per_row_ - 1;
}

bool Hysteresis::step(std::int32_t word_budget, const BitImage& candidates, BitImage& edges) {
  while (open_rows_ > 0 && word_budget > 0) {
    word_budget -= 1 + floodRow(y_, candidates, edges);
    y_ += direction_;
    if (y_ == height_ || y_ < 0) {
      direction_ = -direction_;
      y_ += direction_;
    }
  }
  return open_rows_ == 0;
}

void Hysteresis::touch(int y, int first_word, int last_word) {
  if (y < 0 || y >= height_) return;
  std::int32_t& first = nth(first_, y);
  std::int32_t& last = nth(last_, y);
  if (first > last) {
    ++open_rows_;
    first = words_per_row_;
    last = -1;
  }
  first = std::min(first, std::max(first_word - 1, 0));
  last = std::max(last, std::min(last_word + 1, words_per_row_ - 1));
}

/// Brings the open words of row y, and the runs that leave them, to completion; returns the number
/// of words visited.
std::int32_t Hysteresis::floodRow(int y, const BitImage& candidates, BitImage& edges) {
  const int first = nth(first_, y);
  const int last = nth(last_, y);
  if (first > last) return 0;
  nth(first_, y) = words_per_row_;
  nth(last_, y) = -1;
  --open_rows_;
  const std::uint64_t* open = candidates.row(y);
  const std::uint64_t* above = y > 0 ? edges.row(y - 1) : nullptr;
  const std::uint64_t* below = y + 1 < height_ ? edges.row(y + 1) : nullptr;
  std::uint64_t* row = edges.row(y);
  int changed_first = words_per_row_;
  int changed_last = -1;

  int w = first;
  std::uint64_t carry = 0;  // runs into the first word were handled when their own word changed
  for (; w < words_per_row_ && (w <= last || carry != 0); ++w) {
    if ((open[w] & ~row[w]) != 0) {
      std::uint64_t seeds =
          row[w] |
          (open[w] & (spreadWord(above, w, words_per_row_) | spreadWord(below, w, words_per_row_)));
      if (w + 1 < words_per_row_) seeds |= open[w] & (row[w + 1] << 63);
      if ((seeds | carry) != 0) seeds = fillDown(open[w], fillUp(open[w], seeds, carry));
      if (seeds != row[w]) {
        row[w] = seeds;
        changed_first = std::min(changed_first, w);
        changed_last = w;
      }
    }
    carry = row[w] >> 63;
  }
  const std::int32_t visited = w - first;
  // Runs that reach the lower end of a word continue in the word before.
  for (w = changed_last - 1; w >= 0; --w) {
    const std::uint64_t seed = open[w] & ~row[w] & (row[w + 1] << 63);
    if (seed == 0 && w < changed_first) break;
    if (seed == 0) continue;
    row[w] = fillDown(open[w], row[w] | seed);
    changed_first = std::min(changed_first, w);
  }
  if (changed_last < 0) return visited;
  touch(y - 1, changed_first, changed_last);
  touch(y + 1, changed_first, changed_last);
  return visited + changed_last - changed_first;
}

}  // namespace boresight
