// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <QObject>
#include <QPointF>

#include "ui/scene/scene_loupe.h"
#include "ui/scene/scene_marks.h"

class QKeyEvent;
class QMouseEvent;
class QPainter;

namespace boresight::ui {

class StationSnapper;

/// Annotating in the scene. While somebody places marks, a click gives the station's side: the
/// corner, edge, circle centre or named point that is shown beside the pointer before, or with Alt
/// held the surface itself; Tab goes on to another thing to snap to. In line mode it is the edge
/// that is lit. Otherwise a click on a mark chooses it.
class SceneAnnotator : public QObject {
  Q_OBJECT

 public:
  /// Belongs to the canvas.
  SceneAnnotator(QWidget& canvas, AnnotationController& annotation, StationSnapper& snapper);

  bool places() const;
  /// What the scene shows now.
  void setShot(const SceneShot& shot);
  /// True when the click was for a mark. `at`: the canvas' coordinates.
  bool click(const QPointF& at, Qt::KeyboardModifiers modifiers);
  /// Where a click would go; nothing where it would do nothing.
  const std::optional<SceneAim>& aim() const { return aim_; }
  const std::vector<SceneMark>& marks() const { return marks_; }
  SceneLoupe& loupe() const { return *loupe_; }
  /// Cameras of the rig that are solved with this one, as the solved poses put them.
  std::vector<Frustum> rigFrusta(const Eigen::Vector3d& centre_m) const;
  /// The place that a click would mark, in words and figures.
  QString place() const;
  /// What is to be done next, or empty.
  QString nextStep() const;
  void paint(QPainter& painter, const QRectF& area) const;

 Q_SIGNALS:
  void changed();  ///< what it paints
  /// One sentence for people.
  void told(const QString& sentence);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void showMode();
  void showMarks();
  void hover(const QMouseEvent& event);
  void leave();
  bool takesKey(const QKeyEvent& event) const;
  bool pressKey(const QKeyEvent& event);
  void escape();
  void setModifiers(Qt::KeyboardModifiers modifiers);
  void updateAim();
  bool completesPoint() const;
  void placeAim();
  const sessions::MeshSnapper* mesh() const;

  QWidget& canvas_;
  AnnotationController& annotation_;
  StationSnapper& snapper_;
  SceneLoupe* loupe_;
  SceneShot shot_;
  std::vector<SceneMark> marks_;
  std::optional<QPointF> pointer_;  ///< pixel of the canvas
  Qt::KeyboardModifiers modifiers_;
  int turn_ = 0;
  QPointF turned_at_;  ///< pixel
  std::optional<SceneAim> aim_;
};

}  // namespace boresight::ui
