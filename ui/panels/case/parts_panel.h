// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <QWidget>

#include "ui_parts_panel.h"

#include "sessions/io/meshes/part_source.h"

namespace boresight::ui {

class Document;
class ViewState;

/// The state of the shown case's station: which parts are present, and the role of each for the
/// localizer. Every change is an edit.
class PartsPanel : public QWidget {
  Q_OBJECT

 public:
  PartsPanel(Document& document, ViewState& state);

 Q_SIGNALS:
  /// A state that is not allowed; one sentence.
  void failed(const QString& message);

 private:
  enum Column { kPresent, kName, kRole, kFrame, kMesh };

  /// What the table shows.
  struct Shown {
    std::vector<sessions::PartSource> parts = {};
    bool editable = false;

    bool operator==(const Shown&) const = default;
  };

  void showCase();
  void addPart(int row, const sessions::PartSource& part, bool editable);
  void change(int row, const sessions::PartState& state);

  Document& document_;
  ViewState& state_;
  bool filling_ = false;
  std::optional<Shown> shown_;
  Ui::PartsPanel ui_;
};

}  // namespace boresight::ui
