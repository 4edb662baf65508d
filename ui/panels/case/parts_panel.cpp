// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/case/parts_panel.h"

#include <QtWidgets>

#include "ui/models/text.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/widgets/column_fitter.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {
namespace {

QTableWidgetItem* textItem(const QString& text, const QString& tip = {}) {
  auto* item = new QTableWidgetItem(text);
  item->setToolTip(tip.isEmpty() ? text : tip);
  return item;
}

}  // namespace

PartsPanel::PartsPanel(Document& document, ViewState& state) : document_(document), state_(state) {
  ui_.setupUi(this);
  styleTable(*ui_.parts);
  new ColumnFitter(*ui_.parts, {kMesh, kFrame});
  connect(ui_.parts, &QTableWidget::itemChanged, this, [this](const QTableWidgetItem* item) {
    if (filling_ || item->column() != kPresent) return;
    const sessions::SessionCase* shown = shownCase(document_, state_);
    const auto row = static_cast<std::size_t>(item->row());
    if (!shown || row >= shown->parts.size()) return;
    sessions::PartState changed = shown->parts[row].source.state;
    changed.present = item->checkState() == Qt::Checked;
    change(item->row(), changed);
  });
  connectEach(document_, this, &PartsPanel::showCase, &Document::opened, &Document::changed);
  state_.onChange(ViewChange::kCase, this, &PartsPanel::showCase);
  showCase();
}

void PartsPanel::showCase() {
  Shown now;
  now.editable = document_.isEditable();
  if (const sessions::SessionCase* shown = shownCase(document_, state_))
    for (const auto& part : shown->parts) now.parts.push_back(part.source);
  if (shown_ == now) return;  // a list that is open stays
  shown_ = std::move(now);
  filling_ = true;
  ui_.parts->setRowCount(0);
  ui_.parts->setRowCount(static_cast<int>(shown_->parts.size()));
  for (int row = 0; row < ui_.parts->rowCount(); ++row)
    addPart(row, shown_->parts[static_cast<std::size_t>(row)], shown_->editable);
  ui_.parts->resizeColumnsToContents();
  filling_ = false;
}

void PartsPanel::addPart(int row, const sessions::PartSource& part, bool editable) {
  auto* present = new QTableWidgetItem;
  present->setFlags(Qt::ItemIsSelectable | Qt::ItemIsUserCheckable |
                    (editable ? Qt::ItemIsEnabled : Qt::NoItemFlags));
  present->setCheckState(part.state.present ? Qt::Checked : Qt::Unchecked);
  ui_.parts->setItem(row, kPresent, present);
  ui_.parts->setItem(
      row, kName, textItem(fromText(sessions::partName(part)), fromText(sessions::partText(part))));
  auto* role = new QComboBox;
  for (const char* name : sessions::kPartRoleNames) role->addItem(QLatin1String(name));
  role->setCurrentIndex(static_cast<int>(part.state.role));
  role->setEnabled(editable);
  connect(role, QOverload<int>::of(&QComboBox::activated), this,
          [this, row, state = part.state](int index) mutable {
            state.role = static_cast<sessions::PartRole>(index);
            change(row, state);
          });
  ui_.parts->setCellWidget(row, kRole, role);
  ui_.parts->setItem(row, kFrame, textItem(fromText(sessions::frameText(part.frame))));
  ui_.parts->setItem(
      row, kMesh, textItem(fromText(part.mesh.filename().string()), fromText(part.mesh.string())));
}

/// After the signal: the table is filled again by the edit.
void PartsPanel::change(int row, const sessions::PartState& state) {
  QMetaObject::invokeMethod(
      this,
      [this, row, state] {
        const sessions::SessionCase* shown = shownCase(document_, state_);
        if (!shown || row >= static_cast<int>(shown->parts.size())) return;
        const auto index = static_cast<std::size_t>(row);
        const QString name = fromText(sessions::partName(shown->parts[index].source));
        try {
          document_.edit(
              sessions::withPartState(document_.session(), shown->id, index, state),
              tr("%1 of %2: %3")
                  .arg(name, fromText(shown->id), fromText(sessions::partStateText(state))));
        } catch (const std::exception& error) {
          Q_EMIT failed(QString::fromUtf8(error.what()));
        }
        shown_.reset();  // also what was refused
        showCase();
      },
      Qt::QueuedConnection);
}

}  // namespace boresight::ui
