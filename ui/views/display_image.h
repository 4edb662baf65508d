// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <QColor>
#include <QImage>
#include <QObject>
#include <QString>

#include "core/base/image.h"
#include "sessions/io/images/image_file.h"
#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

/// A copy of an image's 8-bit pixels.
QImage grayImage(const boresight::ImageView& image);

/// Levels between which all but the darkest and the brightest samples lie; for a uniform image some
/// distinct levels.
sessions::GrayLevels automaticLevels(const sessions::ImageSamples& samples);

/// Levels with which an image is shown at first: automatic for images of more than 8 bits, and for
/// images of 8 bits that use less than half of their range.
sessions::GrayLevels firstLevels(const sessions::ImageSamples& samples,
                                 const sessions::GrayLevels& automatic);

/// Number of samples in each of 256 equal bins of the samples' full range.
std::vector<int> histogramOf(const sessions::ImageSamples& samples);

/// The full range of the samples' bits.
sessions::GrayLevels fullLevels(const sessions::ImageSamples& samples);

/// The file's own value at a pixel inside: integers unchanged, others with six digits.
QString sampleText(const sessions::ImageSamples& samples, int x, int y);

/// The samples stretched between two levels, for display only.
QImage stretched(const sessions::ImageSamples& samples, const sessions::GrayLevels& levels);

/// The current case's image as displayed: the 8-bit pixels that the core uses, or the file's
/// samples stretched between two levels, at first firstLevels(). Reading and stretching run in the
/// task runner; until then the former picture, or the core's, is shown.
class DisplayImage : public QObject {
  Q_OBJECT

 public:
  using SamplesPtr = std::shared_ptr<const sessions::ImageSamples>;

  DisplayImage(ViewState& state, TaskRunner& tasks, QObject* parent = nullptr);

  /// Null without a case.
  const QImage& picture() const { return picture_; }
  /// The core's 8-bit gray values.
  const QImage& corePicture() const { return core_; }
  /// nullptr until they are read.
  const SamplesPtr& samples() const { return samples_; }
  const sessions::GrayLevels& levels() const { return levels_; }
  /// Of the samples; empty until they are read.
  const std::vector<int>& histogram() const { return histogram_; }
  bool showsCore() const { return shows_core_; }

  void setShowsCore(bool shows_core);
  /// Black and white are clamped to the range of the samples, black below white.
  void setLevels(const sessions::GrayLevels& levels);
  void setAutomaticLevels();
  void setFullLevels();

 Q_SIGNALS:
  void pictureChanged();
  void failed(const QString& message);
  /// Levels, samples, or the kind of display have changed.
  void levelsChanged();

 private:
  void showCase();
  void makePicture();
  void setPicture(const QImage& picture);

  ViewState& state_;
  TaskRunner& tasks_;
  TaskKind reading_;
  TaskKind stretching_;
  ViewState::CasePtr case_;
  QImage core_;
  QImage picture_;
  SamplesPtr samples_;
  sessions::GrayLevels automatic_;
  sessions::GrayLevels levels_;
  std::vector<int> histogram_;
  bool shows_core_ = false;
};

/// A binary image in one colour for drawing at any zoom. Each coarser picture is the OR of 2x2
/// pixels of the finer one, so that a line one pixel wide remains visible when the image is drawn
/// small. Coarser pictures are computed on demand.
class BitPixmaps {
 public:
  BitPixmaps(const BitImage& bits, const QColor& color);

  /// The picture whose pixels cover 2^step pixels of the bits, with the smallest step at which one
  /// of its pixels covers at least `bits_per_pixel` of them, so that drawing it drops none. Sets
  /// `step`.
  const QImage& at(double bits_per_pixel, int& step);
  /// Whether that picture is already computed.
  bool has(double bits_per_pixel) const;

 private:
  std::vector<QImage> pictures_;  ///< by step, premultiplied ARGB
};

/// A gray image for drawing at any zoom: each coarser picture is the mean over 2x2 pixels.
class GrayPyramid {
 public:
  GrayPyramid() = default;
  explicit GrayPyramid(QImage gray);  ///< Format_Grayscale8

  bool isNull() const { return pictures_.empty(); }
  const QImage& full() const { return pictures_.front(); }
  QSize size() const { return isNull() ? QSize() : full().size(); }
  /// The picture whose pixels cover 2^step pixels of the image, as large a step as
  /// `image_per_pixel` allows; coarser ones are computed on demand.
  const QImage& at(double image_per_pixel, int& step) const;

 private:
  mutable std::vector<QImage> pictures_;
};

}  // namespace boresight::ui
