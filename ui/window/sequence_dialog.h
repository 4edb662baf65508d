// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include <QDialog>

#include "ui/models/rows_model.h"
#include "ui/run/sequence_runner.h"
#include "ui/run/task_runner.h"
#include "ui/window/window_parts.h"

class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QTableView;

namespace boresight::ui {

class Banner;
class ImageView;

/// The frames of a sequence, one row each.
class SequenceModel : public RowsModel<sessions::SequenceRow> {
  Q_OBJECT

 public:
  explicit SequenceModel(QObject* parent = nullptr);

 protected:
  QVariant look(const sessions::SequenceRow& row, int column, int role) const override;
};

/// Localizes the shown case's station in a sequence of images: asks for images, motion and results,
/// lists the completed frames, and shows the chosen frame with the outline of its pose. Closing it
/// does not stop the run.
class SequenceDialog : public QDialog {
  Q_OBJECT

 public:
  SequenceDialog(const WindowParts& parts, QWidget* parent);

  /// A folder, list or video; results go next to it unless they were chosen.
  void setImages(const std::filesystem::path& images);
  void setResults(const std::filesystem::path& results);
  /// Starts with the values of the fields.
  void start();
  QTableView& table() { return *table_; }
  ImageView& picture() { return *picture_; }

 private:
  QWidget* buildForm();
  QWidget* buildFrames();
  void askForFolder();
  void askForFile();
  void askForResults();
  sessions::SequenceOrder order() const;
  void update();
  void showProgress();
  void showOutcome();
  void showFrame();
  void clearPicture();

  WindowParts parts_;
  SequenceModel* model_;
  QLineEdit* images_;
  QLineEdit* results_;
  QDoubleSpinBox* motion_mm_;
  QDoubleSpinBox* motion_deg_;
  QPushButton* run_;
  QPushButton* cancel_;
  QLabel* progress_;
  Banner* banner_;
  QTableView* table_;
  ImageView* picture_;
  std::filesystem::path chosen_results_;  ///< empty: next to the images
  QString problem_;                       ///< why it did not start or continue
  TaskRunner pictures_;
};

}  // namespace boresight::ui
