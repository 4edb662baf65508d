// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <QObject>
#include <QString>

#include "ui/window/window_parts.h"

class QWidget;

namespace boresight::ui {

class AnnotationPanel;

/// Marks, annotated poses and landmarks from and to files. The functions with a path do what the
/// ones without do after they have asked for one.
class AnnotationFiles : public QObject {
  Q_OBJECT

 public:
  AnnotationFiles(QWidget& window, const WindowParts& parts, AnnotationPanel& panel);

  /// points.json or a table (.csv): the marks of the shown case become these.
  bool importMarks(const std::filesystem::path& file);
  bool exportMarks(const std::filesystem::path& file);
  bool openLandmarks(const std::filesystem::path& file);
  /// The station's landmarks with the marks of this image, which the case then uses.
  bool saveLandmarks(const std::filesystem::path& file);

 public Q_SLOTS:
  void askForImport();
  void askForExport();
  void askForLandmarks();
  void askWhereToSaveLandmarks();

 Q_SIGNALS:
  /// Something could not be done; one sentence.
  void failed(const QString& message);
  /// What happened, for the status bar.
  void noted(const QString& message);

 private:
  template <class Action>
  bool attempt(Action&& action);

  QWidget& window_;
  WindowParts parts_;
};

}  // namespace boresight::ui
