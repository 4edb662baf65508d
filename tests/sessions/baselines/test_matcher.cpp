// SPDX-License-Identifier: Apache-2.0
// A matcher to test with: what it does is its first argument.
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace {

struct Images {
  int request = 0;
  int most = 0;
  int width[2] = {0, 0}, height[2] = {0, 0};
  std::vector<std::uint8_t> pixels[2];
};

/// The number after the first `name` at or after a place, which moves behind the name.
int numberAfter(const std::string& text, const char* name, std::size_t& from) {
  from = text.find(name, from);
  if (from == std::string::npos) std::exit(5);
  from += std::strlen(name);
  return std::atoi(text.c_str() + text.find(':', from) + 1);
}

bool readRequest(Images& images) {
  std::string line;
  for (int c; (c = std::getchar()) != '\n'; line.push_back(static_cast<char>(c)))
    if (c == EOF) return false;
  std::size_t start = 0;
  images.request = numberAfter(line, "\"request\"", start);
  start = 0;
  images.most = numberAfter(line, "\"most\"", start);
  std::size_t at_width = line.find("\"images\""), at_height = at_width;
  for (int i = 0; i < 2; ++i) {
    images.width[i] = numberAfter(line, "\"width\"", at_width);
    images.height[i] = numberAfter(line, "\"height\"", at_height);
  }
  for (int i = 0; i < 2; ++i) {
    images.pixels[i].resize(static_cast<std::size_t>(images.width[i]) *
                            static_cast<std::size_t>(images.height[i]));
    if (std::fread(images.pixels[i].data(), 1, images.pixels[i].size(), stdin) !=
        images.pixels[i].size())
      return false;
  }
  return true;
}

/// Every 16th pixel of the first image that is not 0, at the same place plus a shift.
std::vector<float> shifted(const Images& images, int dx, int dy) {
  std::vector<float> pairs;
  for (int y = 8; y < images.height[0]; y += 16) {
    for (int x = 8; x < images.width[0]; x += 16) {
      const bool fits =
          x + dx >= 0 && y + dy >= 0 && x + dx < images.width[1] && y + dy < images.height[1];
      if (!fits || images.pixels[0][static_cast<std::size_t>(y * images.width[0] + x)] == 0)
        continue;
      if (static_cast<int>(pairs.size()) / 5 >= images.most) return pairs;
      for (const int value : {x, y, x + dx, y + dy}) pairs.push_back(static_cast<float>(value));
      pairs.push_back(0.5F);
    }
  }
  return pairs;
}

void answer(int request, long long count, const std::vector<float>& pairs) {
  std::printf("{\"request\": %d, \"matches\": %lld}\n", request, count);
  std::fwrite(pairs.data(), sizeof(float), pairs.size(), stdout);
  std::fflush(stdout);
}

void act(const std::string& what, const Images& images, int dx, int dy) {
  std::vector<float> pairs = shifted(images, dx, dy);
  const auto count = static_cast<long long>(pairs.size() / 5);
  if (what == "shift") return answer(images.request, count, pairs);
  if (what == "die") {
    std::fputs("first line\nout of paper\n", stderr);
    std::exit(3);
  }
  if (what == "crash") std::abort();
  if (what == "hang") pause();
  if (what == "half") {
    pairs.resize(pairs.size() / 2);
    return answer(images.request, count, pairs);
  }
  if (what == "many") return answer(images.request, 1000000000000LL, pairs);
  if (what == "other") return answer(images.request + 7, count, pairs);
  if (what == "nan" || what == "outside") {
    pairs.assign(5, 0.5F);
    pairs[2] = what == "nan" ? std::numeric_limits<float>::quiet_NaN() : 1e9F;
    return answer(images.request, 1, pairs);
  }
  if (what == "refuse")
    std::printf("{\"request\": %d, \"error\": \"too dark\"}\n", images.request);
  else if (what == "endless")
    for (int i = 0; i < 200000; ++i) std::putchar('x');
  else
    std::puts("I do not speak JSON");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "shift";
  if (what == "mute") pause();
  if (what == "stranger") {
    std::puts("Welcome to the matcher!");
  } else {
    std::printf(
        "{\"protocol\": \"boresight-matcher\", \"version\": %d, \"name\": \"test\", "
        "\"width\": 160, \"height\": 120}\n",
        what == "future" ? 2 : 1);
  }
  std::fflush(stdout);
  Images images;
  const int dx = argc > 2 ? std::atoi(argv[2]) : 0, dy = argc > 3 ? std::atoi(argv[3]) : 0;
  while (readRequest(images)) act(what, images, dx, dy);
  return 0;
}
