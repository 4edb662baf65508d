// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QObject>
#include <QString>

class QLabel;
class QToolBar;

namespace boresight::ui {

class ImageView;

/// Child widgets over the image: the strip of tools, next to it the title, the shown iteration
/// (upper right), the zoom (lower right). Keeps them in their corners.
class CanvasChips : public QObject {
  Q_OBJECT

 public:
  explicit CanvasChips(ImageView& view);

  QToolBar& tools() { return *tools_; }
  /// Sets the title: the shown case and run; empty hides it.
  void setTitle(const QString& text);
  /// "Iteration 1.4, refine"; empty hides it.
  void setShown(const QString& text);
  /// Sets the widget of the lower left corner.
  void setLegend(QWidget* legend);

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  QLabel* chip(const char* name);
  void showZoom();
  void arrange();
  void placeTitle();

  ImageView& view_;
  QToolBar* tools_;
  QString title_text_;
  QLabel* title_;
  QLabel* shown_;
  QLabel* zoom_;
  QWidget* legend_ = nullptr;
};

}  // namespace boresight::ui
