// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QWidget>

#include "ui_levels_panel.h"

#include "sessions/session/session.h"
#include "ui/views/display_image.h"

namespace boresight::ui {

/// Gray levels of the display, which changes no run, and of the conversion of the file's samples to
/// the 8 bits of the core, an edit of the document.
class LevelsPanel : public QWidget {
  Q_OBJECT

 public:
  explicit LevelsPanel(DisplayImage& display);

  /// nullptr: no conversion can be edited. `image` is the case's image as read, with the rule and
  /// depth in force, which a label may have stated.
  void setCase(const sessions::SessionCase* session_case, const sessions::GrayImage* image,
               int cases_of_camera);

 Q_SIGNALS:
  /// A conversion of this case's image, or of all images of its camera.
  void conversionRequested(const boresight::sessions::ImageReadOptions& eight_bit,
                           bool whole_camera);

 private:
  void showLevels();
  void showConversion();
  void updateConversion();
  sessions::ImageReadOptions chosenConversion() const;
  int sampleBits() const;

  DisplayImage& display_;
  std::optional<sessions::ImageReadOptions> current_;
  int current_bits_ = 8;        ///< of the rule in force
  bool bits_of_label_ = false;  ///< only the image's label states them
  int cases_of_camera_ = 0;
  int shown_bits_ = 0;  ///< of the samples that the conversion was shown for
  Ui::LevelsPanel ui_;
};

}  // namespace boresight::ui
