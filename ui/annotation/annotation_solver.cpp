// SPDX-License-Identifier: Apache-2.0
#include "ui/annotation/annotation_solver.h"

#include <utility>

#include "core/geometry/mesh.h"

namespace boresight::ui {
namespace {

const QString kKey = QStringLiteral("solve marks");

AnnotationSolver::PassAnswer answerOf(const sessions::AnnotationPass& pass,
                                      const AnnotationSolver::Question& asked) {
  AnnotationSolver::PassAnswer made;
  made.by = pass.by;
  made.time = pass.time;
  const sessions::MarkedView& at_work = asked.marks.views.front();
  made.repeatability = sessions::repeatability(pass.marks, at_work.marks);
  sessions::MarkedView view = at_work;
  view.camera_from_rig = Pose();
  view.marks = pass.marks;
  sessions::SolveMarksOptions options;
  options.robust = asked.robust;
  options.rig_from_station_guess = asked.camera_from_station_guess;
  const sessions::MarksResult result = sessions::solveMarks({&view, 1}, options);
  if (result.solution) made.camera_from_station = result.solution->camera_from_station.front();
  return made;
}

AnnotationSolver::Answer answer(const AnnotationSolver::Question& asked) {
  AnnotationSolver::Answer made;
  const MeshView mesh = asked.one->scene.view();
  auto solution = std::make_shared<sessions::CaseMarksSolution>(
      sessions::solveCaseMarks(asked.marks, asked.camera_from_station_guess,
                               sessions::boxCorners(matchedBounds(mesh)), asked.robust));
  if (const auto pose = solution->camera_from_station()) {
    const sessions::MarkedView& view = solution->marks.views.front();
    made.covariance = solution->covariance();
    made.proposals = sessions::proposeMarks(asked.landmarks, view.marks, mesh, view.camera, *pose,
                                            &*made.covariance);
  }
  for (const sessions::AnnotationPass& pass : asked.passes)
    made.passes.push_back(answerOf(pass, asked));
  made.solution = std::move(solution);
  return made;
}

}  // namespace

AnnotationSolver::AnnotationSolver(QObject* parent) : QObject(parent) {
  connect(&runner_, &TaskRunner::failed, this, &AnnotationSolver::failed);
}

void AnnotationSolver::ask(Question question) {
  runner_.start(
      kKey, [question = std::move(question)](const std::stop_token&) { return answer(question); },
      [this](const Answer& made) { Q_EMIT solved(made); });
}

void AnnotationSolver::drop() { runner_.cancel(kKey); }

}  // namespace boresight::ui
