// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <QAbstractTableModel>

#include "sessions/session/case_marks.h"

namespace boresight::ui {

/// A row's mark and what points and lines have in common. Refers to the marks; valid until these
/// change.
struct MarkFacts {
  const sessions::PointPair* point;  ///< nullptr where it is a line
  const sessions::LinePair* line;    ///< nullptr where it is a point
  const std::string& id;
  const std::string& comment;
  double sigma_px;
  bool enabled;
  bool locked;
  bool complete;
  std::optional<Eigen::Vector2d> pixel;               ///< of a line its first place
  std::optional<Eigen::Vector3d> point_in_station_m;  ///< of a line the edge's start
};

/// The marks of one image, points before lines, one row each, with what the solved pose says of
/// them. What a person edits is told, not done: who owns the marks answers by setting them anew.
class MarksModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column {
    kOn,
    kName,
    kU_px,
    kV_px,
    kResidualX_px,
    kResidualY_px,
    kNormalized,
    kWithout_mm,
    kWithout_mrad,
    kResidualX_mm,
    kResidualY_mm,
    kX_mm,
    kY_mm,
    kZ_mm,
    kSigma_px,
    kLocked,
    kComment,
    kColumnCount,
  };
  /// A cell as a number to sort by (texts sort by themselves); NaN where there is none.
  static constexpr int kNumberRole = Qt::UserRole;

  using SolutionPtr = std::shared_ptr<const sessions::CaseMarksSolution>;

  explicit MarksModel(QObject* parent = nullptr);

  void setMarks(const sessions::Marks& marks);
  /// Of these marks; residuals of marks that moved since are shown dimmed. nullptr: none.
  void setSolution(SolutionPtr solution, bool stale);

  const sessions::Marks& marks() const { return marks_; }
  MarkFacts factsOf(int row) const;
  const std::string& idOf(int row) const { return factsOf(row).id; }
  int rowOf(const std::string& id) const;  ///< -1 when there is none
  bool standsOut(int row) const;           ///< of the solution, stale or not

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role = Qt::EditRole) override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 Q_SIGNALS:
  /// What the mark of this id should become, and what to call it.
  void pointEdited(const std::string& replaced, const boresight::sessions::PointPair& point,
                   const QString& text);
  void lineEdited(const std::string& replaced, const boresight::sessions::LinePair& line,
                  const QString& text);

 private:
  struct Judged {
    std::optional<sessions::SolvedMark> solved;
    std::optional<sessions::LeftOut> left_out;
  };

  double numberOf(int row, int column) const;
  QVariant display(int row, int column) const;
  QVariant state(int row, int column) const;
  void judge();

  sessions::Marks marks_;
  SolutionPtr solution_;
  bool stale_ = false;
  std::vector<Judged> judged_;  ///< by row
};

}  // namespace boresight::ui
