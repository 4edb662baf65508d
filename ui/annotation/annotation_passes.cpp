// SPDX-License-Identifier: Apache-2.0
// Passes of several people, the station's landmarks, and what becomes of a solved pose.
#include "ui/annotation/annotation_controller.h"

#include <utility>

#include "sessions/session/rig_links.h"
#include "ui/models/number_text.h"
#include "ui/state/document.h"

#include "sessions/text/utc_time.h"

namespace boresight::ui {

sessions::AnnotationPasses AnnotationController::passesOfCase() const {
  const auto& passes = document_.session().passes;
  const auto found = passes.find(case_id_);
  return found == passes.end() ? sessions::AnnotationPasses() : *found->second;
}

void AnnotationController::setPasses(sessions::AnnotationPasses passes,
                                     const sessions::Marks& marks, const QString& text) {
  if (case_id_.empty()) return;
  const sessions::Session with_marks =
      sessions::withAnnotation(document_.session(), case_id_, marks);
  document_.edit(sessions::withPasses(with_marks, case_id_, std::move(passes)), text);
}

void AnnotationController::putAside(const QString& by) {
  finishMove();
  const std::string name = by.trimmed().toStdString();
  if (name.empty() || marks_.empty()) return;
  sessions::AnnotationPasses passes = passesOfCase();
  passes.push_back({name, sessions::utcNowText(), marks_});
  setPasses(std::move(passes), sessions::blindMarks(marks_),
            tr("Put the marks of %1 aside").arg(by.trimmed()));
}

void AnnotationController::takeUp(int pass) {
  finishMove();
  const sessions::AnnotationPasses passes = passesOfCase();
  if (pass < 0 || pass >= static_cast<int>(passes.size())) return;
  const sessions::AnnotationPass& taken = passes[static_cast<std::size_t>(pass)];
  setPasses(sessions::keepingMarks(passes, marks_, sessions::utcNowText()), taken.marks,
            tr("Take up the marks of %1").arg(fromText(taken.by)));
}

void AnnotationController::removePass(int pass) {
  finishMove();
  sessions::AnnotationPasses passes = passesOfCase();
  if (pass < 0 || pass >= static_cast<int>(passes.size())) return;
  const QString by = fromText(passes[static_cast<std::size_t>(pass)].by);
  passes.erase(passes.begin() + pass);
  setPasses(std::move(passes), marks_, tr("Remove the marks of %1").arg(by));
}

void AnnotationController::useAsTruth() {
  finishMove();
  const std::optional<Pose> solved = solvedPose();
  const sessions::SessionCase* one = document_.session().findCase(case_id_);
  if (!one || !solved) return;
  if (stale_) {
    Q_EMIT told(tr("The pose is being solved anew; try again in a moment."));
    return;
  }
  const bool replaces = one->camera_from_station_truth.has_value();
  const std::string excess = answer_.solution->sigmaExcess();
  sessions::SessionCase changed = *one;
  sessions::setTruth(changed, *solved, answer_.covariance);
  document_.edit(sessions::withCase(document_.session(), std::move(changed)),
                 tr("Take the annotated pose of %1 as its truth").arg(fromText(case_id_)));
  QString text =
      (replaces ? tr("The annotated pose has replaced the truth that %1 had; Undo brings it "
                     "back.")
                : tr("The annotated pose is the truth of %1 now."))
          .arg(fromText(case_id_));
  if (!excess.empty())
    text += tr(" Its one sigma is %1: it can hardly judge a result.").arg(fromText(excess));
  Q_EMIT told(text);
}

void AnnotationController::linkCase(const std::string& other_id, const Pose& other_from_case) {
  finishMove();
  const sessions::Session& session = document_.session();
  if (!session.findCase(case_id_) || !session.findCase(other_id)) return;
  document_.edit(sessions::withRigLink(session, case_id_, other_id, other_from_case),
                 tr("Link %1 with %2").arg(fromText(other_id), fromText(case_id_)));
}

void AnnotationController::unlinkCase() {
  finishMove();
  document_.edit(sessions::withoutRigLink(document_.session(), case_id_),
                 tr("Take %1 out of its rig").arg(fromText(case_id_)));
}

void AnnotationController::setLandmarksFile(const std::filesystem::path& file) {
  const sessions::SessionCase* one = document_.session().findCase(case_id_);
  if (!one) return;
  landmarks_file_.reset();  // read anew, also where only its content has changed
  const std::vector<sessions::MeshInput> parts = one->parts;
  sessions::Session session = document_.session();
  for (const auto& each : document_.session().cases) {
    if (!(each->parts == parts)) continue;
    sessions::SessionCase changed = *each;
    changed.landmarks = file;
    session = sessions::withCase(session, std::move(changed));
  }
  if (!document_.edit(session,
                      tr("Use the landmarks of %1").arg(fromText(file.filename().string()))))
    return;
  showLandmarks();
  askIfChanged(false);
}

}  // namespace boresight::ui
