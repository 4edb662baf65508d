// SPDX-License-Identifier: Apache-2.0
#include "ui/manual/manual_browser.h"

#include <algorithm>

#include <QAbstractTextDocumentLayout>
#include <QDesktopServices>
#include <QImage>
#include <QResizeEvent>
#include <QScrollBar>
#include <QTextBlock>
#include <QTextCursor>
#include <QTextDocument>
#include <QTextTable>
#include <QUrl>

#include "ui/manual/manual_folder.h"

namespace boresight::ui {
namespace {

constexpr int kMargin_px = 16;
constexpr double kCellPadding_px = 4;
constexpr int kLongestName = 36;  // of an option, a file, a table's column

QColor mixed(const QColor& a, const QColor& b, double share_of_b) {
  const auto part = [share_of_b](int x, int y) {
    return static_cast<int>(x + share_of_b * (y - x));
  };
  return {part(a.red(), b.red()), part(a.green(), b.green()), part(a.blue(), b.blue())};
}

/// Names in the first column are not broken where they are short.
void keepNames(QTextTable& table) {
  for (int row = 1; row < table.rows(); ++row) {
    const QTextTableCell cell = table.cellAt(row, 0);
    const QTextBlock block = cell.firstCursorPosition().block();
    if (block.text().size() > kLongestName || block.text().contains(QLatin1Char(' '))) continue;
    QTextBlockFormat format = block.blockFormat();
    format.setNonBreakableLines(true);
    QTextCursor(block).setBlockFormat(format);
  }
}

bool isCode(const QTextBlock& block) {
  return block.isValid() && (block.blockFormat().nonBreakableLines() ||
                             block.blockFormat().hasProperty(QTextFormat::BlockCodeFence));
}

/// Every picture's name in the document.
QStringList picturesOf(const QTextDocument& document) {
  QStringList names;
  for (QTextBlock block = document.begin(); block.isValid(); block = block.next()) {
    for (auto it = block.begin(); !it.atEnd(); ++it) {
      const QTextImageFormat format = it.fragment().charFormat().toImageFormat();
      if (format.isValid()) names << format.name();
    }
  }
  return names;
}

}  // namespace

ManualBrowser::ManualBrowser(QWidget* parent) : QTextBrowser(parent) {
  setObjectName(QStringLiteral("manualBrowser"));
  setOpenLinks(false);
  document()->setDocumentMargin(kMargin_px);
  connect(this, &QTextBrowser::anchorClicked, this, &ManualBrowser::followLink);
  connect(this, &QTextBrowser::sourceChanged, this, [this](const QUrl& address) {
    dress();
    if (!address.fragment().isEmpty()) goToHeading(address.fragment());
  });
}

void ManualBrowser::open(const QUrl& address) {
  setSource(address, QTextDocument::MarkdownResource);
}

void ManualBrowser::followLink(const QUrl& address) {
  if (address.isLocalFile() || address.isRelative()) {
    open(address);
  } else {
    QDesktopServices::openUrl(address);
  }
}

int ManualBrowser::roomForPictures() const {
  return std::max(100, viewport()->width() - 2 * kMargin_px - 4);
}

QVariant ManualBrowser::loadResource(int type, const QUrl& name) {
  const QVariant loaded = QTextBrowser::loadResource(type, name);
  if (type != QTextDocument::ImageResource) return loaded;
  QImage picture = QImage::fromData(loaded.toByteArray());
  const int room = roomForPictures();
  if (picture.width() <= room) return picture;
  // On a fine screen a wide picture is shown with all the pixels that there is room for.
  const int pixels = static_cast<int>(room * devicePixelRatioF());
  if (picture.width() > pixels) picture = picture.scaledToWidth(pixels, Qt::SmoothTransformation);
  picture.setDevicePixelRatio(static_cast<double>(picture.width()) / room);
  return picture;
}

void ManualBrowser::resizeEvent(QResizeEvent* event) {
  QTextBrowser::resizeEvent(event);
  if (event->size().width() != event->oldSize().width()) fitPictures();
}

/// The document keeps pictures that it has loaded: they are given to it anew.
void ManualBrowser::fitPictures() {
  if (fitted_width_ == roomForPictures()) return;
  fitted_width_ = roomForPictures();
  const QStringList names = picturesOf(*document());
  for (const QString& name : names) {
    const QUrl address = source().resolved(QUrl(name));
    document()->addResource(QTextDocument::ImageResource, address,
                            loadResource(QTextDocument::ImageResource, address));
  }
  if (!names.isEmpty()) document()->markContentsDirty(0, document()->characterCount());
}

void ManualBrowser::dress() {
  fitted_width_ = roomForPictures();
  document()->setUndoRedoEnabled(false);
  QTextCursor all(document());
  all.beginEditBlock();  // laid out once, not after every cell
  dressCode();
  dressTables();
  all.endEditBlock();
}

void ManualBrowser::dressTables() {
  const QColor line = mixed(palette().color(QPalette::Base), palette().color(QPalette::Text), 0.3);
  const QColor head = mixed(palette().color(QPalette::Base), palette().color(QPalette::Text), 0.08);
  for (QTextFrame* frame : document()->rootFrame()->childFrames()) {
    auto* table = qobject_cast<QTextTable*>(frame);
    if (!table) continue;
    QTextTableFormat format = table->format();
    format.setBorder(1);
    format.setBorderStyle(QTextFrameFormat::BorderStyle_Solid);
    format.setBorderBrush(line);
    format.setBorderCollapse(true);
    format.setCellPadding(kCellPadding_px);
    format.setCellSpacing(0);
    format.setTopMargin(6);
    format.setBottomMargin(10);
    table->setFormat(format);
    keepNames(*table);
    for (int column = 0; column < table->columns(); ++column) {
      QTextTableCell cell = table->cellAt(0, column);
      QTextCharFormat dressed = cell.format();
      dressed.setBackground(head);
      cell.setFormat(dressed);
    }
  }
}

void ManualBrowser::dressCode() {
  const QColor ground =
      mixed(palette().color(QPalette::Base), palette().color(QPalette::Text), 0.08);
  for (QTextBlock block = document()->begin(); block.isValid(); block = block.next()) {
    // The reader leaves an empty line at the end.
    if (!isCode(block) || (block.text().isEmpty() && !isCode(block.next()))) continue;
    QTextBlockFormat format = block.blockFormat();
    format.setBackground(ground);
    format.setLeftMargin(12);
    QTextCursor(block).setBlockFormat(format);
  }
}

void ManualBrowser::goToHeading(const QString& anchor) {
  for (QTextBlock block = document()->begin(); block.isValid(); block = block.next()) {
    if (block.blockFormat().headingLevel() == 0 || headingAnchor(block.text()) != anchor) continue;
    setTextCursor(QTextCursor(block));
    const QAbstractTextDocumentLayout* layout = document()->documentLayout();
    (void)layout->documentSize();  // now: places are laid out when they are needed else
    verticalScrollBar()->setValue(static_cast<int>(layout->blockBoundingRect(block).top()));
    return;
  }
}

}  // namespace boresight::ui
