// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include <QDialog>

#include "ui_sequence_dialog.h"

#include "ui/run/sequence_runner.h"
#include "ui/run/task_runner.h"
#include "ui/window/window_parts.h"

namespace boresight::ui {

class SequenceModel;

/// Localizes the shown case's station in a sequence of images: asks for images, motion and results,
/// lists the completed frames, and shows the chosen frame with the outline of its pose. Closing it
/// does not stop the run.
class SequenceDialog : public QDialog {
  Q_OBJECT

 public:
  SequenceDialog(WindowParts& parts, QWidget* parent);

  /// A folder, list or video; results go next to it unless they were chosen.
  void setImages(const std::filesystem::path& images);
  void setResults(const std::filesystem::path& results);
  /// Starts with the values of the fields.
  void start();
  QTableView& table() { return *ui_.sequenceFrames; }
  ImageView& picture() { return *ui_.sequencePicture; }

 private:
  void setUpFrames();
  void askForFolder();
  void askForFile();
  void askForResults();
  sessions::SequenceOrder order() const;
  void update();
  void showProgress();
  void showOutcome();
  void showFrame();
  void clearPicture();

  WindowParts& parts_;
  SequenceModel* model_;
  Ui::SequenceDialog ui_;
  std::optional<std::filesystem::path> chosen_results_;  ///< otherwise next to the images
  QString problem_;                                      ///< why it did not start or continue
  TaskRunner pictures_;
  TaskKind showing_;
};

}  // namespace boresight::ui
