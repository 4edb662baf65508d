// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <QAbstractItemModel>
#include <QSortFilterProxyModel>

#include "core/localizer/localizer_options.h"
#include "sessions/io/option_value.h"

namespace boresight::ui {

/// Every option of a run as a tree: a branch per stage, a leaf per option. What differs from the
/// profile is bold and can be reset. A value out of range is refused, and `refused` says why.
class OptionsModel : public QAbstractItemModel {
  Q_OBJECT

 public:
  enum Column { kName, kValue, kUnit, kDefault, kRange, kReset, kColumnCount };
  /// Whether an option differs from the profile.
  static constexpr int kChangedRole = Qt::UserRole;

  explicit OptionsModel(QObject* parent = nullptr);

  /// The names of the profiles there are.
  static QStringList profiles();

  const QString& profile() const { return profile_; }
  const LocalizerOptions& options() const { return options_; }
  /// An unknown profile is taken as the default one.
  void setOptions(const QString& profile, const LocalizerOptions& options);
  /// All options as the profile has them.
  void setProfile(const QString& profile);

  /// The option of a leaf with its present value; nullptr for a branch.
  const sessions::OptionDescription* option(const QModelIndex& index) const;
  bool isChanged(const QModelIndex& index) const;
  /// To the profile's value.
  void reset(const QModelIndex& index);
  void resetAll() { setProfile(profile_); }
  int changedCount() const;
  /// "0 .. 1 m", "true, false", or the choices.
  static QString rangeText(const sessions::OptionDescription& option);

  QModelIndex index(int row, int column, const QModelIndex& parent = {}) const override;
  QModelIndex parent(const QModelIndex& index) const override;
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role = Qt::EditRole) override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 Q_SIGNALS:
  /// An option was edited, reset, or all of them by a profile.
  void edited();
  /// A value was not taken; one sentence for people.
  void refused(const QString& message);

 private:
  struct Branch {
    QString name;
    std::vector<std::size_t> options;  ///< indices into now_
  };

  void take(const LocalizerOptions& options);
  std::size_t optionIndex(const QModelIndex& index) const;
  bool apply(const QModelIndex& index, const std::string& text);
  QVariant branchData(const QModelIndex& index, int role) const;
  QString text(std::size_t option, Column column) const;
  QString helpText(std::size_t option) const;

  QString profile_;
  LocalizerOptions options_;
  std::vector<sessions::OptionDescription> now_;
  std::vector<sessions::OptionDescription> of_profile_;
  std::vector<Branch> branches_;
};

/// Options whose name or help holds every word of a text; all of them, or those that were changed.
class OptionsFilter : public QSortFilterProxyModel {
  Q_OBJECT

 public:
  explicit OptionsFilter(QObject* parent = nullptr);

  void setWords(const QString& text);
  void setChangedOnly(bool changed_only);

 protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override;

 private:
  QStringList words_;
  bool changed_only_ = false;
};

}  // namespace boresight::ui
