// SPDX-License-Identifier: Apache-2.0
#include "ui/manual/manual_window.h"

#include <algorithm>
#include <utility>

#include <QtWidgets>

namespace boresight::ui {
namespace {

constexpr int kPageMargin_px = 16;

/// By which a link names a heading: "Where is it?" is "where-is-it".
QString headingAnchor(const QString& heading) {
  QString anchor;
  for (const QChar c : heading.toLower()) {
    if (c.isLetterOrNumber() || c == QLatin1Char('_') || c == QLatin1Char('-')) anchor += c;
    if (c == QLatin1Char(' ')) anchor += QLatin1Char('-');
  }
  return anchor;
}

bool holds(const QString& text, const QStringList& words) {
  return std::all_of(words.begin(), words.end(), [&text](const QString& word) {
    return text.contains(word, Qt::CaseInsensitive);
  });
}

/// Shows the manual's pages with pictures as wide as the window at most; "search:WORDS" is the page
/// of what a search found.
class Browser : public QTextBrowser {
 public:
  Browser(const QString& folder, QWidget* parent) : QTextBrowser(parent), folder_(folder) {
    setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOn);  // pages are loaded again by width
  }

  QVariant loadResource(int type, const QUrl& name) override {
    if (name.scheme() == QLatin1String("search")) return searchManual(folder_, name.path());
    const QVariant loaded = QTextBrowser::loadResource(type, name);
    if (type != QTextDocument::ImageResource) return loaded;
    QImage picture = QImage::fromData(loaded.toByteArray());
    const int room = std::max(100, viewport()->width() - 2 * kPageMargin_px - 4);
    if (picture.width() <= room) return picture;
    // On a fine screen a wide picture is shown with all the pixels that there is room for.
    const int pixels = static_cast<int>(room * devicePixelRatioF());
    if (picture.width() > pixels) picture = picture.scaledToWidth(pixels, Qt::SmoothTransformation);
    picture.setDevicePixelRatio(static_cast<double>(picture.width()) / room);
    return picture;
  }

 protected:
  void resizeEvent(QResizeEvent* event) override {
    QTextBrowser::resizeEvent(event);
    if (event->size().width() == event->oldSize().width() || source().isEmpty()) return;
    const int place = verticalScrollBar()->value();
    reload();
    verticalScrollBar()->setValue(place);
  }

 private:
  QString folder_;
};

}  // namespace

QString manualFolder() {
  QDir folder(QCoreApplication::applicationDirPath());
  do {
    const QString place = folder.filePath(QStringLiteral("share/boresight/manual"));
    if (QFile::exists(place + QStringLiteral("/index.md"))) return place;
  } while (folder.cdUp());
  return {};
}

QString manualText(const QString& file) {
  QFile opened(file);
  if (!opened.open(QIODevice::ReadOnly)) return {};
  return QString::fromUtf8(opened.readAll());
}

std::vector<ManualPage> manualPages(const QString& folder) {
  const QString index = manualText(folder + QStringLiteral("/index.md"));
  if (index.isEmpty()) return {};
  std::vector<ManualPage> pages = {{ManualWindow::tr("Contents"), QStringLiteral("index.md")}};
  static const QRegularExpression kEntry(
      QStringLiteral("^[-*] \\[([^\\]]+)\\]\\(([A-Za-z0-9_]+\\.md)\\)"),
      QRegularExpression::MultilineOption);
  for (auto found = kEntry.globalMatch(index); found.hasNext();) {
    const QRegularExpressionMatch match = found.next();
    pages.push_back({match.captured(1), match.captured(2)});
  }
  return pages;
}

QString searchManual(const QString& folder, const QString& query) {
  const QStringList words = query.simplified().split(QLatin1Char(' '), Qt::SkipEmptyParts);
  std::vector<std::pair<int, ManualPage>> hits;
  for (const ManualPage& page : manualPages(folder)) {
    const QString text = manualText(folder + QLatin1Char('/') + page.file);
    if (words.isEmpty() || !holds(text, words)) continue;
    int count = 0;
    for (const QString& word : words)
      count += static_cast<int>(text.count(word, Qt::CaseInsensitive));
    hits.emplace_back(count, page);
  }
  std::stable_sort(hits.begin(), hits.end(), [&words](const auto& a, const auto& b) {
    return std::pair(holds(a.second.title, words), a.first) >
           std::pair(holds(b.second.title, words), b.first);
  });
  QString text = ManualWindow::tr("# Pages with \"%1\"\n\n").arg(words.join(QLatin1Char(' ')));
  if (hits.empty()) text += ManualWindow::tr("No page has all of these words.");
  for (const auto& [count, page] : hits)
    text += QStringLiteral("- [%1](%2) (%3)\n")
                .arg(page.title, QUrl::fromLocalFile(folder + QLatin1Char('/') + page.file)
                                     .toString(QUrl::FullyEncoded))
                .arg(count);
  return text;
}

ManualWindow::ManualWindow(const QString& folder, QWidget* parent)
    : QMainWindow(parent, Qt::Window),
      folder_(folder),
      browser_(new Browser(folder, this)),
      find_(new QLineEdit) {
  setObjectName(QStringLiteral("manualWindow"));
  setWindowTitle(tr("Manual - Boresight"));
  setCentralWidget(browser_);
  browser_->setOpenLinks(false);
  browser_->document()->setDocumentMargin(kPageMargin_px);
  find_->setObjectName(QStringLiteral("manualFind"));
  find_->setPlaceholderText(tr("Find on this page; Ctrl+Shift+F: in all pages"));
  find_->setClearButtonEnabled(true);
  QToolBar* bar = addToolBar(tr("Pages"));
  bar->setMovable(false);
  const auto action = [this](const QString& text, const QKeySequence& keys, auto&& act) {
    auto* made = new QAction(text, this);
    made->setShortcut(keys);
    connect(made, &QAction::triggered, this, act);
    return made;
  };
  QAction* back = action(tr("Back"), QKeySequence::Back, [this] { browser_->backward(); });
  QAction* forward = action(tr("Forward"), QKeySequence::Forward, [this] { browser_->forward(); });
  bar->addActions({back, forward,
                   action(tr("Contents"), QKeySequence(QStringLiteral("Alt+Home")),
                          [this] { goTo(QStringLiteral("index.md")); })});
  bar->addWidget(find_);
  bar->addActions({action(tr("Next"), QKeySequence::FindNext, [this] { find(false); }),
                   action(tr("Previous"), QKeySequence::FindPrevious, [this] { find(true); }),
                   action(tr("Search all pages"), QKeySequence(QStringLiteral("Ctrl+Shift+F")),
                          [this] { searchAllPages(); })});
  addActions({action(tr("Find"), QKeySequence::Find,
                     [this] {
                       find_->setFocus();
                       find_->selectAll();
                     }),
              action(tr("Close"), QKeySequence(Qt::Key_Escape), [this] { close(); })});
  connect(browser_, &QTextBrowser::backwardAvailable, back, &QAction::setEnabled);
  connect(browser_, &QTextBrowser::forwardAvailable, forward, &QAction::setEnabled);
  connect(browser_, &QTextBrowser::anchorClicked, this, &ManualWindow::follow);
  connect(browser_, &QTextBrowser::sourceChanged, this, &ManualWindow::dress);
  connect(find_, &QLineEdit::returnPressed, this, [this] { find(false); });
  resize(1000, 800);
  if (folder_.isEmpty())
    browser_->setPlainText(
        tr("The manual is not there: share/boresight/manual lies neither beside the program nor in "
           "its build tree. Install the program again, or build the target 'manual'."));
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
  follow(address);
}

void ManualWindow::follow(const QUrl& address) {
  if (!address.isLocalFile() && !address.isRelative()) {
    QDesktopServices::openUrl(address);
  } else {
    browser_->setSource(address, QTextDocument::MarkdownResource);
  }
}

/// Gives tables lines and goes to the heading that the address names.
void ManualWindow::dress(const QUrl& address) {
  QTextDocument& page = *browser_->document();
  for (QTextFrame* frame : page.rootFrame()->childFrames()) {
    auto* table = qobject_cast<QTextTable*>(frame);
    if (!table) continue;
    QTextTableFormat format = table->format();
    format.setBorder(1);
    format.setBorderStyle(QTextFrameFormat::BorderStyle_Solid);
    format.setBorderBrush(palette().brush(QPalette::Mid));
    format.setBorderCollapse(true);
    format.setCellPadding(4);
    format.setCellSpacing(0);
    table->setFormat(format);
  }
  if (!address.hasFragment()) return;
  for (QTextBlock block = page.begin(); block.isValid(); block = block.next()) {
    if (block.blockFormat().headingLevel() == 0) continue;
    if (headingAnchor(block.text()) != address.fragment()) continue;
    browser_->setTextCursor(QTextCursor(block));
    const QAbstractTextDocumentLayout* layout = page.documentLayout();
    (void)layout->documentSize();  // now: places are laid out when they are needed else
    browser_->verticalScrollBar()->setValue(
        static_cast<int>(layout->blockBoundingRect(block).top()));
    return;
  }
}

void ManualWindow::find(bool backward) {
  const QString words = find_->text();
  const QTextDocument::FindFlags flags =
      backward ? QTextDocument::FindBackward : QTextDocument::FindFlags();
  if (words.isEmpty() || browser_->find(words, flags)) return;
  // On from the other end, once.
  const QTextCursor before = browser_->textCursor();
  browser_->moveCursor(backward ? QTextCursor::End : QTextCursor::Start);
  if (browser_->find(words, flags)) return;
  browser_->setTextCursor(before);
  searchAllPages();
}

void ManualWindow::searchAllPages() {
  if (folder_.isEmpty() || find_->text().trimmed().isEmpty()) return;
  QUrl address;
  address.setScheme(QStringLiteral("search"));
  address.setPath(find_->text());
  browser_->setSource(address, QTextDocument::MarkdownResource);
}

ManualHelp::ManualHelp(QMainWindow& window) : QObject(&window), window_(window) {
  setObjectName(QStringLiteral("manualHelp"));
}

QString ManualHelp::pageHere() const {
  const QWidget* focus = window_.focusWidget();
  for (; focus; focus = focus->parentWidget())
    if (const auto* dock = qobject_cast<const QDockWidget*>(focus))
      return QStringLiteral("window.md#") + headingAnchor(dock->windowTitle());
  return QStringLiteral("index.md");
}

void ManualHelp::showHere() {
  if (!manual_) {
    manual_ = std::make_unique<ManualWindow>(manualFolder());
    // The program ends with its main window, even while the manual is open.
    manual_->setAttribute(Qt::WA_QuitOnClose, false);
  }
  manual_->showPage(pageHere());
}

}  // namespace boresight::ui
