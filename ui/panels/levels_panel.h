// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QWidget>

#include "sessions/session/session.h"
#include "ui/views/display_image.h"

class QBoxLayout;
class QCheckBox;
class QComboBox;
class QLabel;
class QPushButton;
class QSpinBox;

namespace boresight::ui {

/// Gray levels: how the image is shown, which changes no run, and apart from it how the file's
/// samples become the 8 bits that the core is given, which is an edit of the document.
class LevelsPanel : public QWidget {
  Q_OBJECT

 public:
  explicit LevelsPanel(DisplayImage& display, QWidget* parent = nullptr);

  /// nullptr: no conversion can be edited. `image` is the case's as it was read: its rule and depth
  /// are those that hold now, which a label may have stated.
  void setCase(const sessions::SessionCase* one, const sessions::GrayImage* image,
               int cases_of_camera);

 Q_SIGNALS:
  /// For this case, or for all cases of its camera.
  void conversionRequested(const boresight::sessions::ImageReadOptions& eight_bit,
                           bool whole_camera);

 private:
  void buildDisplay(QBoxLayout& layout);
  void buildConversion(QBoxLayout& layout);
  void showLevels();
  void showConversion();
  void updateConversion();
  sessions::ImageReadOptions chosenConversion() const;
  int sampleBits() const;

  DisplayImage& display_;
  std::optional<sessions::ImageReadOptions> current_;
  int current_bits_ = 8;        ///< of the rule that holds now
  bool bits_of_label_ = false;  ///< nobody stated them but the image's label
  int cases_of_camera_ = 0;
  int shown_bits_ = 0;  ///< of the samples that the conversion was shown for
  QCheckBox* core_ = nullptr;
  QSpinBox* black_ = nullptr;
  QSpinBox* white_ = nullptr;
  QPushButton* automatic_ = nullptr;
  QPushButton* full_ = nullptr;
  QLabel* rule_ = nullptr;
  QComboBox* kind_ = nullptr;
  QSpinBox* bit_depth_ = nullptr;
  QSpinBox* core_black_ = nullptr;
  QSpinBox* core_white_ = nullptr;
  QPushButton* from_display_ = nullptr;
  QCheckBox* whole_camera_ = nullptr;
  QPushButton* apply_ = nullptr;
};

}  // namespace boresight::ui
