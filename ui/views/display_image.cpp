// SPDX-License-Identifier: Apache-2.0
#include "ui/views/display_image.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "sessions/io/files/errors.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

using sessions::GrayLevels;
using sessions::ImageSamples;

QImage grayImage(const boresight::ImageView& image) {
  return QImage(image.data, image.width, image.height, static_cast<int>(image.stride),
                QImage::Format_Grayscale8)
      .copy();
}

namespace {

/// The share of the samples that an automatic stretch makes black, and white.
constexpr double kClippedShare = 0.005;

}  // namespace

GrayLevels fullLevels(const ImageSamples& samples) { return {0, (1 << samples.sample_bits) - 1}; }

GrayLevels automaticLevels(const ImageSamples& samples) {
  std::vector<std::size_t> histogram(std::size_t{1} << 16, 0);
  for (const std::uint16_t value : samples.values) ++histogram[value];
  const auto clipped =
      static_cast<std::size_t>(kClippedShare * static_cast<double>(samples.values.size()));
  const int largest = fullLevels(samples).white;
  GrayLevels levels = {0, largest};
  std::size_t below = 0;
  while (levels.black < largest &&
         (below += histogram[static_cast<std::size_t>(levels.black)]) <= clipped)
    ++levels.black;
  std::size_t above = 0;
  while (levels.white > 0 &&
         (above += histogram[static_cast<std::size_t>(levels.white)]) <= clipped)
    --levels.white;
  if (levels.white <= levels.black) {
    levels.black = std::max(0, std::min(levels.black, levels.white) - 1);
    levels.white = std::min(largest, levels.black + 2);
  }
  return levels;
}

GrayLevels firstLevels(const ImageSamples& samples, const GrayLevels& automatic) {
  const GrayLevels full = fullLevels(samples);
  const bool flat = 2 * (automatic.white - automatic.black) < full.white;
  return samples.sample_bits > 8 || flat ? automatic : full;
}

std::vector<int> histogramOf(const ImageSamples& samples) {
  constexpr int kBins = 256;
  std::vector<int> counts(kBins, 0);
  const int all = fullLevels(samples).white + 1;
  for (const std::uint16_t value : samples.values)
    ++counts[static_cast<std::size_t>(std::min(value * kBins / all, kBins - 1))];
  return counts;
}

QString sampleText(const ImageSamples& samples, int x, int y) {
  const std::uint16_t value =
      samples.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(samples.width) +
                     static_cast<std::size_t>(x)];
  if (samples.offset == 0.0 && samples.scale == 1.0) return QString::number(value);
  return QString::number(samples.offset + samples.scale * value, 'g', 6);
}

QImage stretched(const ImageSamples& samples, const GrayLevels& levels) {
  const std::vector<std::uint8_t> table = sessions::tableOfLevels(levels, samples.sample_bits);
  QImage image(samples.width, samples.height, QImage::Format_Grayscale8);
  const std::uint16_t* sample = samples.values.data();
  for (int y = 0; y < samples.height; ++y) {
    uchar* line = image.scanLine(y);
    for (int x = 0; x < samples.width; ++x) line[x] = table[*sample++];
  }
  return image;
}

namespace {

struct ReadSamples {
  DisplayImage::SamplesPtr samples;
  GrayLevels automatic;
  std::vector<int> histogram;
};

ReadSamples readFor(const sessions::ImageInput& input) {
  const auto samples = std::make_shared<const ImageSamples>(
      sessions::readSamples(input.source.file, input.eight_bit.bayer));
  if (samples->file_sha256 != input.source.sha256)
    throw sessions::InputError(
        input.source.file,
        "the file has changed since the session was opened; stretching is not possible");
  return {samples, automaticLevels(*samples), histogramOf(*samples)};
}

}  // namespace

DisplayImage::DisplayImage(ViewState& state, TaskRunner& tasks, QObject* parent)
    : QObject(parent), state_(state), tasks_(tasks) {
  state_.onChange(ViewChange::kCase, this, &DisplayImage::showCase);
}

void DisplayImage::showCase() {
  const ViewState::CasePtr before = std::exchange(case_, state_.currentCase());
  const bool same_file =
      before && case_ && before->source.image.source == case_->source.image.source;
  if (same_file && before->source.image == case_->source.image) return;
  core_ = case_ ? grayImage(case_->image.view()) : QImage();
  if (same_file && samples_) {
    makePicture();
    return;
  }
  samples_.reset();
  histogram_.clear();
  setPicture(core_);
  Q_EMIT levelsChanged();
  if (!case_) return;
  tasks_.replace(
      reading_, [input = case_->source.image](const std::stop_token&) { return readFor(input); },
      [this, source = case_->source.image.source](ReadSamples read) {
        if (!case_ || !(case_->source.image.source == source)) return;
        automatic_ = read.automatic;
        histogram_ = std::move(read.histogram);
        samples_ = std::move(read.samples);
        levels_ = firstLevels(*samples_, automatic_);
        Q_EMIT levelsChanged();
        makePicture();
      },
      reportTo(this, &DisplayImage::failed));
}

void DisplayImage::setShowsCore(bool shows_core) {
  if (shows_core == shows_core_) return;
  shows_core_ = shows_core;
  Q_EMIT levelsChanged();
  makePicture();
}

void DisplayImage::setLevels(const GrayLevels& levels) {
  if (!samples_) return;
  const int largest = fullLevels(*samples_).white;
  const int black = std::clamp(levels.black, 0, largest - 1);
  const GrayLevels next = {black, std::clamp(levels.white, black + 1, largest)};
  if (next == levels_) return;
  levels_ = next;
  Q_EMIT levelsChanged();
  makePicture();
}

void DisplayImage::setAutomaticLevels() { setLevels(automatic_); }

void DisplayImage::setFullLevels() {
  if (samples_) setLevels(fullLevels(*samples_));
}

void DisplayImage::makePicture() {
  if (shows_core_ || !samples_) {
    tasks_.cancel(stretching_);
    setPicture(core_);
    return;
  }
  tasks_.replace(
      stretching_,
      [samples = samples_, levels = levels_](const std::stop_token&) {
        return stretched(*samples, levels);
      },
      [this, samples = samples_](const QImage& picture) {
        if (samples == samples_ && !shows_core_) setPicture(picture);
      },
      reportTo(this, &DisplayImage::failed));
}

void DisplayImage::setPicture(const QImage& picture) {
  picture_ = picture;
  Q_EMIT pictureChanged();
}

namespace {

QImage pictureOf(const BitImage& bits, QRgb color) {
  QImage picture(bits.width, bits.height, QImage::Format_ARGB32_Premultiplied);
  for (int y = 0; y < bits.height; ++y) {
    auto* line = reinterpret_cast<QRgb*>(picture.scanLine(y));
    for (int x = 0; x < bits.width; ++x) line[x] = bits.get(x, y) ? color : 0U;
  }
  return picture;
}

/// Every 2x2 pixels combined into one; at odd borders the last ones count twice.
template <class Pixel, class Combine>
QImage halved(const QImage& fine, Combine&& combine) {
  QImage coarse((fine.width() + 1) / 2, (fine.height() + 1) / 2, fine.format());
  for (int y = 0; y < coarse.height(); ++y) {
    const int below = std::min(2 * y + 1, fine.height() - 1);
    const auto* upper = reinterpret_cast<const Pixel*>(fine.constScanLine(2 * y));
    const auto* lower = reinterpret_cast<const Pixel*>(fine.constScanLine(below));
    auto* line = reinterpret_cast<Pixel*>(coarse.scanLine(y));
    for (int x = 0; x < coarse.width(); ++x) {
      const int right = std::min(2 * x + 1, fine.width() - 1);
      line[x] = combine(upper[2 * x], upper[right], lower[2 * x], lower[right]);
    }
  }
  return coarse;
}

/// The step of the coarsest picture whose pixels cover at most `fine_per_pixel` of the finest
/// one's.
int stepFor(double fine_per_pixel) {
  int step = 0;
  while ((2 << step) <= fine_per_pixel && step < 12) ++step;
  return step;
}

/// Halves the last picture until there is one of this step.
template <class Halve>
const QImage& pictureAt(int step, std::vector<QImage>& pictures, Halve&& halve) {
  while (pictures.size() <= static_cast<std::size_t>(step))
    pictures.push_back(halve(pictures.back()));
  return pictures[static_cast<std::size_t>(step)];
}

/// With the smallest step that drops no bit.
int stepForBits(double bits_per_pixel) { return stepFor(2.0 * bits_per_pixel - 1e-9); }

}  // namespace

BitPixmaps::BitPixmaps(const BitImage& bits, const QColor& color) {
  pictures_.push_back(pictureOf(bits, qPremultiply(color.rgba())));
}

/// Set pixels all have the same colour: OR keeps it.
const QImage& BitPixmaps::at(double bits_per_pixel, int& step) {
  step = stepForBits(bits_per_pixel);
  return pictureAt(step, pictures_, [](const QImage& fine) {
    return halved<QRgb>(fine, [](QRgb a, QRgb b, QRgb c, QRgb d) { return a | b | c | d; });
  });
}

bool BitPixmaps::has(double bits_per_pixel) const {
  return static_cast<std::size_t>(stepForBits(bits_per_pixel)) < pictures_.size();
}

GrayPyramid::GrayPyramid(QImage gray) {
  if (!gray.isNull()) pictures_.push_back(std::move(gray));
}

const QImage& GrayPyramid::at(double image_per_pixel, int& step) const {
  step = stepFor(image_per_pixel);
  return pictureAt(step, pictures_, [](const QImage& fine) {
    return halved<uchar>(fine, [](int a, int b, int c, int d) {
      return static_cast<uchar>((a + b + c + d + 2) / 4);
    });
  });
}

}  // namespace boresight::ui
