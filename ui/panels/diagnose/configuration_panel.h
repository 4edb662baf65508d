// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <QWidget>

#include "ui_configuration_panel.h"

#include "core/localizer/localizer_options.h"
#include "sessions/io/json/option_value.h"
#include "ui/state/view_state.h"

namespace boresight::ui {

/// All parameters of the next run. States when the shown run was made with other values.
class ConfigurationPanel : public QWidget {
  Q_OBJECT

 public:
  explicit ConfigurationPanel(ViewState& view);

  /// From the document; emits nothing. An unknown profile is replaced by the default one.
  void setOptions(const QString& profile, const LocalizerOptions& options);
  /// The feature size that the case is run with when the option is 0.
  void setCaseFeatureSize(double feature_size_m);
  const LocalizerOptions& options() const { return options_; }

  /// Options in which the shown run differs from these, as "name (was value)".
  QStringList differences() const;

 Q_SIGNALS:
  /// The operator has changed an option or the profile.
  void optionsEdited(const QString& profile, const boresight::LocalizerOptions& options);
  void runAgainRequested();

 private:
  void change(const std::string& name, const std::string& value);
  void setProfile(const QString& profile);
  void request(const QString& profile, const LocalizerOptions& options);
  void showStale();

  ViewState& view_;
  Ui::ConfigurationPanel ui_;
  QString profile_;
  LocalizerOptions options_;
  double case_feature_size_m_ = 0.0;
};

}  // namespace boresight::ui
