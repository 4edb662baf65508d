// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <QWidget>

#include "sessions/run/match_details.h"
#include "sessions/run/score_map.h"
#include "sessions/run/trace.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

namespace Ui {
class MatchView;
}

/// The story of one match: its template, what was found, where they agree, the scores around, and
/// the figures.
class MatchView : public QWidget {
  Q_OBJECT

 public:
  explicit MatchView(QWidget* parent = nullptr);
  ~MatchView() override;

  /// The iteration must hold the template. Its score map is computed off the UI's thread.
  void showMatch(std::shared_ptr<const sessions::EdgeMapTrace> edges,
                 std::shared_ptr<const sessions::IterationTrace> iteration, int template_index);
  /// Whether the score map is still to come.
  bool isComputing() const { return runner_.isBusy(); }
  /// A sentence instead.
  void showNote(const QString& note);

 private:
  void showPictures(const sessions::EdgeMapTrace& edges, const sessions::IterationTrace& iteration,
                    std::size_t index, const Match* match);
  void showFigures(const sessions::IterationTrace& iteration,
                   const sessions::MatchDetails& details);

  const std::unique_ptr<Ui::MatchView> ui_;
  TaskRunner runner_;  ///< the newest template counts
};

}  // namespace boresight::ui
