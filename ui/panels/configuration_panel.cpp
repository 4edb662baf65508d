// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/configuration_panel.h"

#include <algorithm>
#include <limits>

#include <QtWidgets>

#include "ui/models/number_text.h"
#include "ui/models/options_model.h"
#include "ui/panels/widgets.h"

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

ConfigurationPanel::ConfigurationPanel(ViewState& view, QWidget* parent)
    : QWidget(parent), view_(view) {
  filter_.setSourceModel(&model_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  column->addLayout(buildTop());
  column->addWidget(buildStale());
  buildTree();
  column->addWidget(tree_, 1);
  help_ = named(new QLabel(this), "help");
  help_->setWordWrap(true);
  help_->setTextFormat(Qt::PlainText);
  help_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  help_->setMinimumHeight(2 * help_->fontMetrics().lineSpacing());
  column->addWidget(help_);
  connect(&model_, &OptionsModel::edited, this, [this] {
    showOptions();
    Q_EMIT optionsEdited(model_.profile(), model_.options());
  });
  connect(&model_, &QAbstractItemModel::modelReset, tree_, &QTreeView::expandAll);
  connect(&model_, &OptionsModel::refused, this, &ConfigurationPanel::showMessage);
  view_.onChange(ViewChange::kSnapshot, this, &ConfigurationPanel::showStale);
  setOptions(model_.profile(), model_.options());
}

QVBoxLayout* ConfigurationPanel::buildTop() {
  auto* column = new QVBoxLayout;
  auto* row = new QHBoxLayout;
  auto* search = new QHBoxLayout;
  column->addLayout(row);
  column->addLayout(search);
  profile_ = new QComboBox(this);
  profile_->addItems(OptionsModel::profiles());
  profile_->setToolTip(
      tr("Sets every option: default is whatever is best, paper is as published."));
  auto* label = new QLabel(tr("&Profile"), this);
  label->setBuddy(profile_);
  words_ = new QLineEdit(this);
  words_->setPlaceholderText(tr("Find an option"));
  words_->setClearButtonEnabled(true);
  changed_only_ = new QCheckBox(tr("Changed only"), this);
  reset_all_ = new QPushButton(tr("Reset all"), this);
  reset_all_->setToolTip(tr("Take every option back to the profile's value."));
  row->addWidget(label);
  row->addWidget(profile_);
  row->addStretch(1);
  row->addWidget(reset_all_);
  search->addWidget(words_, 1);
  search->addWidget(changed_only_);
  connect(profile_, QOverload<int>::of(&QComboBox::activated), this,
          [this] { model_.setProfile(profile_->currentText()); });
  connect(words_, &QLineEdit::textChanged, this, [this](const QString& text) {
    filter_.setWords(text);
    tree_->expandAll();
  });
  connect(changed_only_, &QCheckBox::toggled, this, [this](bool on) {
    filter_.setChangedOnly(on);
    tree_->expandAll();
  });
  connect(reset_all_, &QPushButton::clicked, this, [this] { model_.resetAll(); });
  return column;
}

QFrame* ConfigurationPanel::buildStale() {
  stale_ = named(new QFrame(this), "stale");
  stale_->setFrameShape(QFrame::StyledPanel);
  auto* row = new QHBoxLayout(stale_);
  row->setContentsMargins(8, 4, 8, 4);
  stale_text_ = new QLabel(stale_);
  stale_text_->setWordWrap(true);
  auto* again = named(new QPushButton(tr("Run again with these"), stale_), "runAgain");
  row->addWidget(stale_text_, 1);
  row->addWidget(again);
  connect(again, &QPushButton::clicked, this, &ConfigurationPanel::runAgainRequested);
  return stale_;
}

void ConfigurationPanel::buildTree() {
  tree_ = named(new QTreeView(this), "options");
  tree_->setAccessibleName(tr("Options"));
  tree_->setModel(&filter_);
  tree_->header()->moveSection(OptionsModel::kReset, OptionsModel::kUnit);  // beside the value
  tree_->setItemDelegateForColumn(OptionsModel::kValue, new OptionDelegate(tree_));
  tree_->setAlternatingRowColors(true);
  tree_->setUniformRowHeights(true);
  tree_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::SelectedClicked |
                         QAbstractItemView::EditKeyPressed | QAbstractItemView::AnyKeyPressed);
  auto* reset = new QAction(tr("Reset"), tree_);
  reset->setShortcut(QKeySequence::Delete);
  reset->setShortcutContext(Qt::WidgetShortcut);
  tree_->addAction(reset);
  tree_->setContextMenuPolicy(Qt::ActionsContextMenu);
  connect(reset, &QAction::triggered, this, [this] { model_.reset(chosenSource()); });
  connect(tree_, &QTreeView::clicked, this, &ConfigurationPanel::resetRow);
  connect(tree_->selectionModel(), &QItemSelectionModel::currentChanged, this,
          &ConfigurationPanel::showChosen);
}

void ConfigurationPanel::fitTree() {
  for (int column = 0; column < OptionsModel::kColumnCount; ++column)
    tree_->resizeColumnToContents(column);
  // One long number must not push the rest out of sight; tooltip and editor show it whole.
  const int most = tree_->fontMetrics().horizontalAdvance(QStringLiteral("0.123456789"));
  for (const int column : {OptionsModel::kValue, OptionsModel::kDefault})
    tree_->setColumnWidth(column, std::min(tree_->columnWidth(column), most));
  tree_->setColumnWidth(OptionsModel::kReset,
                        tree_->fontMetrics().horizontalAdvance(tr("↺ reset")) + 16);
}

QModelIndex ConfigurationPanel::chosenSource() const {
  return filter_.mapToSource(tree_->currentIndex());
}

void ConfigurationPanel::setOptions(const QString& profile, const LocalizerOptions& options) {
  model_.setOptions(profile, options);
  fitTree();
  showOptions();
}

void ConfigurationPanel::setCaseFeatureSize(double feature_size_m) {
  case_feature_size_m_ = feature_size_m;
  showStale();
}

void ConfigurationPanel::showOptions() {
  const QSignalBlocker blocked(profile_);
  profile_->setCurrentText(model_.profile());
  reset_all_->setEnabled(model_.changedCount() > 0);
  showChosen();
  showStale();
}

void ConfigurationPanel::showChosen() {
  const QModelIndex index = chosenSource();
  help_->setText(model_.option(index) ? index.data(Qt::ToolTipRole).toString()
                                      : tr("Choose an option to read what it does."));
}

void ConfigurationPanel::showMessage(const QString& message) {
  help_->setText(tr("✗ Not changed: %1.").arg(message));
}

QStringList ConfigurationPanel::differences() const {
  const auto* run = view_.snapshot().get();
  if (run == nullptr) return {};
  LocalizerOptions now = model_.options();
  if (!(now.templates.feature_size_m > 0.0)) now.templates.feature_size_m = case_feature_size_m_;
  QStringList names;
  for (const auto& option : sessions::listOptions(run->lastOptions())) {
    for (const auto& [name, value] : sessions::changedOptions(run->lastOptions(), now)) {
      if (name != option.name) continue;
      names.append(tr("%1 (was %2)").arg(fromText(name), fromText(valueText(option, value))));
    }
  }
  return names;
}

void ConfigurationPanel::showStale() {
  constexpr int kMostNamed = 4;
  QStringList names = differences();
  stale_->setVisible(!names.isEmpty());
  const auto more = names.size() - kMostNamed;
  if (more > 0) {
    names = names.mid(0, kMostNamed);
    names.append(tr("%1 more").arg(more));
  }
  stale_text_->setText(tr("⚠ The run that is shown was made with other options: %1.")
                           .arg(names.join(QStringLiteral(", "))));
}

void ConfigurationPanel::resetRow(const QModelIndex& index) {
  if (index.column() == OptionsModel::kReset) model_.reset(filter_.mapToSource(index));
}

}  // namespace boresight::ui
