// SPDX-License-Identifier: Apache-2.0
#include "app/flight/pgm_file.h"

namespace boresight::flight {
namespace {

constexpr int kLargestNumber = 1 << 20;

bool isSpace(int c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The next decimal number and the one character behind it; -1 when there is none.
int readNumber(std::FILE* stream) {
  int c = std::fgetc(stream);
  while (isSpace(c) || c == '#') {
    if (c == '#')
      while (c != '\n' && c != EOF) c = std::fgetc(stream);
    c = std::fgetc(stream);
  }
  if (c < '0' || c > '9') return -1;
  int number = 0;
  for (; c >= '0' && c <= '9'; c = std::fgetc(stream)) {
    number = 10 * number + (c - '0');
    if (number > kLargestNumber) return -1;
  }
  return isSpace(c) ? number : -1;
}

}  // namespace

const char* readPgmHeader(std::FILE* stream, int& width, int& height) {
  if (std::fgetc(stream) != 'P' || std::fgetc(stream) != '5')
    return "not a binary PGM (P5) image; write it with whs problem --image-out";
  width = readNumber(stream);
  height = readNumber(stream);
  const int largest = readNumber(stream);
  if (width <= 0 || height <= 0) return "its header gives no width and height";
  if (largest != 255) return "its largest value is not 255; pixels must be of 8 bits";
  return nullptr;
}

const char* readPgmPixels(std::FILE* stream, std::span<std::uint8_t> pixels) {
  if (std::fread(pixels.data(), 1, pixels.size(), stream) != pixels.size())
    return "cut short: fewer pixels than its header says";
  if (std::fgetc(stream) != EOF) return "more bytes than its header says";
  return nullptr;
}

}  // namespace boresight::flight
