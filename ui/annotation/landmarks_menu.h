// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QMenu>

namespace boresight::ui {

class AnnotationController;

/// The station's named points that this image has no mark of: where they should be is confirmed,
/// or one is begun by name and then clicked. Also where landmarks come from and go to.
class LandmarksMenu : public QMenu {
  Q_OBJECT

 public:
  explicit LandmarksMenu(AnnotationController& controller, QWidget* parent = nullptr);

 Q_SIGNALS:
  void openRequested();
  void saveRequested();

 private:
  void fill();

  AnnotationController& controller_;
};

}  // namespace boresight::ui
