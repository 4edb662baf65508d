// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <QObject>
#include <QString>

#include "sessions/record/onboard_review.h"
#include "ui/run/task_runner.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

class Document;

/// The current case's onboard record: attached by an edit of the document, read and replayed on a
/// worker thread. Shown instead of the ground's run on request, and compared with it whenever
/// either changes.
class OnboardController : public QObject {
  Q_OBJECT

 public:
  using ReviewPtr = std::shared_ptr<const sessions::OnboardReview>;
  using ComparisonPtr = std::shared_ptr<const sessions::RecordComparison>;

  OnboardController(Document& document, ViewState& state, TaskRunner& tasks);

  /// The file that is attached to the current case, or empty.
  std::filesystem::path file() const;
  /// nullptr until it is read, or when it cannot be.
  const ReviewPtr& review() const { return review_; }
  const CaseOpening& opening() const { return state_.opening(); }
  /// Why the record cannot be shown, or empty.
  const QString& problem() const { return problem_; }
  /// nullptr until both runs exist; then whyNotCompared() is empty.
  const ComparisonPtr& comparison() const { return comparison_; }
  /// Why there is no comparison, as a sentence; or empty.
  QString whyNotCompared() const;
  /// Whether the views show the onboard run.
  bool showsOnboard() const;

 public Q_SLOTS:
  /// Attaches a record to the current case; an edit that can be undone.
  void attach(const std::filesystem::path& file);
  void detach();
  void showOnboard();
  void showGround();
  /// Runs the case on the ground with the record's options.
  void rerun();
  /// Moves every view to the first difference of the runs.
  void goToFirstDifference();

 Q_SIGNALS:
  /// Any of the values above.
  void changed();
  void rerunRequested(const boresight::sessions::RunPlan& plan);
  void failed(const QString& message);
  /// A remark for the operator.
  void told(const QString& message);

 private:
  void snapshotChanged();
  void readAgain();
  void takeReview(const ViewState::CasePtr& loaded_case, ReviewPtr review, const QString& problem);
  bool groundIsOfTheCase() const;
  void compareAgain();
  void attachAs(std::optional<sessions::InputFile> record, const QString& text);

  Document& document_;
  ViewState& state_;
  TaskRunner& tasks_;
  ReviewPtr review_;
  QString problem_;
  ViewState::SnapshotPtr ground_;
  std::shared_ptr<const sessions::LoadedCase> ground_case_;  ///< when the run was taken
  ComparisonPtr comparison_;
  TaskKind reading_;
  TaskKind comparing_;
  std::optional<sessions::InputFile> read_;  ///< the record of `review_` or `problem_`
};

}  // namespace boresight::ui
