// SPDX-License-Identifier: Apache-2.0
#include "ui/review/check_cards.h"

#include <utility>

#include <QtWidgets>

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
  cards_->setContentsMargins(0, 0, 0, 0);
  cards_->setSpacing(kBlockGap);
}

void CheckCards::setChecks(const std::vector<FailedCheck>& failed, bool current) {
  std::vector<sessions::Check> checks;
  for (const FailedCheck& each : failed) checks.push_back(each.check);
  if (std::exchange(checks_, checks) != checks_) {
    reasons_.clear();
    while (QLayoutItem* item = cards_->takeAt(0)) {
      item->widget()->hide();
      item->widget()->deleteLater();  // the reason that changed the checks may be its own
      delete item;
    }
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
  card->setProperty("card", true);
  auto* title = new QLabel(QStringLiteral("✗ ") + fromText(check.title));
  title->setProperty("title", true);
  title->setWordWrap(true);
  auto* found = new QLabel(foundAndLimit(check));
  auto* sentence = new QLabel(fromText(check.sentence));
  sentence->setTextFormat(Qt::PlainText);
  sentence->setWordWrap(true);
  sentence->setTextInteractionFlags(Qt::TextSelectableByMouse);
  auto* reason = named(new QLineEdit, "waiver",
                       tr("A pose with a failed check needs a reason to waive it; the reason is "
                          "stored with the pose, and dropped when the figure changes"));
  reason->setPlaceholderText(tr("Why does it not matter?"));
  reason->setAccessibleName(tr("Reason to waive '%1'").arg(fromText(check.title)));
  connect(reason, &QLineEdit::editingFinished, this, [this, reason, id = check.id] {
    reason->setModified(false);
    Q_EMIT reasonEdited(id, reason->text().trimmed());
  });
  reasons_.push_back(reason);
  auto* show = named(new QPushButton(iconOf(Icon::kSearch), tr("Show")), "showCheck",
                     tr("Show what this figure comes from"));
  show->setAccessibleName(tr("Show what '%1' comes from").arg(fromText(check.title)));
  connect(
      show, &QPushButton::clicked, this, [this, id = check.id] { Q_EMIT showRequested(id); },
      Qt::QueuedConnection);
  auto* answer = new QHBoxLayout;
  answer->setSpacing(kBlockGap);
  answer->addWidget(reason, 1);
  answer->addWidget(show);
  auto* head = new QHBoxLayout;
  head->setSpacing(kBlockGap);
  head->addWidget(title, 1);
  head->addWidget(found, 0, Qt::AlignTop);
  auto* column = new QVBoxLayout(card);
  column->setContentsMargins(kBlockGap, kBlockGap, kBlockGap, kBlockGap);
  column->setSpacing(kBlockGap / 2);
  column->addLayout(head);
  column->addWidget(sentence);
  column->addLayout(answer);
  return card;
}

}  // namespace boresight::ui
