// SPDX-License-Identifier: Apache-2.0
#include "ui/manual/manual_window.h"

#include <algorithm>

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

/// Shows the manual's pages with pictures as wide as the window at most.
class Browser : public QTextBrowser {
 public:
  explicit Browser(QWidget* parent) : QTextBrowser(parent) {
    setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOn);  // pages are loaded again by width
  }

  QVariant loadResource(int type, const QUrl& name) override {
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

QStringList manualPages(const QString& folder) {
  const QString index = manualText(folder + QStringLiteral("/index.md"));
  if (index.isEmpty()) return {};
  QStringList pages = {QStringLiteral("index.md")};
  static const QRegularExpression kEntry(
      QStringLiteral("^[-*] \\[[^\\]]+\\]\\(([A-Za-z0-9_]+\\.md)\\)"),
      QRegularExpression::MultilineOption);
  for (auto found = kEntry.globalMatch(index); found.hasNext();) pages << found.next().captured(1);
  return pages;
}

ManualWindow::ManualWindow(const QString& folder, QWidget* parent)
    : QMainWindow(parent, Qt::Window),
      folder_(folder),
      browser_(new Browser(this)),
      find_(new QLineEdit) {
  ui_.setupUi(this);
  setObjectName(QStringLiteral("manualWindow"));
  setCentralWidget(browser_);
  browser_->setOpenLinks(false);
  browser_->document()->setDocumentMargin(kPageMargin_px);
  find_->setObjectName(QStringLiteral("manualFind"));
  find_->setPlaceholderText(tr("Find in the manual"));
  find_->setClearButtonEnabled(true);
  ui_.bar->insertWidget(ui_.next, find_);
  const auto on = [this](QAction* action, auto&& act) {
    connect(action, &QAction::triggered, this, act);
  };
  on(ui_.back, [this] { browser_->backward(); });
  on(ui_.forward, [this] { browser_->forward(); });
  on(ui_.contents, [this] { goTo(QStringLiteral("index.md")); });
  on(ui_.next, [this] { find(false); });
  on(ui_.previous, [this] { find(true); });
  on(ui_.findField, [this] {
    find_->setFocus();
    find_->selectAll();
  });
  on(ui_.closeWindow, [this] { close(); });
  connect(browser_, &QTextBrowser::backwardAvailable, ui_.back, &QAction::setEnabled);
  connect(browser_, &QTextBrowser::forwardAvailable, ui_.forward, &QAction::setEnabled);
  connect(browser_, &QTextBrowser::anchorClicked, this, &ManualWindow::follow);
  connect(browser_, &QTextBrowser::sourceChanged, this, &ManualWindow::dress);
  connect(find_, &QLineEdit::returnPressed, this, [this] { find(false); });
  resize(1000, 800);
  if (folder_.isEmpty())
    browser_->setPlainText(
        tr("The manual is missing: share/boresight/manual is neither next to the program nor in "
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
  const QStringList pages = manualPages(folder_);
  const int count = static_cast<int>(pages.size());
  const int current = std::max(0, static_cast<int>(pages.indexOf(browser_->source().fileName())));
  for (int i = 1; i <= count; ++i) {  // this page again at last
    const QString& page = pages[(current + (backward ? count - i : i)) % count];
    if (!manualText(folder_ + QLatin1Char('/') + page).contains(words, Qt::CaseInsensitive))
      continue;
    goTo(page);
    browser_->moveCursor(backward ? QTextCursor::End : QTextCursor::Start);
    if (browser_->find(words, flags)) return;
  }
  statusBar()->showMessage(tr("Not in the manual: %1").arg(words));
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
