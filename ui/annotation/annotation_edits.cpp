// SPDX-License-Identifier: Apache-2.0
// Edits of the document: annotations, annotation rounds, landmarks, and the use of a solved pose.
#include "ui/annotation/annotation_controller.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "sessions/annotation/annotations.h"
#include "sessions/annotation/annotations_on_image.h"
#include "sessions/annotation/landmarks.h"
#include "sessions/review/annotated_seed.h"
#include "sessions/session/rig_links.h"
#include "sessions/text/utc_time.h"
#include "ui/models/text.h"
#include "ui/state/document.h"

namespace boresight::ui {

using sessions::Annotations;
using sessions::LinePair;
using sessions::PointPair;

/// Adds an annotation, or replaces the one of its id, and selects it. `text` names its id as %1.
template <class Pair>
bool AnnotationController::put(const Pair& pair, const QString& text) {
  if (!commit(sessions::withPair(annotations_, pair.id, pair), text.arg(fromText(pair.id))))
    return false;
  select(pair.id);
  return true;
}

/// Completes the chosen pair where it lacks this side and is not locked, else begins a new one.
template <class Pair, class Side>
std::string AnnotationController::place(const Pair* chosen, std::optional<Side> Pair::*side,
                                        const Side& value, const QString& text) {
  const bool completes = chosen && !(chosen->*side) && !chosen->locked;
  Pair pair = completes ? *chosen : Pair();
  if (!completes) {
    pair.id = sessions::unusedId(annotations_, std::is_same_v<Pair, PointPair> ? 'p' : 'l');
    pair.sigma_px = sigma_px_;
  }
  pair.*side = value;
  return put(pair, text) ? pair.id : std::string();
}

std::string AnnotationController::placeInImage(const Eigen::Vector2d& pixel) {
  finishMove();
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  if (!loaded_case) return {};
  if (!sessions::isInImage(loaded_case->source.camera, pixel)) {
    Q_EMIT told(tr("This position is outside the image; click on the image."));
    return {};
  }
  return place(selectedPoint(), &PointPair::pixel, pixel, tr("Place %1 on the image"));
}

std::string AnnotationController::placeOnStation(const Eigen::Vector3d& point_in_station_m) {
  finishMove();
  if (!point_in_station_m.allFinite()) return {};
  return place(selectedPoint(), &PointPair::point_in_station_m, point_in_station_m,
               tr("Place %1 on the station"));
}

std::string AnnotationController::placeLineInImage(const sessions::ImageLine& line) {
  finishMove();
  if ((line.end - line.start).norm() < 1.0) {
    Q_EMIT told(tr("A line needs two points at least a pixel apart."));
    return {};
  }
  return place(selectedLine(), &LinePair::line, line, tr("Place %1 on the image"));
}

std::string AnnotationController::placeEdgeOnStation(const sessions::ModelEdge& edge) {
  finishMove();
  return place(selectedLine(), &LinePair::edge, edge, tr("Place %1 on the station"));
}

/// Whether an annotation exists and is not locked.
bool AnnotationController::mayChange(const std::string& id) {
  const PointPair* point = sessions::findPoint(annotations_, id);
  const LinePair* line = sessions::findLine(annotations_, id);
  if (!point && !line) return false;
  if (!(point ? point->locked : line->locked)) return true;
  Q_EMIT told(tr("%1 is locked; unlock it in the table to change it.").arg(fromText(id)));
  return false;
}

bool AnnotationController::dragInImage(const std::string& id, const Eigen::Vector2d& pixel,
                                       int end) {
  if (!mayChange(id)) return false;
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  if (!loaded_case || !sessions::isInImage(loaded_case->source.camera, pixel)) return false;
  select(id);
  annotations_ = sessions::withMoved(annotations_, id, end, pixel);
  moving_ = true;
  Q_EMIT annotationsChanged();
  askIfChanged(false);
  return true;
}

void AnnotationController::finishMove() {
  pause_.stop();
  if (!std::exchange(moving_, false)) return;
  if (!commit(annotations_, tr("Move %1").arg(fromText(selected_)))) showDocument();
}

void AnnotationController::cancelMove() {
  pause_.stop();
  if (std::exchange(moving_, false)) showDocument();
}

bool AnnotationController::nudge(const Eigen::Vector2d& by_px, int end) {
  const auto from = selectedPixel(end);
  if (!from || !dragInImage(selected_, *from + by_px, end)) return false;
  pause_.start();
  return true;
}

template <class Pair>
bool AnnotationController::replace(const Pair* before, const Pair& after, const QString& text) {
  if (!before) return false;
  const std::string id = after.id;
  if (id.empty()) {
    Q_EMIT told(tr("An annotation needs a name."));
    return false;
  }
  if (id != before->id && sessions::hasAnnotation(annotations_, id)) {
    Q_EMIT told(tr("The annotation \"%1\" exists; use another name.").arg(fromText(id)));
    return false;
  }
  const bool chosen = selected_ == before->id;
  if (!commit(sessions::withPair(annotations_, before->id, after), text)) return false;
  if (chosen) select(id);
  return true;
}

bool AnnotationController::replacePoint(const std::string& replaced, const PointPair& point,
                                        const QString& text) {
  finishMove();
  return replace(sessions::findPoint(annotations_, replaced), point, text);
}

bool AnnotationController::replaceLine(const std::string& replaced, const LinePair& line,
                                       const QString& text) {
  finishMove();
  return replace(sessions::findLine(annotations_, replaced), line, text);
}

void AnnotationController::remove(const std::string& id) {
  finishMove();
  if (mayChange(id))
    commit(sessions::withoutAnnotation(annotations_, id), tr("Remove %1").arg(fromText(id)));
}

void AnnotationController::setAnnotations(const Annotations& annotations, const QString& text) {
  finishMove();
  commit(annotations, text);
}

PointPair AnnotationController::annotationOf(const sessions::Landmark& landmark) const {
  PointPair point;
  point.id = landmark.name;
  point.point_in_station_m = landmark.point_in_station_m;
  point.sigma_px = sigma_px_;
  point.comment = landmark.comment;
  return point;
}

void AnnotationController::confirm(const sessions::Proposal& proposal,
                                   const Eigen::Vector2d& pixel) {
  finishMove();
  PointPair point = annotationOf(proposal.landmark);
  point.pixel = pixel;
  put(point, tr("Confirm %1"));
}

int AnnotationController::seenProposals() const {
  return static_cast<int>(std::count_if(answer_.proposals.begin(), answer_.proposals.end(),
                                        [](const auto& proposal) { return proposal.seen; }));
}

void AnnotationController::confirmSeen() {
  finishMove();
  const ViewState::CasePtr& loaded_case = state_.currentCase();
  if (!loaded_case) return;
  Annotations confirmed = annotations_;
  int found = 0;
  const int seen = seenProposals();
  for (const sessions::Proposal& proposal : answer_.proposals) {
    if (!proposal.seen || sessions::findPoint(annotations_, proposal.landmark.name)) continue;
    const auto pixel = sessions::featureOf(proposal, loaded_case->image.view());
    if (!pixel) continue;
    ++found;
    PointPair point = annotationOf(proposal.landmark);
    point.pixel = *pixel;
    confirmed = sessions::withPair(std::move(confirmed), point.id, point);
  }
  if (found > 0 && !commit(confirmed, tr("Confirm %1 landmarks").arg(found))) return;
  Q_EMIT told(
      tr("%1 of %2 landmarks match a corner or an ellipse of the image; place the others by hand.")
          .arg(found)
          .arg(seen));
}

void AnnotationController::begin(const sessions::Landmark& landmark) {
  finishMove();
  const PointPair point = annotationOf(landmark);
  if (!sessions::hasAnnotation(annotations_, point.id)) put(point, tr("Begin %1"));
}

sessions::AnnotationRounds AnnotationController::roundsOfCase() const {
  const auto& rounds = document_.session().rounds;
  const auto found = rounds.find(case_id_);
  return found == rounds.end() ? sessions::AnnotationRounds() : *found->second;
}

void AnnotationController::setRounds(sessions::AnnotationRounds rounds,
                                     const sessions::Annotations& annotations,
                                     const QString& text) {
  const sessions::Session with_annotations =
      sessions::withAnnotations(document_.session(), case_id_, annotations);
  document_.edit(sessions::withRounds(with_annotations, case_id_, std::move(rounds)), text);
}

void AnnotationController::putAside(const QString& by) {
  finishMove();
  const std::string name = by.trimmed().toStdString();
  if (name.empty() || annotations_.empty()) return;
  sessions::AnnotationRounds rounds = roundsOfCase();
  rounds.push_back({name, sessions::utcNowText(), annotations_});
  setRounds(std::move(rounds), sessions::blindAnnotations(annotations_),
            tr("Set the annotations of %1 aside").arg(by.trimmed()));
}

void AnnotationController::takeUp(int round) {
  finishMove();
  const sessions::AnnotationRounds rounds = roundsOfCase();
  if (round < 0 || round >= static_cast<int>(rounds.size())) return;
  const sessions::AnnotationRound& taken = rounds[static_cast<std::size_t>(round)];
  setRounds(sessions::keepingAnnotations(rounds, annotations_, sessions::utcNowText()),
            taken.annotations, tr("Continue the annotations of %1").arg(fromText(taken.by)));
}

void AnnotationController::removeRound(int round) {
  finishMove();
  sessions::AnnotationRounds rounds = roundsOfCase();
  if (round < 0 || round >= static_cast<int>(rounds.size())) return;
  const QString by = fromText(rounds[static_cast<std::size_t>(round)].by);
  rounds.erase(rounds.begin() + round);
  setRounds(std::move(rounds), annotations_, tr("Remove the annotations of %1").arg(by));
}

/// Finishes a move, then returns the shown case; nullptr without a solved pose, and, with a
/// message, while the pose is being solved.
const sessions::SessionCase* AnnotationController::finishMoveAndFindSolvedCase() {
  finishMove();
  if (!solvedPose()) return nullptr;
  if (!stale_) return document_.session().findCase(case_id_);
  Q_EMIT told(tr("The pose is being solved again; try again in a moment."));
  return nullptr;
}

void AnnotationController::useAsTruth() {
  const sessions::SessionCase* session_case = finishMoveAndFindSolvedCase();
  if (!session_case) return;
  const bool replaces = session_case->camera_from_station_truth.has_value();
  const sessions::CaseAnnotations& annotations = answer_.solution->annotations;
  const std::string excess =
      sessions::sigmaExcessText(answer_.covariance.value_or(Matrix6d::Zero()),
                                annotations.camera_from_end_effector, annotations.requirement);
  sessions::SessionCase changed = *session_case;
  sessions::setTruth(changed, *solvedPose(), {sessions::TruthOrigin::kAnnotated, "", "", ""},
                     answer_.covariance);
  if (!document_.edit(sessions::withCase(document_.session(), std::move(changed)),
                      tr("Use the annotated pose of %1 as its truth").arg(fromText(case_id_))))
    return;
  QString text =
      (replaces ? tr("The annotated pose has replaced the truth of %1; Undo restores it.")
                : tr("The annotated pose is now the truth of %1."))
          .arg(fromText(case_id_));
  if (!excess.empty())
    text += tr(" Its one sigma is %1, too large to judge a result.").arg(fromText(excess));
  Q_EMIT told(text);
}

void AnnotationController::useAsSeed() {
  const sessions::SessionCase* session_case =
      state_.currentCase() ? finishMoveAndFindSolvedCase() : nullptr;
  if (!session_case) return;
  sessions::SessionCase changed =
      sessions::withMeasuredSeed(*session_case, state_.currentCase()->scene.view(), *solvedPose(),
                                 answer_.covariance.value_or(Matrix6d::Zero()));
  if (!document_.edit(sessions::withCase(document_.session(), std::move(changed)),
                      tr("Use the annotated pose of %1 as its seed").arg(fromText(case_id_))))
    return;
  Q_EMIT told(tr("The annotated pose is the seed of %1, with 3 sigma as its uncertainty.")
                  .arg(fromText(case_id_)));
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

bool AnnotationController::setLandmarksFile(const std::filesystem::path& file) {
  const sessions::SessionCase* session_case = document_.session().findCase(case_id_);
  if (!session_case) return false;
  landmarks_file_.reset();  // read again, also where only its content has changed
  sessions::Session session = document_.session();
  for (const auto& each : document_.session().cases) {
    if (!sessions::sameMeshes(*each, *session_case)) continue;
    sessions::SessionCase changed = *each;
    changed.landmarks = file;
    session = sessions::withCase(session, std::move(changed));
  }
  if (!document_.edit(session,
                      tr("Use the landmarks of %1").arg(fromText(file.filename().string()))))
    return false;
  showLandmarks();
  askIfChanged(false);
  return true;
}

}  // namespace boresight::ui
