// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QStyledItemDelegate>
#include <QWidget>

#include "ui/models/options_model.h"
#include "ui/state/view_state.h"

class QCheckBox;
class QComboBox;
class QFrame;
class QLabel;
class QLineEdit;
class QPushButton;
class QTreeView;
class QVBoxLayout;

namespace boresight::ui {

/// Editors for options: a list for choices, a spin box for integers, a line for numbers. They take
/// what is typed as it is; the model refuses what is out of range and says so.
class OptionDelegate : public QStyledItemDelegate {
  Q_OBJECT

 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  QWidget* createEditor(QWidget* parent, const QStyleOptionViewItem& option,
                        const QModelIndex& index) const override;
  void setEditorData(QWidget* editor, const QModelIndex& index) const override;
  void setModelData(QWidget* editor, QAbstractItemModel* model,
                    const QModelIndex& index) const override;
};

/// Every parameter of the next run. Says so when the run that is shown was made with other ones.
class ConfigurationPanel : public QWidget {
  Q_OBJECT

 public:
  explicit ConfigurationPanel(ViewState& view, QWidget* parent = nullptr);

  /// From the document; emits nothing.
  void setOptions(const QString& profile, const LocalizerOptions& options);
  /// What a case is run with where the options leave the feature size at 0.
  void setCaseFeatureSize(double feature_size_m);
  OptionsModel& model() { return model_; }

  /// Options in which the shown run differs from these, as "name (was value)".
  QStringList differences() const;

 Q_SIGNALS:
  /// A person has changed an option or the profile.
  void optionsEdited(const QString& profile, const boresight::LocalizerOptions& options);
  void runAgainRequested();

 private:
  QVBoxLayout* buildTop();
  QFrame* buildStale();
  void buildTree();
  void fitTree();
  void showOptions();
  void showChosen();
  void showMessage(const QString& message);
  void showStale();
  void resetRow(const QModelIndex& index);
  QModelIndex chosenSource() const;

  ViewState& view_;
  OptionsModel model_;
  OptionsFilter filter_;
  double case_feature_size_m_ = 0.0;
  QComboBox* profile_ = nullptr;
  QLineEdit* words_ = nullptr;
  QCheckBox* changed_only_ = nullptr;
  QPushButton* reset_all_ = nullptr;
  QFrame* stale_ = nullptr;
  QLabel* stale_text_ = nullptr;
  QTreeView* tree_ = nullptr;
  QLabel* help_ = nullptr;
};

}  // namespace boresight::ui
