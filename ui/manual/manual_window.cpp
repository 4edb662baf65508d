// SPDX-License-Identifier: Apache-2.0
#include "ui/manual/manual_window.h"

#include <QAction>
#include <QDockWidget>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QSignalBlocker>
#include <QStackedWidget>
#include <QToolBar>
#include <QTreeWidget>
#include <QUrl>
#include <QVBoxLayout>

#include "ui/manual/manual_browser.h"
#include "ui/manual/manual_search.h"

namespace boresight::ui {
namespace {

constexpr int kPageRole = Qt::UserRole;

}  // namespace

ManualWindow::ManualWindow(const QString& folder, QWidget* parent)
    : QMainWindow(parent, Qt::Window),
      folder_(folder),
      browser_(new ManualBrowser(this)),
      contents_(new QTreeWidget),
      search_(new QLineEdit),
      hits_(new QListWidget),
      side_(new QStackedWidget),
      find_(new QLineEdit),
      found_(new QLabel) {
  setObjectName(QStringLiteral("manualWindow"));
  setWindowTitle(tr("Manual - Boresight"));
  setCentralWidget(browser_);
  buildToolBar();
  buildSide();
  buildFindBar();
  connect(browser_, &QTextBrowser::sourceChanged, this, &ManualWindow::showPlace);
  fillContents();
  resize(1100, 800);
  if (folder_.isEmpty())
    browser_->setPlainText(
        tr("The manual is not there: share/boresight/manual lies neither beside the program nor in "
           "its build tree. Install the program again, or build the target 'manual'."));
}

QAction* ManualWindow::action(const QString& text, const QKeySequence& keys, const QString& tip) {
  auto* made = new QAction(text, this);
  made->setShortcut(keys);
  made->setToolTip(QStringLiteral("%1 (%2)").arg(tip, keys.toString(QKeySequence::NativeText)));
  return made;
}

void ManualWindow::buildToolBar() {
  QToolBar* bar = addToolBar(tr("Pages"));
  bar->setObjectName(QStringLiteral("manualBar"));
  bar->setMovable(false);
  QAction* back = action(tr("Back"), QKeySequence::Back, tr("The page before"));
  QAction* forward = action(tr("Forward"), QKeySequence::Forward, tr("The page after"));
  QAction* contents = action(tr("Contents"), QKeySequence(QStringLiteral("Alt+Home")),
                             tr("The page that lists all others"));
  back->setEnabled(false);
  forward->setEnabled(false);
  connect(back, &QAction::triggered, browser_, &QTextBrowser::backward);
  connect(forward, &QAction::triggered, browser_, &QTextBrowser::forward);
  connect(contents, &QAction::triggered, this, [this] { goTo(QStringLiteral("index.md")); });
  connect(browser_, &QTextBrowser::backwardAvailable, back, &QAction::setEnabled);
  connect(browser_, &QTextBrowser::forwardAvailable, forward, &QAction::setEnabled);
  bar->addActions({back, forward, contents});
  QAction* close = action(tr("Close"), QKeySequence::Close, tr("Close the manual"));
  close->setShortcuts({QKeySequence(QKeySequence::Close), QKeySequence(Qt::Key_Escape)});
  connect(close, &QAction::triggered, this, &QWidget::close);
  addAction(close);
}

void ManualWindow::buildSide() {
  search_->setObjectName(QStringLiteral("manualSearch"));
  search_->setPlaceholderText(tr("Search all pages"));
  search_->setClearButtonEnabled(true);
  contents_->setObjectName(QStringLiteral("manualContents"));
  contents_->setHeaderHidden(true);
  hits_->setObjectName(QStringLiteral("manualHits"));
  hits_->setWordWrap(true);
  side_->addWidget(contents_);
  side_->addWidget(hits_);
  auto* widget = new QWidget;
  auto* column = new QVBoxLayout(widget);
  column->addWidget(search_);
  column->addWidget(side_);
  auto* dock = new QDockWidget(tr("Contents"), this);
  dock->setObjectName(QStringLiteral("manualSide"));
  dock->setFeatures(QDockWidget::NoDockWidgetFeatures);
  dock->setTitleBarWidget(new QWidget);
  dock->setWidget(widget);
  addDockWidget(Qt::LeftDockWidgetArea, dock);
  resizeDocks({dock}, {300}, Qt::Horizontal);
  connect(search_, &QLineEdit::textChanged, this, &ManualWindow::search);
  connect(contents_, &QTreeWidget::currentItemChanged, this, [this](QTreeWidgetItem* item) {
    const QString page = item ? item->data(0, kPageRole).toString() : QString();
    if (!page.isEmpty() && browser_->source().fileName() != page) goTo(page);
  });
  const auto open_hit = [this](const QListWidgetItem* item) {
    if (!item || item->data(kPageRole).toString().isEmpty()) return;
    goTo(item->data(kPageRole).toString());
    find_->setText(search_->text().simplified().section(QLatin1Char(' '), 0, 0));
    find(false);
  };
  connect(hits_, &QListWidget::itemClicked, this, open_hit);
  connect(hits_, &QListWidget::itemActivated, this, open_hit);
  connect(search_, &QLineEdit::returnPressed, this, [this, open_hit] { open_hit(hits_->item(0)); });
}

void ManualWindow::buildFindBar() {
  auto* bar = new QToolBar(tr("Find"));
  bar->setObjectName(QStringLiteral("manualFindBar"));
  bar->setMovable(false);
  addToolBar(Qt::BottomToolBarArea, bar);
  find_->setObjectName(QStringLiteral("manualFind"));
  find_->setPlaceholderText(tr("Find in this page"));
  find_->setClearButtonEnabled(true);
  find_->setMaximumWidth(320);
  QAction* next = action(tr("Next"), QKeySequence::FindNext, tr("Where it is next"));
  QAction* before = action(tr("Previous"), QKeySequence::FindPrevious, tr("Where it was before"));
  QAction* begin = action(tr("Find"), QKeySequence::Find, tr("Find in this page"));
  QAction* search =
      action(tr("Search"), QKeySequence(QStringLiteral("Ctrl+Shift+F")), tr("Search all pages"));
  bar->addWidget(find_);
  bar->addActions({next, before});
  bar->addWidget(found_);
  addActions({begin, search});
  connect(find_, &QLineEdit::returnPressed, this, [this] { find(false); });
  connect(next, &QAction::triggered, this, [this] { find(false); });
  connect(before, &QAction::triggered, this, [this] { find(true); });
  for (const auto& [begins, field] : {std::pair(begin, find_), std::pair(search, search_)})
    connect(begins, &QAction::triggered, field, [field = field] {
      field->setFocus();
      field->selectAll();
    });
}

void ManualWindow::fillContents() {
  QTreeWidgetItem* chapter = nullptr;
  for (const ManualPage& page : manualPages(folder_)) {
    if (!page.chapter.isEmpty() && (!chapter || chapter->text(0) != page.chapter)) {
      chapter = new QTreeWidgetItem(contents_, {page.chapter});
      chapter->setFlags(Qt::ItemIsEnabled);
      QFont bold = font();
      bold.setBold(true);
      chapter->setFont(0, bold);
    }
    auto* item = chapter ? new QTreeWidgetItem(chapter, {page.title})
                         : new QTreeWidgetItem(contents_, {page.title});
    item->setData(0, kPageRole, page.file);
    item->setToolTip(0, page.title);
  }
  contents_->expandAll();
}

void ManualWindow::showPage(const QString& page) {
  show();  // headings have their place only in a window that has its size
  goTo(page);
  raise();
  activateWindow();
}

void ManualWindow::goTo(const QString& page) {
  if (folder_.isEmpty()) return;
  const QChar hash = QLatin1Char('#');
  QUrl address = QUrl::fromLocalFile(folder_ + QLatin1Char('/') + page.section(hash, 0, 0));
  address.setFragment(page.section(hash, 1));
  browser_->open(address);
}

/// The contents follow where links lead, and do not lead there once more.
void ManualWindow::showPlace(const QUrl& address) {
  const QSignalBlocker quiet(contents_);
  found_->clear();
  const QString page = address.fileName();
  for (QTreeWidgetItemIterator it(contents_); *it; ++it)
    if ((*it)->data(0, kPageRole).toString() == page) contents_->setCurrentItem(*it);
}

void ManualWindow::search(const QString& words) {
  hits_->clear();
  side_->setCurrentWidget(words.trimmed().isEmpty() ? static_cast<QWidget*>(contents_) : hits_);
  for (const ManualHit& hit : searchManual(folder_, words)) {
    auto* item = new QListWidgetItem(
        QStringLiteral("%1 (%2)\n%3").arg(hit.page.title).arg(hit.count).arg(hit.around), hits_);
    item->setData(kPageRole, hit.page.file);
  }
  if (hits_->count() == 0) new QListWidgetItem(tr("No page has all of these words."), hits_);
}

void ManualWindow::find(bool backward) {
  const QString words = find_->text();
  found_->clear();
  if (words.isEmpty()) return;
  const QTextDocument::FindFlags flags =
      backward ? QTextDocument::FindBackward : QTextDocument::FindFlags();
  if (browser_->find(words, flags)) return;
  // On from the other end, once.
  const QTextCursor before = browser_->textCursor();
  browser_->moveCursor(backward ? QTextCursor::End : QTextCursor::Start);
  if (browser_->find(words, flags)) return;
  browser_->setTextCursor(before);
  found_->setText(tr("not on this page"));
}

}  // namespace boresight::ui
