// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_constants.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "sessions/io/labels/label_values.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

constexpr std::size_t kMostValues = 32;
constexpr double kBeyondMeasurement = 1e30;

/// Bits of a number as a label writes them.
struct Pattern {
  std::uint64_t bits = 0;
  int width = 0;  ///< of the digits written
};

std::optional<Pattern> patternOf(std::string_view text) {
  int base = 16;
  if (text.starts_with("0x") || text.starts_with("0X")) {
    text.remove_prefix(2);
  } else {
    const auto hash = text.find('#');
    if (hash == std::string_view::npos) return std::nullopt;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + hash, base);
    if (error != std::errc() || stop != text.data() + hash || (base != 2 && base != 16))
      return std::nullopt;
    text = text.substr(hash + 1);
    if (text.ends_with('#')) text.remove_suffix(1);
  }
  Pattern pattern;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, pattern.bits, base);
  if (error != std::errc() || stop != end) return std::nullopt;
  pattern.width = static_cast<int>(text.size()) * (base == 16 ? 4 : 1);
  return pattern;
}

double floatingOf(const Pattern& pattern) {
  if (pattern.width > 32) return std::bit_cast<double>(pattern.bits);
  return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(pattern.bits)));
}

/// Half a unit of the last digit that the number needs.
double halfDigit(double value) {
  char digits[40];
  const auto end =
      std::to_chars(digits, digits + sizeof(digits), value, std::chars_format::scientific).ptr;
  const std::string_view text(digits, static_cast<std::size_t>(end - digits));
  const auto mark = text.find('e');
  const auto point = text.find('.');
  const int decimals = point == std::string_view::npos ? 0 : static_cast<int>(mark - point - 1);
  int exponent = 0;
  std::from_chars(digits + mark + (text[mark + 1] == '+' ? 2 : 1), end, exponent);
  const std::string half = "5e" + std::to_string(exponent - decimals - 1);
  double value_of_half = 0.0;
  std::from_chars(half.data(), half.data() + half.size(), value_of_half);
  return value_of_half;
}

void add(double value, double tolerance, std::vector<InvalidValue>& values) {
  const bool known = std::any_of(values.begin(), values.end(),
                                 [value](const InvalidValue& one) { return one.value == value; });
  if (std::isfinite(value) && values.size() < kMostValues && !known)
    values.push_back({value, tolerance});
}

void addPattern(const Pattern& pattern, bool floating, int sample_bits,
                std::vector<InvalidValue>& values) {
  if (floating) return add(floatingOf(pattern), 0.0, values);
  add(static_cast<double>(pattern.bits), 0.0, values);
  if (sample_bits > 32 || pattern.bits >> sample_bits != 0) return;
  if ((pattern.bits >> (sample_bits - 1)) == 1)
    add(static_cast<double>(pattern.bits) - static_cast<double>(std::uint64_t{1} << sample_bits),
        0.0, values);
}

}  // namespace

void addInvalidValues(const json* stated, bool floating, int sample_bits,
                      std::vector<InvalidValue>& values) {
  if (stated == nullptr) return;
  const json list = stated->is_array() ? *stated : json::array({*stated});
  for (const json& one : list) {
    if (const auto number = labelNumber(&one)) {
      const bool rounded = floating && std::abs(*number) >= kBeyondMeasurement;
      add(*number, rounded ? halfDigit(*number) : 0.0, values);
    } else if (const auto pattern = patternOf(labelText(&one).value_or(""))) {
      addPattern(*pattern, floating, sample_bits, values);
    }
  }
}

}  // namespace boresight::sessions
