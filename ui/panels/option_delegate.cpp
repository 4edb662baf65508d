// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/option_delegate.h"

#include <algorithm>
#include <limits>

#include <QAbstractProxyModel>
#include <QComboBox>
#include <QLineEdit>
#include <QSpinBox>

#include "ui/models/number_text.h"
#include "ui/models/options_model.h"

namespace boresight::ui {

using sessions::OptionDescription;
using sessions::OptionKind;

namespace {

constexpr int kLowest = std::numeric_limits<int>::min();
constexpr int kHighest = std::numeric_limits<int>::max();

/// Arrows and wheel stay in range; what is typed may leave it, so that the refusal can be told
/// instead of the number being changed silently.
class IntegerBox : public QSpinBox {
 public:
  IntegerBox(int low, int high, QWidget* parent) : QSpinBox(parent), low_(low), high_(high) {
    setRange(kLowest, kHighest);
    setFrame(false);
  }
  void stepBy(int steps) override { setValue(std::clamp(value() + steps, low_, high_)); }

 private:
  int low_;
  int high_;
};

const OptionDescription* describe(const QModelIndex& index) {
  QModelIndex source = index;
  while (const auto* proxy = qobject_cast<const QAbstractProxyModel*>(source.model()))
    source = proxy->mapToSource(source);
  const auto* model = qobject_cast<const OptionsModel*>(source.model());
  return model ? model->option(source) : nullptr;
}

bool fitsInteger(const OptionDescription& option) {
  return option.kind == OptionKind::kInteger && option.minimum >= kLowest &&
         option.maximum <= kHighest;
}

}  // namespace

QWidget* OptionDelegate::createEditor(QWidget* parent, const QStyleOptionViewItem& /*option*/,
                                      const QModelIndex& index) const {
  const OptionDescription* option = describe(index);
  if (option == nullptr) return nullptr;
  QWidget* editor = nullptr;
  if (option->kind == OptionKind::kChoice) {
    auto* box = new QComboBox(parent);
    for (const std::string& choice : option->choices) box->addItem(fromText(choice));
    editor = box;
  } else if (fitsInteger(*option)) {
    editor = new IntegerBox(static_cast<int>(option->minimum), static_cast<int>(option->maximum),
                            parent);
  } else {
    auto* line = new QLineEdit(parent);
    line->setFrame(false);
    editor = line;
  }
  editor->setAutoFillBackground(true);
  editor->setToolTip(tr("%1 %2").arg(OptionsModel::rangeText(*option), fromText(option->unit)));
  return editor;
}

void OptionDelegate::setEditorData(QWidget* editor, const QModelIndex& index) const {
  const QString text = index.data(Qt::EditRole).toString();
  if (auto* box = qobject_cast<QComboBox*>(editor)) {
    box->setCurrentText(text);
  } else if (auto* number = qobject_cast<QSpinBox*>(editor)) {
    number->setValue(text.toInt());
  } else if (auto* line = qobject_cast<QLineEdit*>(editor)) {
    line->setText(text);
  }
}

void OptionDelegate::setModelData(QWidget* editor, QAbstractItemModel* model,
                                  const QModelIndex& index) const {
  if (auto* box = qobject_cast<QComboBox*>(editor)) {
    model->setData(index, box->currentText());
  } else if (auto* number = qobject_cast<QSpinBox*>(editor)) {
    number->interpretText();
    model->setData(index, QString::number(number->value()));
  } else if (auto* line = qobject_cast<QLineEdit*>(editor)) {
    model->setData(index, line->text());
  }
}

}  // namespace boresight::ui
