// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QDialog>

#include "sessions/io/pose_text.h"

class QPushButton;

namespace boresight::ui {

namespace Ui {
class PastePoseDialog;
}

/// Takes a pose as text and asks what the text does not say: direction, order, unit. What will be
/// taken, or why nothing can be, is shown while it is typed.
class PastePoseDialog : public QDialog {
  Q_OBJECT

 public:
  explicit PastePoseDialog(const QString& text, QWidget* parent = nullptr);
  ~PastePoseDialog() override;

  const sessions::ParsedPose& parsed() const { return parsed_; }

 private:
  void guess();
  void parse();
  sessions::PoseReading reading() const;

  QPushButton* take_ = nullptr;
  sessions::ParsedPose parsed_;
  const std::unique_ptr<Ui::PastePoseDialog> ui_;
};

}  // namespace boresight::ui
