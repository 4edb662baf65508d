// SPDX-License-Identifier: Apache-2.0
#include "ui/review/check_cards.h"

#include <utility>

#include <QtWidgets>

#include "ui_check_card.h"

#include "sessions/checks/pose_quality.h"
#include "ui/models/text.h"
#include "ui/style/tokens.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

QString shortLimit(const sessions::Check& check) {
  return fromText(sessions::limitText(check))
      .replace(QStringLiteral("at most"), QStringLiteral("≤"))
      .replace(QStringLiteral("at least"), QStringLiteral("≥"));
}

QString foundAndLimit(const sessions::Check& check) {
  if (!check.figure || !check.limit) return fromText(sessions::foundText(check));
  if (check.id.starts_with("covariance_"))
    return fromText(sessions::ofLimitText(*check.figure, *check.limit, check.unit));
  return QStringLiteral("%1 (%2)").arg(fromText(sessions::foundText(check)), shortLimit(check));
}

CheckCards::CheckCards(QWidget* parent) : QWidget(parent), cards_(new QVBoxLayout(this)) {
  withoutMargins(cards_, kBlockGap);
}

void CheckCards::setChecks(const std::vector<FailedCheck>& failed, bool current) {
  std::vector<sessions::Check> checks;
  for (const FailedCheck& each : failed) checks.push_back(each.check);
  if (std::exchange(checks_, checks) != checks_) {
    // A field that is hidden while it is edited would hand its reason to the new figure.
    for (QLineEdit* reason : reasons_) reason->blockSignals(true);
    reasons_.clear();
    clearLayoutLater(*cards_);  // the reason that changed the checks may be one of the cards'
    for (const sessions::Check& check : checks_) cards_->addWidget(cardOf(check));
  }
  for (std::size_t i = 0; i < failed.size(); ++i) {
    if (!reasons_[i]->isModified()) reasons_[i]->setText(failed[i].reason);
    reasons_[i]->setEnabled(current);
  }
  setVisible(!failed.empty());
}

QWidget* CheckCards::cardOf(const sessions::Check& check) {
  auto* card = new QFrame;
  Ui::CheckCard ui;
  ui.setupUi(card);
  const QString title = fromText(check.title);
  ui.title->setText(QStringLiteral("✗ ") + title);
  ui.found->setText(foundAndLimit(check));
  ui.sentence->setText(fromText(check.sentence));
  ui.waiver->setAccessibleName(tr("Reason to waive '%1'").arg(title));
  ui.showCheck->setIcon(iconOf(Icon::kSearch));
  ui.showCheck->setAccessibleName(tr("Show what '%1' comes from").arg(title));
  connect(ui.waiver, &QLineEdit::editingFinished, this, [this, reason = ui.waiver, check] {
    reason->setModified(false);
    Q_EMIT reasonEdited(check, reason->text().trimmed());
  });
  connect(
      ui.showCheck, &QPushButton::clicked, this,
      [this, id = check.id] { Q_EMIT showRequested(id); }, Qt::QueuedConnection);
  reasons_.push_back(ui.waiver);
  return card;
}

}  // namespace boresight::ui
