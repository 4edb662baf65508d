// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QObject>

namespace boresight::ui {

class ImageView;

/// A tool that takes clicks and drags on an image view: one at a time, from claim() until leave().
/// While it is active, Escape is its key.
class CanvasTool : public QObject {
 public:
  /// The view must outlive it.
  CanvasTool(ImageView& view, QObject* parent);
  ~CanvasTool() override;

  /// Drops the gesture under way; the session stays as it is. Called on another case, document or
  /// mode.
  virtual void cancelGesture() = 0;
  /// Called where the pointer moves in a drag whose button is no longer down: a message box took
  /// its release.
  virtual void loseButton() { cancelGesture(); }
  /// Ends the tool.
  virtual void leave() = 0;
  /// One press of Escape: drops the gesture under way; without one, ends the tool.
  virtual void escape() = 0;

  bool eventFilter(QObject* watched, QEvent* event) override;

 protected:
  /// Ends the tool that the view has, and takes its place and the keyboard focus.
  void claim();
  /// The view has no tool afterwards, if it had this one.
  void release();

  ImageView& view_;
};

}  // namespace boresight::ui
