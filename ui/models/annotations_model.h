// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "sessions/annotation/mesh_snap.h"
#include "sessions/session/case_annotations.h"
#include "ui/models/rows_model.h"

namespace boresight::ui {

/// A row's annotation: the data common to points and lines, and its result in the solved pose. The
/// pointers are valid until the annotations change.
struct AnnotationRow {
  const sessions::PointPair* point = nullptr;  ///< nullptr where it is a line
  const sessions::LinePair* line = nullptr;    ///< nullptr where it is a point
  std::string id;
  std::string comment;
  double sigma_px = 0.0;
  bool enabled = true;
  bool locked = false;
  bool complete = false;
  std::optional<Eigen::Vector2d> pixel;               ///< for a line, its first position
  std::optional<Eigen::Vector3d> point_in_station_m;  ///< for a line, the edge's start
  QString station_kind;  ///< "corner", "circle centre", "edge" or "surface"; empty: not known
  std::optional<sessions::SolvedAnnotation> solved;
  std::optional<sessions::LeftOut> left_out;

  bool isOutlier() const { return solved && solved->isOutlier(); }
};

/// The annotations of one image, points before lines, one row each, with their results in the
/// solved pose. Edits are only reported: the owner of the annotations answers by setting them
/// again.
class AnnotationsModel : public RowsModel<AnnotationRow> {
  Q_OBJECT

 public:
  enum Column {
    kOn,
    kName,
    kU_px,
    kV_px,
    kX_mm,
    kY_mm,
    kZ_mm,
    kStationKind,
    kResidualX_px,
    kResidualY_px,
    kNormalized,
    kWithout_mm,
    kWithout_mrad,
    kResidualX_mm,
    kResidualY_mm,
    kSigma_px,
    kLocked,
    kComment,
  };
  /// Filter of the listed annotations.
  enum class Show { kAll, kUsed, kOff, kHalfMade, kStandOut, kLines };

  using SolutionPtr = std::shared_ptr<const sessions::CaseAnnotationsSolution>;

  AnnotationsModel();

  void setAnnotations(const sessions::Annotations& annotations);
  /// The solution of these annotations; residuals of annotations moved since are dimmed. nullptr:
  /// none.
  void setSolution(SolutionPtr solution, bool stale);

  /// Determines the kind of a point of the station. nullptr: kinds are not known.
  void setMesh(std::shared_ptr<const sessions::MeshSnapper> mesh);

  const sessions::Annotations& annotations() const { return annotations_; }
  const std::string& idOf(int row) const { return at(row).id; }
  int rowOf(const std::string& id) const;  ///< -1 when there is none
  /// The names of `Show`, in its order.
  static QStringList showNames();
  bool isShown(int row, Show show) const;

  bool setData(const QModelIndex& index, const QVariant& value, int role = Qt::EditRole) override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;

 Q_SIGNALS:
  /// The new value of the annotation of this id, and the name of the edit.
  void pointEdited(const std::string& replaced, const boresight::sessions::PointPair& point,
                   const QString& text);
  void lineEdited(const std::string& replaced, const boresight::sessions::LinePair& line,
                  const QString& text);

 protected:
  QVariant look(const AnnotationRow& row, int column, int role) const override;

 private:
  void fillRows();
  QString stationKind(const AnnotationRow& row);

  sessions::Annotations annotations_;
  SolutionPtr solution_;
  std::shared_ptr<const sessions::MeshSnapper> mesh_;
  /// Kinds of points determined so far, by their coordinates.
  std::map<std::array<double, 3>, QString> kinds_;
  bool stale_ = false;
};

}  // namespace boresight::ui
