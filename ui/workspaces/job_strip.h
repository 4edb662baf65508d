// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QFrame>
#include <QString>

class QLabel;
class QProgressBar;
class QPushButton;

namespace boresight::ui {

/// What runs, or what has been done.
struct Job {
  QString name;    ///< "Running all cases", "Ready"
  QString detail;  ///< "bc-000035, iteration 2"
  int done = 0;
  int of = 0;  ///< 0: nothing to count
  std::optional<double> seconds_left;
  bool runs = false;

  bool operator==(const Job&) const = default;
};

/// "3 s", "2 min".
QString durationText(double seconds);

/// Below every workspace: what runs, how far it is, and one Stop; at the right the place under the
/// pointer and whether the session is saved.
class JobStrip : public QFrame {
  Q_OBJECT

 public:
  explicit JobStrip(QWidget* parent = nullptr);

  void setJob(const Job& job);
  const Job& job() const { return job_; }
  /// A remark that passes; while it stands it takes the place of the detail.
  void setNote(const QString& note);
  void setPlace(const QString& place);
  void setSaved(const QString& saved);
  QPushButton& stop() { return *stop_; }

 Q_SIGNALS:
  void stopRequested();

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void showDetail();

  Job job_;
  QString note_;
  QLabel* name_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QLabel* count_ = nullptr;
  QLabel* left_ = nullptr;
  QPushButton* stop_ = nullptr;
  QLabel* detail_ = nullptr;
  QLabel* place_ = nullptr;
  QLabel* saved_ = nullptr;
};

}  // namespace boresight::ui
