// SPDX-License-Identifier: Apache-2.0
#include "ui/views/display_image.h"

#include <algorithm>
#include <utility>

#include "sessions/io/errors.h"
#include "ui/run/task_runner.h"
#include "ui/views/display_stretch.h"

namespace boresight::ui {
namespace {

struct ReadSamples {
  DisplayImage::SamplesPtr samples;
  sessions::GrayLevels automatic;
};

ReadSamples readFor(const sessions::ImageInput& input) {
  auto samples =
      std::make_shared<const sessions::ImageSamples>(sessions::readSamples(input.source.file));
  if (samples->file_sha256 != input.source.sha256)
    throw sessions::InputError(input.source.file,
                               "the file has changed since the session was opened, so that it "
                               "cannot be shown stretched");
  const sessions::GrayLevels automatic = automaticLevels(*samples);
  return {std::move(samples), automatic};
}

}  // namespace

DisplayImage::DisplayImage(ViewState& state, TaskRunner& tasks, QObject* parent)
    : QObject(parent), state_(state), tasks_(tasks) {
  connect(&state_, &ViewState::caseChanged, this, &DisplayImage::showCase);
}

void DisplayImage::showCase() {
  const ViewState::CasePtr before = std::exchange(case_, state_.currentCase());
  const bool same_file =
      before && case_ && before->source.image.source == case_->source.image.source;
  if (same_file && before->source.image == case_->source.image) return;
  core_ = QImage();
  if (case_) {
    const sessions::GrayImage& image = case_->image;
    // The wrapper only reads; the copy is Qt's own.
    core_ = QImage(image.pixels.data(), image.width, image.height, image.width,
                   QImage::Format_Grayscale8)
                .copy();
  }
  if (same_file && samples_) {
    makePicture();
    return;
  }
  samples_.reset();
  setPicture(core_);
  Q_EMIT levelsChanged();
  if (!case_) return;
  tasks_.start(
      QStringLiteral("samples"),
      [input = case_->source.image](const std::stop_token&) { return readFor(input); },
      [this, source = case_->source.image.source](ReadSamples read) {
        if (!case_ || !(case_->source.image.source == source)) return;
        automatic_ = read.automatic;
        takeSamples(std::move(read.samples));
      });
}

void DisplayImage::takeSamples(SamplesPtr samples) {
  samples_ = std::move(samples);
  levels_ = samples_->sample_bits > 8 ? automatic_ : fullLevels(*samples_);
  Q_EMIT levelsChanged();
  makePicture();
}

void DisplayImage::setShowsCore(bool shows_core) {
  if (shows_core == shows_core_) return;
  shows_core_ = shows_core;
  Q_EMIT levelsChanged();
  makePicture();
}

void DisplayImage::setLevels(const sessions::GrayLevels& levels) {
  if (!samples_) return;
  const int largest = fullLevels(*samples_).white;
  sessions::GrayLevels next;
  next.black = std::clamp(levels.black, 0, largest - 1);
  next.white = std::clamp(levels.white, next.black + 1, largest);
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
    tasks_.cancel(QStringLiteral("stretch"));
    setPicture(core_);
    return;
  }
  tasks_.start(
      QStringLiteral("stretch"),
      [samples = samples_, levels = levels_](const std::stop_token&) {
        return stretched(*samples, levels);
      },
      [this, samples = samples_](const QImage& picture) {
        if (samples == samples_ && !shows_core_) setPicture(picture);
      });
}

void DisplayImage::setPicture(const QImage& picture) {
  picture_ = picture;
  Q_EMIT pictureChanged();
}

}  // namespace boresight::ui
