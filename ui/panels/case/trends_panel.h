// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include <QWidget>

#include "ui_trends_panel.h"

#include "sessions/report/trends.h"
#include "sessions/session/session.h"
#include "ui/models/rows_model.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

class Document;
class DoublePlot;

/// Corrections and residuals, one row per case with a converged run, in the order of time.
class TrendsModel : public RowsModel<sessions::TrendPoint> {
  Q_OBJECT

 public:
  enum Column { kCase, kFirstFigure, kReview = kFirstFigure + sessions::kTrendFigures };

  TrendsModel();

 protected:
  QVariant look(const sessions::TrendPoint& row, int column, int role) const override;
};

/// Trends of the session's runs, and those of further sessions (sols): a table, and a plot of one
/// correction with the residual. Outliers are marked. A double click opens a case of the session.
class TrendsPanel : public QWidget {
  Q_OBJECT

 public:
  explicit TrendsPanel(Document& document);

  const TrendsModel& model() const { return model_; }
  /// Sessions that come before the shown one, in the order of time. They are read again.
  void setEarlier(std::vector<std::filesystem::path> files);
  bool isBusy() const { return reader_.isBusy(); }

 Q_SIGNALS:
  void openRequested(const QString& case_id);

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  struct Trend {
    std::vector<sessions::TrendPoint> points;
    QStringList remarks;
  };

  void follow();
  bool isRead() const;
  void take(const Trend& trend);
  void showFigure();
  void askForEarlier();

  Document& document_;
  TrendsModel model_;
  std::vector<std::filesystem::path> earlier_;
  sessions::Session read_session_;                 ///< of which the trend is
  std::vector<std::filesystem::path> read_files_;  ///< of the earlier ones and of this one
  TaskRunner reader_;
  TaskKind reading_;
  DoublePlot* plot_ = nullptr;
  Ui::TrendsPanel ui_;
};

}  // namespace boresight::ui
