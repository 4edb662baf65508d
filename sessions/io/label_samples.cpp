// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/label_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sessions/io/errors.h"
#include "sessions/io/json_reader.h"
#include "sessions/io/label_raster.h"
#include "sessions/io/label_reading.h"

namespace boresight::sessions {
namespace {

constexpr double kLargestWhole = 65535.0;

/// Whether a sample is one, by the label's constants.
class Validity {
 public:
  Validity(const std::vector<double>& constants, SampleType type) : constants_(constants) {
    // A constant written in decimals is the nearest number of the samples' type.
    if (type == SampleType::kFloat)
      for (double& one : constants_) one = static_cast<double>(static_cast<float>(one));
  }
  bool operator()(double sample) const {
    return std::isfinite(sample) &&
           std::find(constants_.begin(), constants_.end(), sample) == constants_.end();
  }

 private:
  std::vector<double> constants_;
};

struct Range {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();
  std::int64_t invalid_count = 0;
};

Range rangeOf(const LabelRaster& raster, const Validity& valid) {
  Range range;
  std::vector<double> row;
  for (int band = 0; band < raster.bands(); ++band)
    for (int y = 0; y < raster.height(); ++y) {
      raster.readRow(band, y, row);
      for (const double sample : row) {
        if (!valid(sample)) {
          ++range.invalid_count;
          continue;
        }
        range.lowest = std::min(range.lowest, sample);
        range.highest = std::max(range.highest, sample);
      }
    }
  return range;
}

/// Samples to 16 bits.
class Quantizer {
 public:
  Quantizer(const Range& range, bool quantized)
      : quantized_(quantized),
        lowest_(0.5 * range.lowest),
        span_(0.5 * range.highest - 0.5 * range.lowest) {}
  /// Halves keep the difference of the largest numbers finite.
  std::uint16_t operator()(double sample) const {
    if (!quantized_) return static_cast<std::uint16_t>(sample);
    if (!(span_ > 0.0)) return 0;
    const double share = (0.5 * sample - lowest_) / span_;
    return static_cast<std::uint16_t>(
        std::clamp(std::floor(share * kLargestWhole + 0.5), 0.0, kLargestWhole));
  }

 private:
  bool quantized_;
  double lowest_;
  double span_;
};

std::uint16_t luma(std::uint32_t red, std::uint32_t green, std::uint32_t blue) {
  return static_cast<std::uint16_t>((9798u * red + 19235u * green + 3735u * blue + 16384u) >> 15);
}

void readValues(const LabelRaster& raster, const Validity& valid, const Quantizer& quantize,
                std::vector<std::uint16_t>& values) {
  const auto width = static_cast<std::size_t>(raster.width());
  values.reserve(width * static_cast<std::size_t>(raster.height()));
  std::vector<double> row;
  std::vector<std::uint16_t> bands[3];
  for (int y = 0; y < raster.height(); ++y) {
    for (int band = 0; band < raster.bands(); ++band) {
      raster.readRow(band, y, row);
      bands[band].resize(width);
      for (std::size_t x = 0; x < width; ++x)
        bands[band][x] = valid(row[x]) ? quantize(row[x]) : std::uint16_t{0};
    }
    if (raster.bands() == 1)
      values.insert(values.end(), bands[0].begin(), bands[0].end());
    else
      for (std::size_t x = 0; x < width; ++x)
        values.push_back(luma(bands[0][x], bands[1][x], bands[2][x]));
  }
}

void requirePicture(const LabelFiles& files, const LabelRaster& raster,
                    const LabelReading& reading) {
  const int bands = raster.bands();
  if (bands != 1 && bands != 3)
    throw InputError(files.file, "the image has " + std::to_string(bands) +
                                     " bands; 1 (gray) or 3 (red, green, blue) are needed: write "
                                     "the wanted band into a file of its own");
  if (bands == 3 && !reading.derived_type.empty())
    throw InputError(
        files.file, "the label calls this a " + reading.derived_type + ", not a picture in colour");
}

std::string ruleOf(const LabelSamples& samples, const Range& range, SampleType type) {
  std::string rule;
  if (samples.quantized)
    rule = std::string(sampleTypeName(type)) +
           " v as q = floor((v - low) / (high - low) * 65535 + " + "0.5), low " +
           numberText(range.lowest) + ", high " + numberText(range.highest);
  if (range.invalid_count > 0 && (samples.quantized || range.lowest > 0.0))
    rule += (rule.empty() ? "" : "; ") + std::to_string(range.invalid_count) +
            " samples without a value as 0";
  return rule;
}

}  // namespace

LabelSamples readLabelSamples(const LabelFiles& files) {
  const LabelRaster raster(files);
  const LabelReading reading = readLabel(files, raster);
  requirePicture(files, raster, reading);
  const Validity valid(reading.invalid, raster.type());
  const Range range = rangeOf(raster, valid);
  if (!(range.lowest <= range.highest))
    throw InputError(files.file,
                     "no sample of the image has a value: all are missing, invalid or "
                     "no numbers");
  LabelSamples samples;
  samples.container = labelFormatName(files.format);
  samples.width = raster.width();
  samples.height = raster.height();
  samples.bands = raster.bands();
  samples.quantized =
      isFloating(raster.type()) || range.lowest < 0.0 || range.highest > kLargestWhole;
  samples.sample_bits = raster.type() == SampleType::kUint8 ? 8 : 16;
  samples.highest = samples.quantized ? 65535 : static_cast<int>(range.highest);
  samples.invalid_count = range.invalid_count;
  if (samples.quantized) {
    samples.offset = range.lowest;
    samples.scale = (range.highest / kLargestWhole) - (range.lowest / kLargestWhole);
  }
  samples.rule = ruleOf(samples, range, raster.type());
  samples.label = std::make_shared<const ImageLabel>(reading.label);
  samples.sha256 = files.sha256;
  readValues(raster, valid, Quantizer(range, samples.quantized), samples.values);
  return samples;
}

}  // namespace boresight::sessions
