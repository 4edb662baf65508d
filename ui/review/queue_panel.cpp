// SPDX-License-Identifier: Apache-2.0
#include "ui/review/queue_panel.h"

#include <algorithm>
#include <utility>

#include <QtWidgets>

#include "ui/models/number_text.h"
#include "ui/panels/widgets.h"
#include "ui/review/decision_form.h"

namespace boresight::ui {
namespace {

constexpr QSize kQueueThumbnail_px{76, 57};  // of a screen without scaling
constexpr int kUsualQueueName = 18;          // letters
constexpr int kTroubleTab = 0;
constexpr int kDifferencesTab = 1;

}  // namespace

QueuePanel::QueuePanel(Document& document, QWidget* parent)
    : QWidget(parent),
      controller_(document, kQueueThumbnail_px * devicePixelRatioF()),
      filter_(model_) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  column->setSpacing(4);
  buildTop();
  buildTables();
  buildForm();
  connect(&controller_, &QueueController::changed, this, &QueuePanel::showEntries);
  showEntries();
}

void QueuePanel::buildTop() {
  auto* row = new QHBoxLayout;
  tabs_ = named(new QTabBar(this), "queueTabs");
  tabs_->setDrawBase(false);
  tabs_->addTab(tr("By trouble"));
  tabs_->addTab(tr("Last two runs"));
  tabs_->setTabToolTip(kTroubleTab, tr("All cases, the most troubled first"));
  tabs_->setTabToolTip(kDifferencesTab,
                       tr("Each case's last run against the one before it (D in the list)"));
  text_ = named(new QLineEdit(this), "queueFilter");
  text_->setPlaceholderText(tr("Find a case, a state, a check"));
  text_->setClearButtonEnabled(true);
  progress_ = named(new QLabel(this), "queueProgress");
  halt_ = named(new QPushButton(this), "queueHalt",
                tr("Cases are checked in the background, one at a time"));
  row->addWidget(tabs_);
  row->addWidget(text_, 1);
  row->addWidget(progress_);
  row->addWidget(halt_);
  static_cast<QVBoxLayout*>(layout())->addLayout(row);
  connect(tabs_, &QTabBar::currentChanged, this, &QueuePanel::lookAt);
  connect(text_, &QLineEdit::textChanged, this, [this](const QString& text) {
    filter_.setText(text);
    differences_filter_.setFilterFixedString(text.trimmed());
  });
  connect(halt_, &QPushButton::clicked, this,
          [this] { controller_.setHalted(!controller_.isHalted()); });
}

void QueuePanel::buildTables() {
  lists_ = new QStackedWidget(this);
  queue_table_ = newTable("queue", tr("Queue"), filter_, lists_);
  queue_table_->setIconSize(kQueueThumbnail_px);
  queue_table_->verticalHeader()->setDefaultSectionSize(
      std::max(kQueueThumbnail_px.height(), 3 * fontMetrics().lineSpacing()) + 4);
  queue_table_->setWordWrap(true);
  queue_table_->setSortingEnabled(true);
  queue_table_->sortByColumn(QueueModel::kTrouble, Qt::AscendingOrder);
  queue_hint_ = new EmptyHint(*queue_table_);
  differences_filter_.setSourceModel(&differences_);
  differences_filter_.setSortRole(kSortRole);
  differences_filter_.setFilterKeyColumn(-1);
  differences_filter_.setFilterCaseSensitivity(Qt::CaseInsensitive);
  differences_table_ = newTable("differences", tr("Differences"), differences_filter_, lists_);
  differences_table_->setSortingEnabled(true);
  differences_table_->sortByColumn(DifferencesModel::kChange, Qt::AscendingOrder);
  differences_hint_ = new EmptyHint(*differences_table_);
  for (QTableView* each : {queue_table_, differences_table_}) {
    each->horizontalHeader()->setStretchLastSection(each == differences_table_);
    each->installEventFilter(this);
    connect(each, &QTableView::doubleClicked, this, &QueuePanel::openChosen);
    lists_->addWidget(each);
  }
  queue_table_->horizontalHeader()->setSectionResizeMode(QueueModel::kTrouble,
                                                         QHeaderView::Stretch);
  static_cast<QVBoxLayout*>(layout())->addWidget(lists_, 1);
}

void QueuePanel::buildForm() {
  auto* row = new QHBoxLayout;
  const auto field = [this, row](const char* name, const QString& placeholder, const QString& tip) {
    auto* made = named(new QLineEdit(this), name, tip);
    made->setPlaceholderText(placeholder);
    made->installEventFilter(this);
    connect(made, &QLineEdit::returnPressed, this, &QueuePanel::signedNow);
    row->addWidget(made, made->objectName() == QLatin1String("queueName") ? 1 : 3);
    return made;
  };
  name_ = field("queueName", tr("Who decides"),
                tr("Your name; it goes with the decision into every file"));
  comment_ = field("queueComment", tr("On what grounds"),
                   tr("On what grounds; it goes with the decision into every file"));
  const auto button = [this, row](const char* name, const QString& text, const QString& tip,
                                  void (QueuePanel::*act)()) {
    auto* made = named(new QPushButton(text, this), name, tip);
    connect(made, &QPushButton::clicked, this, act);
    row->addWidget(made);
  };
  button("queueOpen", tr("Open"),
         tr("Show the case at the iteration that failed, or at the last one (Enter in the list)"),
         &QueuePanel::openChosen);
  button("queueAccept", tr("Accept"),
         tr("Validate the case's pose, when all checks passed (A in the list)"),
         &QueuePanel::accept);
  button("queueReject", tr("Reject"), tr("Refuse the case's result (R in the list)"),
         &QueuePanel::reject);
  auto* column = static_cast<QVBoxLayout*>(layout());
  column->addLayout(row);
  message_ = named(new QLabel(this), "queueMessage");
  message_->setTextFormat(Qt::PlainText);
  message_->setWordWrap(true);
  message_->hide();
  column->addWidget(message_);
}

QTableView* QueuePanel::table() const {
  return tabs_->currentIndex() == kDifferencesTab ? differences_table_ : queue_table_;
}

QString QueuePanel::chosenCase() const {
  return table()->currentIndex().siblingAtColumn(0).data().toString();
}

QString QueuePanel::message() const { return message_->text(); }

void QueuePanel::tell(const QString& text) {
  message_->setText(text);
  message_->setVisible(!text.isEmpty());
}

void QueuePanel::focusList() {
  table()->setFocus();
  if (!table()->currentIndex().isValid()) step(0);
}

void QueuePanel::showDifferences(bool shown) {
  tabs_->setCurrentIndex(shown ? kDifferencesTab : kTroubleTab);
  focusList();
}

void QueuePanel::lookAt() {
  lists_->setCurrentWidget(table());
  const bool differences = table() == differences_table_;
  controller_.setLookedAt(!in_sight_    ? QueueController::List::kNone
                          : differences ? QueueController::List::kDifferences
                                        : QueueController::List::kTrouble);
  showEntries();
}

void QueuePanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  if (name_->text().isEmpty())
    name_->setText(QSettings().value(QLatin1String(DecisionForm::kNameKey)).toString());
}

void QueuePanel::setInSight(bool in_sight) {
  in_sight_ = in_sight;
  lookAt();
}

void QueuePanel::showEntries() {
  const QString chosen = chosenCase();
  model_.setEntries(controller_.queue());
  differences_.setEntries(controller_.differences());
  queue_hint_->setText(model_.rowCount() > 0
                           ? tr("No case is called so, is in this state, or has this trouble.")
                           : tr("No case yet: open a session (Ctrl+O) and run it (Ctrl+F5)."));
  differences_hint_->setText(
      differences_.rowCount() > 0
          ? tr("No case is called so or changed so.")
          : tr("No case has two runs yet: change an option and run again (Ctrl+F5)."));
  if (chosenCase() != chosen) choose(chosen);
  if (!table()->currentIndex().isValid()) step(0);
  fitColumns();
  showProgress();
}

/// Once, as soon as there is something to fit: afterwards widths are people's.
void QueuePanel::fitColumns() {
  if (fitted_ || model_.rowCount() == 0) return;
  fitted_ = controller_.doneCount() > 0;
  // Headers would keep room for the sign of the order in every column.
  const auto fit = [this](int column, const QString& widest) {
    queue_table_->setColumnWidth(column, fontMetrics().horizontalAdvance(widest) + 14);
  };
  fit(QueueModel::kStanding, QStringLiteral("✓ converged"));
  fit(QueueModel::kMargin, QStringLiteral("Margin,"));
  fit(QueueModel::kFromSeed, QStringLiteral("000.0 mrad"));
  fit(QueueModel::kInliers, QStringLiteral("Inliers"));
  queue_table_->setColumnWidth(
      QueueModel::kCase,
      kQueueThumbnail_px.width() + 16 + kUsualQueueName * fontMetrics().averageCharWidth());
  differences_table_->resizeColumnsToContents();
}

void QueuePanel::showProgress() {
  const int done = controller_.doneCount();
  const int all = controller_.count();
  progress_->setText(done < all ? tr("%1 of %2 checked").arg(done).arg(all)
                                : tr("%1 checked").arg(all));
  halt_->setText(controller_.isHalted() ? tr("Go on") : tr("Stop"));
  halt_->setEnabled(done < all);
}

void QueuePanel::openChosen() {
  const QString id = chosenCase();
  if (id.isEmpty()) return;
  const int row = model_.rowOf(id);
  const sessions::QueueRow none;
  const sessions::QueueRow& found = row < 0 ? none : model_.at(row).row;
  Q_EMIT openRequested(id, fromText(found.run_digest), found.opens_at);
}

void QueuePanel::accept() { decide(Act::kAccept); }
void QueuePanel::reject() { decide(Act::kReject); }
void QueuePanel::next() { step(1); }
void QueuePanel::previous() { step(-1); }

void QueuePanel::step(int rows) {
  const int count = table()->model()->rowCount();
  if (count == 0) return;
  const int row = std::clamp(table()->currentIndex().row() + rows, 0, count - 1);
  table()->setCurrentIndex(table()->model()->index(row, 0));
}

void QueuePanel::choose(const QString& id) {
  const QAbstractItemModel& model = *table()->model();
  for (int row = 0; row < model.rowCount(); ++row)
    if (model.index(row, 0).data().toString() == id) {
      table()->setCurrentIndex(model.index(row, 0));
      return;
    }
}

/// The undecided case that is listed next after the chosen one, from the top again at the end.
QString QueuePanel::nextOpen() const {
  const int count = filter_.rowCount();
  const int here = queue_table_->currentIndex().row();
  for (int i = 1; i < count; ++i) {
    const QModelIndex one = filter_.index((here + i) % count, 0);
    const sessions::QueueRow& row = model_.at(filter_.mapToSource(one).row()).row;
    if (row.group == sessions::QueueGroup::kNoPose || row.group == sessions::QueueGroup::kOpen)
      return one.data().toString();
  }
  return {};
}

/// True when name or comment is missing; the question stands where the answer goes.
bool QueuePanel::asksForSignature(Act act, const QString& id) {
  QLineEdit* missing = name_->text().trimmed().isEmpty()      ? name_
                       : comment_->text().trimmed().isEmpty() ? comment_
                                                              : nullptr;
  if (!missing) return false;
  pending_ = act;
  pending_case_ = id;
  missing->setFocus();
  const bool accepts = act == Act::kAccept;
  const QString question = missing == name_
                               ? (accepts ? tr("Who accepts %1?") : tr("Who rejects %1?"))
                           : accepts ? tr("On what grounds is %1 accepted?")
                                     : tr("On what grounds is %1 rejected?");
  tell(question.arg(id) + tr(" Type it, then Enter; Escape leaves it."));
  return true;
}

void QueuePanel::decide(Act act) {
  if (table() != queue_table_) showDifferences(false);
  const QString id = chosenCase();
  const QString reason = controller_.obstacle(act, id);
  if (!reason.isEmpty()) {
    dropQuestion();
    tell(reason);
    return;
  }
  if (asksForSignature(act, id)) return;
  const QString following = nextOpen();
  const QString name = name_->text().trimmed();
  const QString failure =
      controller_.decide(act, id, {name.toStdString(), comment_->text().trimmed().toStdString()});
  dropQuestion();
  if (!failure.isEmpty()) {
    tell(failure);
    return;
  }
  QSettings().setValue(QLatin1String(DecisionForm::kNameKey), name);
  comment_->clear();  // the next decision has grounds of its own
  choose(following.isEmpty() ? id : following);
  tell((act == Act::kAccept ? tr("%1 is validated.") : tr("%1 is rejected.")).arg(id) +
       (following.isEmpty() ? tr(" Every case that was listed is decided or has to be run.")
                            : QString()));
}

/// Enter in a field.
void QueuePanel::signedNow() {
  if (!pending_) {
    focusList();
    return;
  }
  const Act act = *pending_;
  choose(pending_case_);
  if (chosenCase() == pending_case_) {
    decide(act);
    return;
  }
  dropQuestion();
  tell(tr("%1 is not listed any more: clear the filter. Nothing was decided.").arg(pending_case_));
}

void QueuePanel::dropQuestion() {
  pending_.reset();
  tell({});
  focusList();
}

void QueuePanel::switchList() { showDifferences(table() == queue_table_); }

/// In the lists these letters are the queue's, elsewhere in the window the image's.
bool QueuePanel::eventFilter(QObject* watched, QEvent* event) {
  const bool pressed = event->type() == QEvent::KeyPress;
  if (!pressed && event->type() != QEvent::ShortcutOverride) return false;
  auto* key = static_cast<QKeyEvent*>(event);
  if ((key->modifiers() & ~Qt::KeypadModifier) != Qt::NoModifier) return false;
  if (watched == name_ || watched == comment_) {
    if (!pressed || key->key() != Qt::Key_Escape) return false;
    dropQuestion();
    return true;
  }
  static constexpr std::pair<int, void (QueuePanel::*)()> kKeys[] = {
      {Qt::Key_Return, &QueuePanel::openChosen},
      {Qt::Key_Enter, &QueuePanel::openChosen},
      {Qt::Key_A, &QueuePanel::accept},
      {Qt::Key_R, &QueuePanel::reject},
      {Qt::Key_J, &QueuePanel::next},
      {Qt::Key_K, &QueuePanel::previous},
      {Qt::Key_D, &QueuePanel::switchList},
  };
  for (const auto& [letter, act] : kKeys) {
    if (letter != key->key()) continue;
    if (pressed)
      (this->*act)();
    else
      event->accept();
    return true;
  }
  return false;
}

}  // namespace boresight::ui
