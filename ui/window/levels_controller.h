// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QObject>

#include "sessions/io/image_file.h"
#include "ui/window/window_parts.h"

namespace boresight::ui {

class LevelsPanel;

/// Makes another rule by which images become 8 bit an edit of the document. The images are read off
/// this thread first, as the document knows their 8-bit pixels by a hash.
class LevelsController : public QObject {
  Q_OBJECT

 public:
  LevelsController(const WindowParts& parts, LevelsPanel& panel, QObject* parent = nullptr);

 Q_SIGNALS:
  void noted(const QString& message);

 private:
  void convert(const sessions::ImageReadOptions& eight_bit, bool whole_camera);
  void showDocument();

  WindowParts parts_;
  LevelsPanel& panel_;
};

}  // namespace boresight::ui
