// SPDX-License-Identifier: Apache-2.0
#include "ui/review/queue_panel.h"

#include <algorithm>
#include <utility>

#include <QtWidgets>

#include "ui_queue_panel.h"

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
      filter_(model_),
      ui_(std::make_unique<Ui::QueuePanel>()) {
  ui_->setupUi(this);
  ui_->queueTabs->addTab(tr("By trouble"));
  ui_->queueTabs->addTab(tr("Last two runs"));
  ui_->queueTabs->setTabToolTip(kTroubleTab, tr("All cases, the most troubled first"));
  ui_->queueTabs->setTabToolTip(
      kDifferencesTab, tr("Each case's last run against the one before it (D in the list)"));
  buildTables();
  buildForm();
  connect(ui_->queueTabs, &QTabBar::currentChanged, this, &QueuePanel::lookAt);
  connect(ui_->queueFilter, &QLineEdit::textChanged, this, [this](const QString& text) {
    filter_.setText(text);
    differences_filter_.setFilterFixedString(text.trimmed());
  });
  connect(ui_->queueHalt, &QPushButton::clicked, this,
          [this] { controller_.setHalted(!controller_.isHalted()); });
  connect(&controller_, &QueueController::changed, this, &QueuePanel::showEntries);
  showEntries();
}

QueuePanel::~QueuePanel() = default;

void QueuePanel::buildTables() {
  setUpTable(*ui_->queue, filter_);
  ui_->queue->verticalHeader()->setDefaultSectionSize(
      std::max(kQueueThumbnail_px.height(), 3 * fontMetrics().lineSpacing()) + 4);
  ui_->queue->setWordWrap(true);
  ui_->queue->sortByColumn(QueueModel::kTrouble, Qt::AscendingOrder);
  queue_hint_ = new EmptyHint(*ui_->queue);
  differences_filter_.setSourceModel(&differences_);
  differences_filter_.setSortRole(kSortRole);
  differences_filter_.setFilterKeyColumn(-1);
  differences_filter_.setFilterCaseSensitivity(Qt::CaseInsensitive);
  setUpTable(*ui_->differences, differences_filter_);
  ui_->differences->sortByColumn(DifferencesModel::kChange, Qt::AscendingOrder);
  differences_hint_ = new EmptyHint(*ui_->differences);
  for (QTableView* each : {ui_->queue, ui_->differences}) {
    each->horizontalHeader()->setStretchLastSection(each == ui_->differences);
    each->installEventFilter(this);
    connect(each, &QTableView::doubleClicked, this, &QueuePanel::openChosen);
  }
  ui_->queue->horizontalHeader()->setSectionResizeMode(QueueModel::kTrouble, QHeaderView::Stretch);
}

void QueuePanel::buildForm() {
  for (QLineEdit* field : {ui_->queueName, ui_->queueComment}) {
    field->installEventFilter(this);
    connect(field, &QLineEdit::returnPressed, this, &QueuePanel::signedNow);
  }
  connect(ui_->queueOpen, &QPushButton::clicked, this, &QueuePanel::openChosen);
  connect(ui_->queueAccept, &QPushButton::clicked, this, &QueuePanel::accept);
  connect(ui_->queueReject, &QPushButton::clicked, this, &QueuePanel::reject);
}

QTableView* QueuePanel::table() const {
  return ui_->queueTabs->currentIndex() == kDifferencesTab ? ui_->differences : ui_->queue;
}

QString QueuePanel::chosenCase() const {
  return table()->currentIndex().siblingAtColumn(0).data().toString();
}

QString QueuePanel::message() const { return ui_->queueMessage->text(); }

void QueuePanel::tell(const QString& text) {
  ui_->queueMessage->setText(text);
  ui_->queueMessage->setVisible(!text.isEmpty());
}

void QueuePanel::focusList() {
  table()->setFocus();
  if (!table()->currentIndex().isValid()) step(0);
}

void QueuePanel::showDifferences(bool shown) {
  ui_->queueTabs->setCurrentIndex(shown ? kDifferencesTab : kTroubleTab);
  focusList();
}

void QueuePanel::lookAt() {
  ui_->lists->setCurrentWidget(table());
  const bool differences = table() == ui_->differences;
  controller_.setLookedAt(!in_sight_    ? QueueController::List::kNone
                          : differences ? QueueController::List::kDifferences
                                        : QueueController::List::kTrouble);
  showEntries();
}

void QueuePanel::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  if (ui_->queueName->text().isEmpty())
    ui_->queueName->setText(QSettings().value(QLatin1String(DecisionForm::kNameKey)).toString());
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
                           ? tr("No matching cases.")
                           : tr("No case yet: open a session (Ctrl+O) and run it (Ctrl+F5)."));
  differences_hint_->setText(
      differences_.rowCount() > 0
          ? tr("No matching cases.")
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
    ui_->queue->setColumnWidth(column, fontMetrics().horizontalAdvance(widest) + 14);
  };
  fit(QueueModel::kStatus, QStringLiteral("✓ converged"));
  fit(QueueModel::kMargin, QStringLiteral("Margin,"));
  fit(QueueModel::kFromSeed, QStringLiteral("000.0 mrad"));
  fit(QueueModel::kInliers, QStringLiteral("Inliers"));
  ui_->queue->setColumnWidth(
      QueueModel::kCase,
      kQueueThumbnail_px.width() + 16 + kUsualQueueName * fontMetrics().averageCharWidth());
  ui_->differences->resizeColumnsToContents();
}

void QueuePanel::showProgress() {
  const int done = controller_.doneCount();
  const int all = controller_.count();
  ui_->queueProgress->setText(done < all ? tr("%1 of %2 checked").arg(done).arg(all)
                                         : tr("%1 checked").arg(all));
  ui_->queueHalt->setText(controller_.isHalted() ? tr("Go on") : tr("Stop"));
  ui_->queueHalt->setEnabled(done < all);
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
  const int here = ui_->queue->currentIndex().row();
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
  QLineEdit* missing = ui_->queueName->text().trimmed().isEmpty()      ? ui_->queueName
                       : ui_->queueComment->text().trimmed().isEmpty() ? ui_->queueComment
                                                                       : nullptr;
  if (!missing) return false;
  pending_ = act;
  pending_case_ = id;
  missing->setFocus();
  const bool accepts = act == Act::kAccept;
  const QString question = missing == ui_->queueName
                               ? (accepts ? tr("Who accepts %1?") : tr("Who rejects %1?"))
                           : accepts ? tr("On what grounds is %1 accepted?")
                                     : tr("On what grounds is %1 rejected?");
  tell(question.arg(id) + tr(" Type it, then Enter; Escape leaves it."));
  return true;
}

void QueuePanel::decide(Act act) {
  if (table() != ui_->queue) showDifferences(false);
  const QString id = chosenCase();
  const QString reason = controller_.obstacle(act, id);
  if (!reason.isEmpty()) {
    dropQuestion();
    tell(reason);
    return;
  }
  if (asksForSignature(act, id)) return;
  const QString following = nextOpen();
  const QString name = ui_->queueName->text().trimmed();
  const QString failure = controller_.decide(
      act, id, {name.toStdString(), ui_->queueComment->text().trimmed().toStdString()});
  dropQuestion();
  if (!failure.isEmpty()) {
    tell(failure);
    return;
  }
  QSettings().setValue(QLatin1String(DecisionForm::kNameKey), name);
  ui_->queueComment->clear();  // the next decision has grounds of its own
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

void QueuePanel::switchList() { showDifferences(table() == ui_->queue); }

/// In the lists these letters are the queue's, elsewhere in the window the image's.
bool QueuePanel::eventFilter(QObject* watched, QEvent* event) {
  const bool pressed = event->type() == QEvent::KeyPress;
  if (!pressed && event->type() != QEvent::ShortcutOverride) return false;
  auto* key = static_cast<QKeyEvent*>(event);
  if ((key->modifiers() & ~Qt::KeypadModifier) != Qt::NoModifier) return false;
  if (watched == ui_->queueName || watched == ui_->queueComment) {
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
