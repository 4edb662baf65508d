// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <QStringList>
#include <QWidget>

#include "ui_runs_panel.h"

#include "sessions/review/run_difference.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

class Document;
class ViewState;

/// The runs of the shown case, pinned ones first, then the newest, each with its changes since the
/// run before. Each can be opened in every view or compared with the shown one. Pins are stored in
/// the program's settings.
class RunsPanel : public QWidget {
  Q_OBJECT

 public:
  RunsPanel(Document& document, ViewState& state);

  /// Whether the runs are still being compared.
  bool isBusy() const { return reader_.isBusy(); }

 Q_SIGNALS:
  /// The list cannot be read; one sentence.
  void failed(const QString& message);
  void openRequested(const std::string& digest);
  void compareRequested(const std::string& digest);

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  /// What the list shows.
  struct Listed {
    std::vector<sessions::RunRecord> runs = {};
    QStringList pinned = {};
    std::string shown = {};  ///< digest of the run in the views

    bool operator==(const Listed&) const = default;
  };

  void fill();
  void askForLines(const std::vector<sessions::RunRecord>& runs);
  void showLines();
  void pin(const std::string& digest);
  void showMenu(const QPoint& at);
  std::string chosen() const;

  Document& document_;
  ViewState& state_;
  QStringList pinned_;  ///< digests
  Listed listed_;
  std::vector<sessions::RunRecord> read_;     ///< runs of the lines, in the order of the session
  std::vector<sessions::RunListLine> lines_;  ///< of `read_`; empty until they are read
  TaskRunner reader_;
  TaskKind reading_;
  Ui::RunsPanel ui_;
};

}  // namespace boresight::ui
