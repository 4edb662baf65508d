// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QImage>
#include <QPair>
#include <QRectF>
#include <QVector>
#include <QWidget>

namespace boresight::ui {

/// Where a small picture is drawn inside `room`: centred, as large as fits; from three device
/// pixels a pixel on every one is a square of the same whole number of them.
QRectF pixelPlace(const QSize& picture, const QRectF& room, double device_pixel_ratio);

/// A small picture with its pixels enlarged and crisp, under a title and over a note.
class PixelPicture : public QWidget {
  Q_OBJECT

 public:
  explicit PixelPicture(const QString& title, QWidget* parent = nullptr);

  /// A null picture shows the note alone.
  void setPicture(const QImage& picture);
  /// What its colours mean, or why there is none.
  void setNote(const QString& note);
  /// Samples of colours with what they mean, instead of a note under the picture.
  void setLegend(const QVector<QPair<QRgb, QString>>& legend);
  const QImage& picture() const { return picture_; }

  QSize sizeHint() const override { return {170, 200}; }
  QSize minimumSizeHint() const override { return {110, 130}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  /// Its entries, in as many lines as the width asks for; returns how many. A null painter only
  /// counts.
  int layOutLegend(QPainter* painter, int top) const;

  QString title_;
  QString note_;
  QVector<QPair<QRgb, QString>> legend_;
  QImage picture_;
};

}  // namespace boresight::ui
