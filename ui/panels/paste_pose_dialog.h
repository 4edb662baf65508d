// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <QDialog>

#include "sessions/io/pose_text.h"

class QComboBox;
class QFormLayout;
class QLabel;
class QPlainTextEdit;
class QPushButton;

namespace boresight::ui {

/// Takes a pose as text and asks what the text does not say: direction, order, unit. What will be
/// taken, or why nothing can be, is shown while it is typed.
class PastePoseDialog : public QDialog {
  Q_OBJECT

 public:
  explicit PastePoseDialog(const QString& text, QWidget* parent = nullptr);

  const sessions::ParsedPose& parsed() const { return parsed_; }

 private:
  QComboBox* addChoice(const QString& label, const char* name, const QStringList& choices,
                       QFormLayout& form);
  void guess();
  void parse();
  sessions::PoseReading reading() const;

  QPlainTextEdit* text_ = nullptr;
  QComboBox* direction_ = nullptr;
  QComboBox* matrix_order_ = nullptr;
  QComboBox* quaternion_order_ = nullptr;
  QComboBox* unit_ = nullptr;
  QLabel* verdict_ = nullptr;
  QPushButton* take_ = nullptr;
  sessions::ParsedPose parsed_;
};

}  // namespace boresight::ui
