// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QImage>
#include <QObject>

#include "sessions/session/case_run.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

/// A case's image as a camera without lens distortion sees it. Taking out the distortion takes a
/// while, so it is done off the UI's thread, and once per case.
class SceneBackdrop : public QObject {
  Q_OBJECT

 public:
  using CasePtr = std::shared_ptr<const sessions::LoadedCase>;

  using QObject::QObject;

  /// Null until `order` has been answered.
  const QImage& gray() const { return gray_; }
  void clear();
  /// Nothing happens when this case's is there or under way.
  void order(const CasePtr& one);

 Q_SIGNALS:
  void ready();

 private:
  void take(const CasePtr& one, const QImage& gray);

  QImage gray_;  ///< Format_Grayscale8
  std::weak_ptr<const sessions::LoadedCase> of_;
  TaskRunner runner_;
};

}  // namespace boresight::ui
