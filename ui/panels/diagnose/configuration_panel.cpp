// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/diagnose/configuration_panel.h"

#include <QtWidgets>

#include "sessions/io/json/config_file.h"
#include "ui/models/text.h"

namespace boresight::ui {
namespace {

QStringList profiles() {
  return QString::fromLatin1(sessions::profileNames()).split(QStringLiteral(", "));
}

LocalizerOptions optionsOf(const QString& profile) {
  return sessions::profileOptions(profile.toStdString()).value_or(defaultProfile());
}

}  // namespace

ConfigurationPanel::ConfigurationPanel(ViewState& view) : view_(view) {
  ui_.setupUi(this);
  ui_.profile->addItems(profiles());
  ui_.stale->setAction(tr("Run again with these"), {});
  ui_.options->describeIn(*ui_.help, tr("Select an option to read its description."));
  const auto filter = [this] {
    ui_.options->setFilter(ui_.words->text(), ui_.changedOnly->isChecked());
  };
  connect(ui_.words, &QLineEdit::textChanged, this, filter);
  connect(ui_.changedOnly, &QCheckBox::toggled, this, filter);
  connect(ui_.profile, &QComboBox::textActivated, this, &ConfigurationPanel::setProfile);
  connect(ui_.resetAll, &QPushButton::clicked, this, [this] { setProfile(profile_); });
  connect(&ui_.options->options(), &OptionsModel::edited, this, &ConfigurationPanel::change);
  connect(ui_.stale, &Banner::actionRequested, this, &ConfigurationPanel::runAgainRequested);
  view_.onChange(ViewChange::kSnapshot, this, &ConfigurationPanel::showStale);
  setOptions(profiles().front(), defaultProfile());
}

void ConfigurationPanel::setOptions(const QString& profile, const LocalizerOptions& options) {
  profile_ = profiles().contains(profile) ? profile : profiles().front();
  options_ = options;
  ui_.options->setOptions(sessions::listOptions(options),
                          sessions::listOptions(optionsOf(profile_)));
  const QSignalBlocker blocked(ui_.profile);
  ui_.profile->setCurrentText(profile_);
  ui_.resetAll->setEnabled(ui_.options->options().changedCount() > 0);
  showStale();
}

void ConfigurationPanel::setCaseFeatureSize(double feature_size_m) {
  case_feature_size_m_ = feature_size_m;
  showStale();
}

void ConfigurationPanel::setProfile(const QString& profile) {
  request(profile, optionsOf(profile));
}

/// The session answers with what it has; where it refuses, the options before show again.
void ConfigurationPanel::request(const QString& profile, const LocalizerOptions& options) {
  Q_EMIT optionsEdited(profile, options);
  setOptions(profile_, options_);
}

void ConfigurationPanel::change(const std::string& name, const std::string& value) {
  LocalizerOptions changed = options_;
  if (ui_.options->apply(changed, name, value)) request(profile_, changed);
}

QStringList ConfigurationPanel::differences() const {
  const auto* run = view_.snapshot().get();
  if (run == nullptr) return {};
  LocalizerOptions current = options_;
  if (!(current.templates.feature_size_m > 0.0))
    current.templates.feature_size_m = case_feature_size_m_;
  const std::vector<sessions::OptionDescription> before = sessions::listOptions(run->lastOptions());
  const std::vector<sessions::OptionDescription> now = sessions::listOptions(current);
  QStringList names;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (before[i].value != now[i].value)
      names.append(tr("%1 (was %2, now %3)")
                       .arg(fromText(now[i].name), fromText(valueText(before[i], before[i].value)),
                            fromText(valueText(now[i], now[i].value))));
  return names;
}

void ConfigurationPanel::showStale() {
  constexpr int kMostNamed = 4;
  QStringList names = differences();
  ui_.stale->setVisible(!names.isEmpty());
  const auto more = names.size() - kMostNamed;
  if (more > 0) {
    names = names.mid(0, kMostNamed);
    names.append(tr("%1 more").arg(more));
  }
  ui_.stale->setMessage(
      QStringLiteral("⚠"),
      tr("The shown run has other options: %1.").arg(names.join(QStringLiteral(", "))),
      Banner::Tone::kPlain);
}

}  // namespace boresight::ui
