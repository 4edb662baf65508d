// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <QWidget>

#include "ui/models/options_filter.h"
#include "ui/models/options_model.h"
#include "ui/state/view_state.h"

QT_BEGIN_NAMESPACE
class QCheckBox;
class QComboBox;
class QFrame;
class QVBoxLayout;
class QLabel;
class QLineEdit;
class QPushButton;
class QTreeView;
QT_END_NAMESPACE

namespace boresight::ui {

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
