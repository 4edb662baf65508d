// SPDX-License-Identifier: Apache-2.0
#include "ui/window/start_page.h"

#include <algorithm>
#include <utility>

#include <QtWidgets>

#include "sessions/session/session_maker.h"
#include "ui/models/text.h"
#include "ui/state/document.h"
#include "ui/style/icons.h"
#include "ui/widgets/widgets.h"
#include "ui/window/session_files.h"

namespace boresight::ui {
namespace {

constexpr int kRecentShown = 5;
constexpr int kExamplePicture = 64;
constexpr int kSlotPicture = 96;  ///< high

struct SlotText {
  Icon icon;
  const char* title;
  const char* question;
};
constexpr SlotText kSlotTexts[StartPage::kSlotCount] = {
    {Icon::kImage, QT_TR_NOOP("Image"),
     QT_TR_NOOP("png, jpg, tif, or with a VICAR, PDS3 or PDS4 label")},
    {Icon::kCamera, QT_TR_NOOP("Camera"),
     QT_TR_NOOP("json or cahvor; an image's label may have it")},
    {Icon::kCube, QT_TR_NOOP("Mesh"), QT_TR_NOOP("ply, obj, stl, gltf or glb")},
    {Icon::kTarget, QT_TR_NOOP("Seed"),
     QT_TR_NOOP("The camera's approximate pose (json). Annotations can give it later.")},
};

QString headingText(const QString& title, const QString& caption) {
  return QStringLiteral("<b style='font-size:large'>%1</b>&nbsp; %2")
      .arg(title.toHtmlEscaped(), caption.toHtmlEscaped());
}

QLabel* heading(const QString& title, const QString& caption) {
  auto* label = new QLabel(headingText(title, caption));
  label->setWordWrap(true);
  return label;
}

QLabel* caption(const QString& text) {
  auto* label = new QLabel(text);
  label->setProperty("caption", true);
  label->setWordWrap(true);
  return label;
}

QFrame* card() {
  auto* frame = new QFrame;
  frame->setProperty("card", true);
  frame->setFrameShape(QFrame::StyledPanel);
  return frame;
}

void polish(QWidget* widget) {
  widget->style()->unpolish(widget);
  widget->style()->polish(widget);
}

void empty(QLayout& layout) {
  while (QLayoutItem* item = layout.takeAt(0)) {
    if (QWidget* widget = item->widget()) {
      widget->hide();  // it is deleted when the events' loop comes to it
      widget->deleteLater();
    }
    delete item;
  }
}

}  // namespace

StartPage::StartPage(SessionFiles& files, Document& document, QWidget* parent)
    : QScrollArea(parent), files_(files), document_(document) {
  setObjectName(QStringLiteral("startPage"));
  setWidgetResizable(true);
  setFrameShape(QFrame::NoFrame);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* content = named(new QWidget, "startContent");
  content->setAttribute(Qt::WA_StyledBackground);
  auto* column = new QVBoxLayout(content);
  column->setContentsMargins(24, 16, 24, 16);
  column->setSpacing(16);
  heading_ = named(heading({}, {}), "newCase");
  column->addWidget(heading_);
  column->addWidget(buildSlots());
  auto* halves = new QHBoxLayout;
  halves->setSpacing(24);
  halves->addWidget(buildExamples(), 1);
  halves->addWidget(buildGoOn(), 1);
  column->addLayout(halves);
  column->addStretch(1);
  setWidget(content);
  connect(&files_, &SessionFiles::collectedChanged, this, &StartPage::showSlots);
  refresh();
}

void StartPage::refresh() {
  const QString session = document_.isUntitled() ? tr("the open session")
                                                 : fromText(document_.file().filename().string());
  heading_->setText(
      headingText(document_.isEditable() ? tr("New case of %1").arg(session) : tr("New case"),
                  tr("Drop files anywhere in the window; each goes to its slot.")));
  showSlots();
  showRecent();
  showLeft();
}

QWidget* StartPage::buildSlots() {
  auto* box = new QWidget;
  auto* grid = new QGridLayout(box);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setSpacing(16);
  for (int i = 0; i < kSlotCount; ++i) {
    buildSlot(i);
    grid->addWidget(slots_[static_cast<std::size_t>(i)].card, 0, i);
    grid->setColumnStretch(i, 1);
  }
  return box;
}

void StartPage::buildSlot(int index) {
  FileSlot& slot = slots_[static_cast<std::size_t>(index)];
  const SlotText& text = kSlotTexts[index];
  slot.card = card();
  slot.card->setMinimumHeight(190);
  slot.state = new QLabel;
  slot.name = named(new QLabel, ("slotName" + std::to_string(index)).c_str());
  slot.name->setProperty("title", true);
  slot.name->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  slot.detail = caption({});
  slot.picture = named(new QLabel, ("slotPicture" + std::to_string(index)).c_str());
  slot.picture->hide();
  slot.choose = new QPushButton(iconOf(Icon::kFolder), tr("Choose..."));
  slot.choose->setIconSize(kButtonIcon);
  auto* icon = new IconLabel(kIcon);
  icon->setIcon(text.icon);
  auto* title = new QLabel(tr(text.title));
  title->setProperty("title", true);
  auto* head = new QHBoxLayout;
  head->addWidget(icon);
  head->addWidget(title);
  head->addStretch(1);
  head->addWidget(slot.state);
  const auto kind = static_cast<sessions::InputKind>(index);
  slot.remove = named(new QToolButton, ("slotRemove" + std::to_string(index)).c_str(),
                      tr("Remove this file from the new case"));
  slot.remove->setIcon(iconOf(Icon::kCross, &Theme::text2));
  slot.remove->setAccessibleName(tr("Remove the %1").arg(tr(text.title)));
  slot.remove->setAutoRaise(true);
  connect(slot.remove, &QToolButton::clicked, this, [this, kind] { files_.removeFile(kind); });
  head->addWidget(slot.remove);
  auto* column = new QVBoxLayout(slot.card);
  column->setContentsMargins(12, 8, 12, 12);
  column->setSpacing(8);
  column->addLayout(head);
  column->addWidget(slot.picture);
  column->addWidget(slot.name);
  column->addWidget(slot.detail);
  if (index == kMesh) {
    units_ = new QVBoxLayout;
    units_->setSpacing(2);
    column->addLayout(units_);
  }
  column->addStretch(1);
  if (index == kSeed) {
    seedless_ = named(new QPushButton(iconOf(Icon::kPencil), tr("Without a seed")), "makeSeedless",
                      tr("Create the case now, and annotate it: the solved pose can be its seed"));
    connect(seedless_, &QPushButton::clicked, &files_, &SessionFiles::makeSeedless);
    column->addWidget(seedless_);
  }
  column->addWidget(slot.choose);
  connect(slot.choose, &QPushButton::clicked, this, [this, kind] { files_.askForFile(kind); });
}

void StartPage::showSlot(int index, bool added, const QString& name, const QString& detail) {
  FileSlot& slot = slots_[static_cast<std::size_t>(index)];
  const sessions::JudgedFile& judged = files_.judged()[static_cast<std::size_t>(index)];
  const QString problem = added ? fromText(judged.problem) : QString();
  const bool bad = !problem.isEmpty();
  slot.card->setProperty("empty", !added);
  slot.state->setText(bad ? tr("✗ not usable") : added ? tr("✓ added") : tr("+ still needed"));
  slot.state->setProperty("added", added && !bad);
  slot.state->setProperty("bad", bad);
  slot.state->setProperty("needed", !added);
  slot.name->setText(name);
  slot.name->setToolTip(name);
  slot.name->setVisible(!name.isEmpty());
  slot.detail->setText(bad ? problem : added && detail.isEmpty() ? fromText(judged.text) : detail);
  slot.detail->setProperty("bad", bad);
  slot.remove->setVisible(added && !name.isEmpty());
  polish(slot.detail);
  polish(slot.card);
  polish(slot.state);
}

void StartPage::showSlots() {
  const DroppedFiles& files = files_.collected();
  const auto name = [](const std::filesystem::path& file) {
    return QString::fromStdString(file.filename().string());
  };
  const auto question = [](int slot) { return tr(kSlotTexts[slot].question); };
  showSlot(kImage, !files.one.image.empty(), name(files.one.image),
           files.one.image.empty() ? question(kImage) : QString());
  const bool labelled = files.one.camera.empty() && files.hasCamera();
  const QString remark =
      files.label_camera_remark ? fromText(*files.label_camera_remark) : QString();
  showSlot(kCamera, files.hasCamera(), labelled ? tr("the image's label") : name(files.one.camera),
           files.hasCamera()  ? QString()
           : remark.isEmpty() ? question(kCamera)
                              : remark);
  const bool has_mesh = !files.one.parts.empty();
  showSlot(kMesh, has_mesh, has_mesh ? name(files.one.parts.front().mesh) : QString(),
           has_mesh ? QString() : question(kMesh));
  showSlot(kSeed, !files.one.seed.empty(), name(files.one.seed),
           files.one.seed.empty() ? question(kSeed) : QString());
  slots_[kCamera].remove->setVisible(!files.one.camera.empty());  // a label's is the image's
  seedless_->setVisible(files.isSeedless());
  showPicture();
  showUnits();
}

void StartPage::showPicture() {
  QLabel& label = *slots_[kImage].picture;
  QPixmap picture = QPixmap::fromImage(files_.picture());
  label.setVisible(!picture.isNull());
  if (picture.isNull()) return;
  picture.setDevicePixelRatio(std::max(1.0, picture.height() / static_cast<double>(kSlotPicture)));
  label.setPixmap(picture);
}

/// The unit is chosen by the size that it gives the station.
void StartPage::showUnits() {
  const DroppedFiles& files = files_.collected();
  const bool asks = !files.one.parts.empty() && files_.meshExtent().has_value();
  const QString key =
      asks ? QString::number(*files_.meshExtent()) + fromText(files.one.parts.front().mesh_unit)
           : QString();
  if (key == shown_units_) return;
  shown_units_ = key;
  empty(*units_);
  if (!asks) return;
  units_->addWidget(caption(tr("Unit of its numbers?")));
  for (const char* unit : kMeshUnits) {
    auto* choice = new QRadioButton(meshUnitText(unit, files_.meshExtent()));
    choice->setChecked(files.one.parts.front().mesh_unit == unit);
    connect(choice, &QRadioButton::clicked, this, [this, unit] { files_.setMeshUnit(unit); });
    units_->addWidget(choice);
  }
}

QWidget* StartPage::buildExamples() {
  auto* box = new QWidget;
  auto* column = new QVBoxLayout(box);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(8);
  column->addWidget(heading(tr("Examples"), tr("ready to run; the shipped files are not changed")));
  auto* frame = card();
  auto* rows = new QVBoxLayout(frame);
  rows->setContentsMargins(12, 8, 12, 8);
  rows->setSpacing(8);
  try {
    const std::filesystem::path folder = sessions::examplesFolder();
    const std::filesystem::path stations = folder / "stations";
    rows->addWidget(exampleRow(tr("Bit carousel and orbiting sample"),
                               tr("2 images; the runs converge"), folder / "example.boresight.json",
                               stations / "bc" / "image.png"));
    rows->addWidget(exampleRow(tr("Turned seed"), tr("1 image; the run fails, with remedies"),
                               folder / "turned.boresight.json", stations / "os" / "image.png"));
    rows->addWidget(exampleRow(tr("Annotated"), tr("13 corners are marked; their pose is solved"),
                               folder / "annotated.boresight.json", stations / "bc" / "image.png"));
  } catch (const std::exception& error) {
    rows->addWidget(caption(QString::fromUtf8(error.what())));
  }
  column->addWidget(frame);
  column->addStretch(1);
  return box;
}

QWidget* StartPage::exampleRow(const QString& title, const QString& text,
                               const std::filesystem::path& session,
                               const std::filesystem::path& image) {
  auto* row = new QWidget;
  auto* line = new QHBoxLayout(row);
  line->setContentsMargins(0, 0, 0, 0);
  line->setSpacing(12);
  auto* picture = new QLabel;
  QImageReader reader(fromText(image.string()));
  reader.setScaledSize(QSize(kExamplePicture, kExamplePicture));
  picture->setPixmap(QPixmap::fromImage(reader.read()));
  picture->setFixedSize(kExamplePicture, kExamplePicture);
  auto* name = new QLabel(title);
  name->setProperty("title", true);
  auto* texts = new QVBoxLayout;
  texts->setSpacing(2);
  texts->addStretch(1);
  texts->addWidget(name);
  texts->addWidget(caption(text));
  texts->addStretch(1);
  auto* open = named(new QPushButton(iconOf(Icon::kRun), tr("Open and run")), "openExample");
  open->setAccessibleName(tr("Open and run: %1").arg(title));
  open->setIconSize(kButtonIcon);
  connect(open, &QPushButton::clicked, this, [this, session] { files_.openExample(session); });
  line->addWidget(picture);
  line->addLayout(texts, 1);
  line->addWidget(open);
  return row;
}

QWidget* StartPage::buildGoOn() {
  auto* box = new QWidget;
  auto* column = new QVBoxLayout(box);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(8);
  auto* head = new QHBoxLayout;
  head->addWidget(heading(tr("Go on"), tr("recent sessions")), 1);
  auto* open = new QPushButton(iconOf(Icon::kFolder), tr("Open..."));
  open->setToolTip(tr("Open a session (Ctrl+O)"));
  connect(open, &QPushButton::clicked, &files_, &SessionFiles::askForSession);
  head->addWidget(open);
  column->addLayout(head);
  left_ = card();
  left_->setObjectName(QStringLiteral("leftWork"));
  left_->setProperty("recovery", true);
  left_text_ = new QLabel;
  left_text_->setWordWrap(true);
  auto* discard = named(new QPushButton(iconOf(Icon::kTrash), tr("Discard")), "discardLeft");
  auto* recover = named(new QPushButton(iconOf(Icon::kReset), tr("Recover")), "recoverLeft");
  auto* line = new QHBoxLayout(left_);
  line->setContentsMargins(12, 8, 12, 8);
  line->addWidget(left_text_, 1);
  line->addWidget(discard);
  line->addWidget(recover);
  connect(recover, &QPushButton::clicked, this, [this] { files_.recoverUntitled(left_file_); });
  // Work is deleted by a second click, on a button that says so.
  connect(discard, &QPushButton::clicked, this, [this, discard] {
    if (!std::exchange(discards_, true)) return discard->setText(tr("Delete for good"));
    discards_ = false;
    discard->setText(tr("Discard"));
    Document::removeUntitled(left_file_);
    showLeft();
  });
  column->addWidget(left_);
  auto* frame = card();
  recent_ = new QVBoxLayout(frame);
  recent_->setContentsMargins(4, 4, 4, 4);
  recent_->setSpacing(0);
  column->addWidget(frame);
  column->addStretch(1);
  return box;
}

void StartPage::showRecent() {
  empty(*recent_);
  const QStringList files = recentFiles();
  for (const QString& file : files.mid(0, kRecentShown)) {
    const QFileInfo info(file);
    auto* open = new QToolButton;
    open->setAutoRaise(true);
    open->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    open->setIcon(iconOf(Icon::kFolder, &Theme::text2));
    open->setText(
        tr("%1    %2")
            .arg(info.fileName(), QLocale().toString(info.lastModified(), QLocale::ShortFormat)));
    open->setToolTip(file);
    connect(
        open, &QToolButton::clicked, this,
        [this, file] {
          if (files_.mayLeave()) files_.open(file.toStdString());
        },
        Qt::QueuedConnection);
    recent_->addWidget(open);
  }
  if (files.isEmpty())
    recent_->addWidget(caption(tr("Sessions that you open or save are listed here.")));
}

/// A session without a name that no program has open.
void StartPage::showLeft() {
  const auto file = document_.isUntitled() ? std::nullopt : Document::leftUntitled();
  left_->setVisible(file.has_value());
  if (!file) return;
  left_file_ = *file;
  QDateTime time;  // of the last change, which is in the journal
  const QFileInfo info(fromText(file->string()));
  for (const QFileInfo& each :
       info.dir().entryInfoList({info.completeBaseName() + QLatin1Char('*')}))
    time = std::max(time, each.lastModified());
  left_text_->setText(tr("<b>Unsaved work from %1</b><br>The program ended before it was saved.")
                          .arg(QLocale().toString(time, QLocale::ShortFormat)));
}

}  // namespace boresight::ui
