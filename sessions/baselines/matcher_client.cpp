// SPDX-License-Identifier: Apache-2.0
#include "sessions/baselines/matcher_client.h"

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sessions/io/files/errors.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

constexpr const char* kProtocol = "boresight-matcher";
constexpr int kProtocolVersion = 1;
constexpr std::size_t kMostLineBytes = 65536;
constexpr std::size_t kPairBytes = 5 * 4;
constexpr int kMostSide_px = 32767;

ChildProcess::Clock::time_point deadlineIn(double seconds) {
  return ChildProcess::Clock::now() + std::chrono::milliseconds(std::llround(seconds * 1e3));
}

/// A member that is a whole number in a range, or -1.
int wholeNumber(const json& object, const char* name, int most) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_number_integer()) return -1;
  const auto value = found->get<std::int64_t>();
  return value >= 0 && value <= most ? static_cast<int>(value) : -1;
}

std::string textOf(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? oneLine(found->get<std::string>()) : "";
}

/// A little-endian float32.
double floatAt(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits |= std::uint32_t{bytes[at + i]} << (8 * i);
  return static_cast<double>(std::bit_cast<float>(bits));
}

bool inside(double x, double y, const ImageView& image) {
  return x >= -0.5 && y >= -0.5 && x <= image.width - 0.5 && y <= image.height - 0.5;
}

}  // namespace

void MatcherClient::fail(const std::string& what) const {
  throw MethodError("the matcher (" + oneLine(command_) + ") " + what);
}

MatcherClient::MatcherClient(const std::string& command, double start_timeout_s,
                             const std::stop_token& stop)
    : command_(command) {
  try {
    process_ = std::make_unique<ChildProcess>(command);
    greet(process_->readLine(kMostLineBytes, deadlineIn(start_timeout_s), stop));
  } catch (const ChildError& error) {
    fail(error.what());
  }
}

void MatcherClient::greet(const std::string& line) {
  const json hello = json::parse(line, nullptr, false);
  if (!hello.is_object() || textOf(hello, "protocol") != kProtocol)
    fail("does not speak the protocol: its first line is \"" + oneLine(line).substr(0, 60) + "\"");
  if (wholeNumber(hello, "version", 1000) != kProtocolVersion)
    fail("speaks another version of the protocol than " + std::to_string(kProtocolVersion));
  name_ = textOf(hello, "name");
  width_ = std::max(0, wholeNumber(hello, "width", kMostSide_px));
  height_ = std::max(0, wholeNumber(hello, "height", kMostSide_px));
}

void MatcherClient::send(const ImageView& first, const ImageView& second, int most,
                         ChildProcess::Clock::time_point deadline, const std::stop_token& stop) {
  json request = {{"request", ++request_}, {"most", most}};
  for (const ImageView* image : {&first, &second})
    request["images"].push_back({{"width", image->width}, {"height", image->height}});
  const std::string line = request.dump() + "\n";
  std::vector<std::uint8_t> bytes(line.begin(), line.end());
  for (const ImageView* image : {&first, &second})
    for (int y = 0; y < image->height; ++y)
      bytes.insert(bytes.end(), image->row(y), image->row(y) + image->width);
  process_->write(bytes, deadline, stop);
}

std::size_t MatcherClient::countIn(const std::string& line, int most) const {
  const json answer = json::parse(line, nullptr, false);
  if (!answer.is_object()) fail("answered nonsense: \"" + oneLine(line).substr(0, 60) + "\"");
  if (wholeNumber(answer, "request", request_) != request_)
    fail("answered nonsense: its answer is not to the request at hand");
  const std::string error = textOf(answer, "error");
  if (!error.empty()) fail("could not match: " + error);
  const int count = wholeNumber(answer, "matches", most);
  if (count < 0)
    fail("answered nonsense: \"matches\" is not a whole number of at most " + std::to_string(most));
  return static_cast<std::size_t>(count);
}

std::vector<PixelPair> MatcherClient::match(const ImageView& first, const ImageView& second,
                                            int most, double timeout_s,
                                            const std::stop_token& stop) {
  const auto deadline = deadlineIn(timeout_s);
  std::vector<std::uint8_t> bytes;
  try {
    send(first, second, most, deadline, stop);
    const std::size_t count = countIn(process_->readLine(kMostLineBytes, deadline, stop), most);
    bytes = process_->read(count * kPairBytes, deadline, stop);
  } catch (const ChildError& error) {
    fail(error.what());
  }
  std::vector<PixelPair> pairs;
  for (std::size_t at = 0; at < bytes.size(); at += kPairBytes) {
    const PixelPair pair{floatAt(bytes, at), floatAt(bytes, at + 4), floatAt(bytes, at + 8),
                         floatAt(bytes, at + 12), floatAt(bytes, at + 16)};
    if (!inside(pair.first_x, pair.first_y, first) ||
        !inside(pair.second_x, pair.second_y, second) || !(pair.score >= 0.0 && pair.score <= 1.0))
      fail("answered nonsense: match " + std::to_string(pairs.size()) +
           " lies outside the images, or its score outside 0 .. 1");
    pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace boresight::sessions
