// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/labels/label_samples.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "sessions/io/files/errors.h"
#include "sessions/io/images/labels/label_reading.h"
#include "sessions/io/images/labels/label_values.h"
#include "sessions/io/json/json_reader.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

constexpr std::size_t kMostDistinct = 32;
constexpr double kBeyondMeasurement = 1e30;

double floatingOf(const BitPattern& pattern) {
  if (pattern.width > 32) return std::bit_cast<double>(pattern.bits);
  return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(pattern.bits)));
}

/// Half a unit of the last digit that the number needs.
double halfDigit(double value) {
  char buffer[40];
  const auto end =
      std::to_chars(buffer, buffer + sizeof(buffer), value, std::chars_format::scientific).ptr;
  const std::string text(buffer, end);
  const auto mark = text.find('e');
  const auto point = text.find('.');
  const int decimals = point == std::string::npos ? 0 : static_cast<int>(mark - point - 1);
  const int exponent = std::stoi(text.substr(mark + 1));
  return numberIn<double>("5e" + std::to_string(exponent - decimals - 1)).value_or(0.0);
}

void add(double value, double tolerance, std::vector<InvalidValue>& values) {
  const bool known = std::any_of(
      values.begin(), values.end(),
      [value](const InvalidValue& invalid_value) { return invalid_value.value == value; });
  if (std::isfinite(value) && values.size() < kMostDistinct && !known)
    values.push_back({value, tolerance});
}

void addPattern(const BitPattern& pattern, bool floating, int sample_bits,
                std::vector<InvalidValue>& values) {
  if (floating) return add(floatingOf(pattern), 0.0, values);
  add(static_cast<double>(pattern.bits), 0.0, values);
  if (sample_bits > 32 || pattern.bits >> sample_bits != 0) return;
  if ((pattern.bits >> (sample_bits - 1)) == 1)
    add(static_cast<double>(pattern.bits) - static_cast<double>(std::uint64_t{1} << sample_bits),
        0.0, values);
}

constexpr double kLargestWhole = 65535.0;
constexpr double kOutlierShare = 1e-3;  ///< of the samples, half of it at each end
constexpr double kMostFill = 0.05;      ///< of the samples, the lowest or the highest value itself
constexpr double kOutlierRoom = 0.5;    ///< of what all others span, beyond them
constexpr std::int64_t kEnoughSamples = 1'000'000;

/// Finds the samples without a value, by the label's constants.
class Validity {
 public:
  Validity(std::vector<InvalidValue> invalid, const SampleType& type)
      : invalid_(std::move(invalid)) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    // A constant written in decimals is the nearest number of the samples' type.
    for (InvalidValue& constant : invalid_)
      if (type.floating && type.bits == 32 && std::abs(constant.value) <= kLargest)
        constant.value = static_cast<double>(static_cast<float>(constant.value));
  }
  bool operator()(double sample) const {
    return std::isfinite(sample) &&
           std::none_of(invalid_.begin(), invalid_.end(), [sample](const InvalidValue& constant) {
             return std::abs(sample - constant.value) <= constant.tolerance;
           });
  }

 private:
  std::vector<InvalidValue> invalid_;
};

struct Range {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();
  std::int64_t invalid_count = 0;
  std::int64_t clipped_count = 0;  ///< outliers, below the lowest or above the highest
};

template <class Visit>
void forValidSamples(const LabelRaster& raster, const Validity& valid, const Visit& visit) {
  std::vector<double> row;
  for (int band = 0; band < raster.picture.bands; ++band)
    for (int y = 0; y < raster.picture.height; ++y) {
      raster.readRow(band, y, row);
      for (const double sample : row)
        if (valid(sample)) visit(sample);
    }
}

Range rangeOf(const LabelRaster& raster, const Validity& valid) {
  Range range;
  range.invalid_count =
      std::int64_t{raster.picture.width} * raster.picture.height * raster.picture.bands;
  forValidSamples(raster, valid, [&range](double sample) {
    --range.invalid_count;
    range.lowest = std::min(range.lowest, sample);
    range.highest = std::max(range.highest, sample);
  });
  return range;
}

/// The lowest of the range becomes 0, the highest 65535. Halves keep the difference of the largest
/// numbers finite.
std::uint16_t quantized(double sample, const Range& range) {
  const double span = 0.5 * range.highest - 0.5 * range.lowest;
  if (!(span > 0.0)) return 0;
  const double share = (0.5 * sample - 0.5 * range.lowest) / span;
  return static_cast<std::uint16_t>(
      std::clamp(std::floor(share * kLargestWhole + 0.5), 0.0, kLargestWhole));
}

/// Valid samples at equal steps, enough for the range of nearly all values.
std::vector<double> someSamples(const LabelRaster& raster, const Validity& valid) {
  const std::int64_t all =
      std::int64_t{raster.picture.width} * raster.picture.height * raster.picture.bands;
  const std::int64_t step = (all / kEnoughSamples) | 1;  // odd: not one column of an even width
  std::vector<double> samples;
  std::int64_t number = 0;
  forValidSamples(raster, valid, [&](double sample) {
    if (number++ % step == 0) samples.push_back(sample);
  });
  return samples;
}

/// Takes one value out where it is a small part of the samples: what a program writes for nothing
/// comes many times, and alike.
void dropIfRare(std::vector<double>& samples, double value) {
  const auto count = std::count(samples.begin(), samples.end(), value);
  if (static_cast<double>(count) <= kMostFill * static_cast<double>(samples.size()))
    std::erase(samples, value);
}

/// The value below which a share of the samples lies.
double quantile(std::vector<double>& samples, double share) {
  const auto at = samples.begin() + static_cast<std::ptrdiff_t>(
                                        share * static_cast<double>(samples.size() - 1) + 0.5);
  std::nth_element(samples.begin(), at, samples.end());
  return *at;
}

/// Without samples far off nearly all others, a hot pixel or a value for nothing that the label
/// does not name: they would take the levels from the picture.
Range withoutOutliers(const LabelRaster& raster, const Validity& valid, const Range& all) {
  std::vector<double> samples = someSamples(raster, valid);
  dropIfRare(samples, all.lowest);
  dropIfRare(samples, all.highest);
  if (samples.empty()) return all;
  const double low = quantile(samples, 0.5 * kOutlierShare);
  const double high = quantile(samples, 1.0 - 0.5 * kOutlierShare);
  const double room = kOutlierRoom * (high - low);
  if (!(high > low) || !std::isfinite(room)) return all;
  Range range = all;
  range.lowest = std::max(all.lowest, low - room);
  range.highest = std::min(all.highest, high + room);
  forValidSamples(raster, valid, [&range](double sample) {
    range.clipped_count += sample < range.lowest || sample > range.highest ? 1 : 0;
  });
  return range;
}

void readValues(const LabelRaster& raster, const Validity& valid, const Range& range,
                LabelSamples& samples) {
  const auto width = static_cast<std::size_t>(raster.picture.width);
  samples.values.reserve(width * static_cast<std::size_t>(raster.picture.height));
  std::vector<double> row;
  std::vector<std::uint16_t> bands[3];
  for (int y = 0; y < raster.picture.height; ++y) {
    for (int band = 0; band < raster.picture.bands; ++band) {
      raster.readRow(band, y, row);
      bands[band].assign(width, 0);
      for (std::size_t x = 0; x < width; ++x)
        if (valid(row[x]))
          bands[band][x] =
              samples.quantized ? quantized(row[x], range) : static_cast<std::uint16_t>(row[x]);
    }
    for (std::size_t x = 0; x < width; ++x)
      samples.values.push_back(
          raster.picture.bands == 1 ? bands[0][x] : luma(bands[0][x], bands[1][x], bands[2][x]));
  }
}

void requirePicture(const LabelFiles& files, const LabelRaster& raster,
                    const LabelReading& reading) {
  const int bands = raster.picture.bands;
  if (bands != 1 && bands != 3)
    throw InputError(files.file, "the image has " + std::to_string(bands) +
                                     " bands; 1 (gray) or 3 (red, green, blue) are needed: write "
                                     "the wanted band into a separate file");
  if (bands == 3 && !reading.derived_type.empty())
    throw InputError(files.file,
                     "the label calls this a " + reading.derived_type + ", not a colour image");
}

std::string ruleOf(const LabelSamples& samples, const Range& range, const SampleType& type) {
  const std::string kind = type.floating    ? "floating-point numbers"
                           : type.is_signed ? "signed integers"
                                            : "unsigned integers";
  std::string rule;
  if (samples.quantized)
    rule = std::to_string(type.bits) + "-bit " + kind +
           " v as q = floor((v - low) / (high - low) * 65535 + 0.5), low " +
           numberText(range.lowest) + ", high " + numberText(range.highest) +
           (range.clipped_count == 0
                ? ""
                : " (" + std::to_string(range.clipped_count) + " outliers beyond are clipped)");
  if (range.invalid_count > 0 && (samples.quantized || range.lowest > 0.0))
    rule += (rule.empty() ? "" : "; ") + std::to_string(range.invalid_count) +
            " samples without a value as 0";
  return rule;
}

}  // namespace

void addInvalidValues(const json* stated, bool floating, int sample_bits,
                      std::vector<InvalidValue>& values) {
  for (const json* item : labelList(stated)) {
    if (const auto number = labelNumber(item)) {
      const bool rounded = floating && std::abs(*number) >= kBeyondMeasurement;
      add(*number, rounded ? halfDigit(*number) : 0.0, values);
    } else if (const auto pattern = bitPattern(labelText(item).value_or(""))) {
      addPattern(*pattern, floating, sample_bits, values);
    }
  }
}

LabelSamples readLabelSamples(const LabelFiles& files) {
  const LabelRaster raster = openLabelRaster(files);
  const LabelReading reading = readLabel(files, raster);
  requirePicture(files, raster, reading);
  const Validity valid(reading.invalid, raster.picture.type);
  Range range = rangeOf(raster, valid);
  if (!(range.lowest <= range.highest))
    throw InputError(
        files.file, "no sample of the image has a value: all are missing, invalid or not a number");
  LabelSamples samples;
  samples.width = raster.picture.width;
  samples.height = raster.picture.height;
  samples.bands = raster.picture.bands;
  samples.quantized =
      raster.picture.type.floating || range.lowest < 0.0 || range.highest > kLargestWhole;
  ImageLabel label = reading.label;
  if (samples.quantized) {
    const Range whole = range;
    range = withoutOutliers(raster, valid, whole);
    if (range.clipped_count > 0)
      label.flags.push_back(
          std::to_string(range.clipped_count) + " samples are far outliers (the full range is " +
          numberText(whole.lowest) + " to " + numberText(whole.highest) + ") and are clipped to " +
          numberText(range.lowest) + " .. " + numberText(range.highest));
    samples.offset = range.lowest;
    samples.scale = (range.highest / kLargestWhole) - (range.lowest / kLargestWhole);
  }
  samples.sample_bits = raster.picture.type.bits == 8 && !samples.quantized ? 8 : 16;
  samples.highest = samples.quantized ? 65535 : static_cast<int>(range.highest);
  samples.invalid_count = range.invalid_count;
  samples.rule = ruleOf(samples, range, raster.picture.type);
  samples.label = std::make_shared<const ImageLabel>(label);
  samples.sha256 = files.sha256;
  readValues(raster, valid, range, samples);
  return samples;
}

}  // namespace boresight::sessions
