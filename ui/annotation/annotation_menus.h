// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <QMenu>

#include "ui/state/view_state.h"

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

class AnnotationController;
class Document;

/// Which cases are solved together with the shown one: lists them, opens one, links and unlinks.
class RigMenu : public QMenu {
  Q_OBJECT

 public:
  RigMenu(Document& document, ViewState& state, AnnotationController& controller,
          QWidget* parent = nullptr);

 Q_SIGNALS:
  void openRequested(const QString& case_id);

 private:
  void fill();
  void addLinks(QMenu& menu, const sessions::SessionCase& shown,
                const sessions::SessionCase& other);
  void askForPose(const std::string& other_id);

  Document& document_;
  ViewState& state_;
  AnnotationController& controller_;
};

}  // namespace boresight::ui
