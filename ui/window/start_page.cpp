// SPDX-License-Identifier: Apache-2.0
#include "ui/window/start_page.h"

#include <algorithm>
#include <utility>

#include <QtWidgets>

#include "ui_example_row.h"

#include "sessions/session/session_maker.h"
#include "ui/models/text.h"
#include "ui/state/document.h"
#include "ui/style/icons.h"
#include "ui/widgets/widgets.h"
#include "ui/window/session_files.h"

namespace boresight::ui {
namespace {

constexpr int kRecentShown = 5;
constexpr int kSlotPicture = 96;  ///< high

struct SlotText {
  Icon icon;
  const char* title;
  const char* question;
};
/// In the order of `InputKind`.
constexpr SlotText kSlotTexts[] = {
    {Icon::kImage, "Image", "png, jpg, tif, or with a VICAR, PDS3 or PDS4 label"},
    {Icon::kCamera, "Camera", "json or cahvor; an image's label may have it"},
    {Icon::kCube, "Mesh", "ply, obj, stl, gltf or glb"},
    {Icon::kTarget, "Seed", "The camera's approximate pose (json). Annotations can give it later."},
};
static_assert(std::size(kSlotTexts) == sessions::kInputKinds);

QString headingText(const QString& title, const QString& caption) {
  return QStringLiteral("<b style='font-size:large'>%1</b>&nbsp; %2")
      .arg(title.toHtmlEscaped(), caption.toHtmlEscaped());
}

/// As the desktop writes dates; numbers of the program do not follow it.
QString shortTime(const QDateTime& time) {
  return QLocale::system().toString(time, QLocale::ShortFormat);
}

}  // namespace

StartPage::StartPage(SessionFiles& files, Document& document, QWidget* parent)
    : QScrollArea(parent), files_(files), document_(document) {
  ui_.setupUi(this);
  ui_.startContent->setAttribute(Qt::WA_StyledBackground);
  for (const InputKind kind : kAllInputs) buildSlot(kind);
  buildExamples();
  ui_.goOnHeading->setText(headingText(tr("Go on"), tr("recent sessions")));
  ui_.openOther->setIcon(iconOf(Icon::kFolder));
  connect(ui_.openOther, &QPushButton::clicked, &files_, &SessionFiles::askForSession);
  buildLeft();
  connect(&files_, &SessionFiles::collectedChanged, this, &StartPage::showSlots);
  refresh();
}

void StartPage::refresh() {
  const QString session = document_.isUntitled() ? tr("the open session")
                                                 : fromText(document_.file().filename().string());
  ui_.newCase->setText(
      headingText(document_.isEditable() ? tr("New case of %1").arg(session) : tr("New case"),
                  tr("Drop files anywhere in the window; each goes to its slot.")));
  showSlots();
  showRecent();
  showLeft();
}

void StartPage::buildSlot(InputKind kind) {
  FileSlot& file = slot(kind);
  const int index = static_cast<int>(kind);
  const SlotText& text = kSlotTexts[index];
  file.card = new QFrame;
  file.setupUi(file.card);
  ui_.slotGrid->addWidget(file.card, 0, index);
  ui_.slotGrid->setColumnStretch(index, 1);
  file.name->setObjectName(QStringLiteral("slotName%1").arg(index));
  file.picture->setObjectName(QStringLiteral("slotPicture%1").arg(index));
  file.remove->setObjectName(QStringLiteral("slotRemove%1").arg(index));
  file.icon->setFixedSize(kIcon, kIcon);
  file.icon->setIcon(text.icon);
  file.kind->setText(tr(text.title));
  file.remove->setIcon(iconOf(Icon::kCross, &Theme::text2));
  file.remove->setAccessibleName(tr("Remove the %1").arg(tr(text.title)));
  file.choose->setIcon(iconOf(Icon::kFolder));
  file.choose->setIconSize(kButtonIcon);
  connect(file.remove, &QToolButton::clicked, this, [this, kind] { files_.removeFile(kind); });
  connect(file.choose, &QPushButton::clicked, this, [this, kind] { files_.askForFile(kind); });
  if (kind == InputKind::kMesh) {
    units_ = new QVBoxLayout;
    units_->setSpacing(2);
    file.column->insertLayout(file.column->indexOf(file.detail) + 1, units_);
  } else if (kind == InputKind::kSeed) {
    seedless_ = named(new QPushButton(iconOf(Icon::kPencil), tr("Without a seed")), "makeSeedless",
                      tr("Create the case now, and annotate it: the solved pose can be its seed"));
    connect(seedless_, &QPushButton::clicked, &files_, &SessionFiles::makeSeedless);
    file.column->insertWidget(file.column->indexOf(file.choose), seedless_);
    setTabOrder(seedless_, file.choose);
  }
}

void StartPage::showSlot(InputKind kind) {
  const FileSlot& file = slot(kind);
  const DroppedFiles& files = files_.collected();
  const sessions::JudgedFile& judged = files_.judged()[static_cast<std::size_t>(kind)];
  const bool added = files.has(kind);
  const bool bad = added && !judged.problem.empty();
  const std::filesystem::path path = files.fileOf(kind);
  const QString name =
      added && path.empty() ? tr("the image's label") : fromText(path.filename().string());
  QString detail = fromText(bad ? judged.problem : judged.text);
  if (!added) detail = tr(kSlotTexts[static_cast<std::size_t>(kind)].question);
  if (!added && kind == InputKind::kCamera && files.label_camera_remark)
    detail = fromText(*files.label_camera_remark);
  file.card->setProperty("empty", !added);
  file.state->setText(bad ? tr("✗ not usable") : added ? tr("✓ added") : tr("+ still needed"));
  file.state->setProperty("added", added && !bad);
  file.state->setProperty("bad", bad);
  file.state->setProperty("needed", !added);
  file.name->setText(name);
  file.name->setToolTip(name);
  file.name->setVisible(!name.isEmpty());
  file.detail->setText(detail);
  file.detail->setProperty("bad", bad);
  file.remove->setVisible(!path.empty());  // a camera in the image's label cannot be removed alone
  restyle({file.detail, file.card, file.state});
}

void StartPage::showSlots() {
  for (const InputKind kind : kAllInputs) showSlot(kind);
  seedless_->setVisible(files_.collected().isSeedless());
  showPicture();
  showUnits();
}

void StartPage::showPicture() {
  QLabel& label = *slot(InputKind::kImage).picture;
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
  clearLayoutLater(*units_);
  if (!asks) return;
  units_->addWidget(captionLabel(tr("Unit of its numbers?")));
  for (const char* unit : kMeshUnits) {
    auto* choice = new QRadioButton(meshUnitText(unit, files_.meshExtent()));
    choice->setChecked(files.one.parts.front().mesh_unit == unit);
    connect(choice, &QRadioButton::clicked, this, [this, unit] { files_.setMeshUnit(unit); });
    units_->addWidget(choice);
  }
}

void StartPage::buildExamples() {
  ui_.examplesHeading->setText(
      headingText(tr("Examples"), tr("ready to run; the shipped files are not changed")));
  try {
    const std::filesystem::path folder = sessions::examplesFolder();
    const std::filesystem::path stations = folder / "stations";
    addExample(tr("Bit carousel and orbiting sample"), tr("2 images; the runs converge"),
               folder / "example.boresight.json", stations / "bc" / "image.png");
    addExample(tr("Turned seed"), tr("1 image; the run fails, with remedies"),
               folder / "turned.boresight.json", stations / "os" / "image.png");
    addExample(tr("Annotated"), tr("13 corners are marked; their pose is solved"),
               folder / "annotated.boresight.json", stations / "bc" / "image.png");
  } catch (const std::exception& error) {
    ui_.exampleRows->addWidget(captionLabel(QString::fromUtf8(error.what())));
  }
}

void StartPage::addExample(const QString& title, const QString& text,
                           const std::filesystem::path& session,
                           const std::filesystem::path& image) {
  auto* row = new QWidget;
  Ui::ExampleRow ui;
  ui.setupUi(row);
  QImageReader reader(fromText(image.string()));
  reader.setScaledSize(ui.picture->maximumSize());
  ui.picture->setPixmap(QPixmap::fromImage(reader.read()));
  ui.title->setText(title);
  ui.text->setText(text);
  ui.openExample->setIcon(iconOf(Icon::kRun));
  ui.openExample->setIconSize(kButtonIcon);
  ui.openExample->setAccessibleName(tr("Open and run: %1").arg(title));
  connect(ui.openExample, &QPushButton::clicked, this,
          [this, session] { files_.openExample(session); });
  ui_.exampleRows->addWidget(row);
}

/// Work is deleted by a second click, on a button that says so.
void StartPage::buildLeft() {
  ui_.discardLeft->setIcon(iconOf(Icon::kTrash));
  ui_.recoverLeft->setIcon(iconOf(Icon::kReset));
  connect(ui_.recoverLeft, &QPushButton::clicked, this,
          [this] { files_.recoverUntitled(left_file_); });
  connect(ui_.discardLeft, &QPushButton::clicked, this, [this] {
    const bool deletes = discards_;
    setDiscards(!deletes);
    if (!deletes) return;
    Document::removeUntitled(left_file_);
    showLeft();
  });
}

void StartPage::setDiscards(bool discards) {
  discards_ = discards;
  ui_.discardLeft->setText(discards_ ? tr("Delete for good") : tr("Discard"));
}

void StartPage::showRecent() {
  clearLayoutLater(*ui_.recent);
  const QStringList files = recentFiles();
  for (const QString& file : files.mid(0, kRecentShown)) {
    const QFileInfo info(file);
    auto* open = new QToolButton;
    open->setAutoRaise(true);
    open->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    open->setIcon(iconOf(Icon::kFolder, &Theme::text2));
    open->setText(tr("%1    %2").arg(info.fileName(), shortTime(info.lastModified())));
    open->setToolTip(file);
    connect(
        open, &QToolButton::clicked, this, [this, file] { files_.leaveFor(file.toStdString()); },
        Qt::QueuedConnection);
    ui_.recent->addWidget(open);
  }
  if (files.isEmpty())
    ui_.recent->addWidget(captionLabel(tr("Sessions that you open or save are listed here.")));
}

/// A session without a name that no program has open.
void StartPage::showLeft() {
  const auto file = document_.isUntitled() ? std::nullopt : Document::leftUntitled();
  ui_.leftWork->setVisible(file.has_value());
  const std::filesystem::path left = file.value_or(std::filesystem::path());
  if (std::exchange(left_file_, left) != left) setDiscards(false);
  if (!file) return;
  QDateTime time;  // of the last change, which is in the journal
  const QFileInfo info(fromText(file->string()));
  for (const QFileInfo& each :
       info.dir().entryInfoList({info.completeBaseName() + QLatin1Char('*')}))
    time = std::max(time, each.lastModified());
  ui_.leftText->setText(tr("<b>Unsaved work from %1</b><br>The program ended before it was saved.")
                            .arg(shortTime(time)));
}

}  // namespace boresight::ui
