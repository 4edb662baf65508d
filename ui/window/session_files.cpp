// SPDX-License-Identifier: Apache-2.0
#include "ui/window/session_files.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <QtWidgets>

#include "sessions/io/cahvor_file.h"
#include "sessions/io/json_reader.h"
#include "sessions/io/labels/image_label.h"
#include "sessions/session/input_check.h"
#include "sessions/session/session_of_results.h"
#include "sessions/text/plain_text.h"
#include "ui/review/onboard_controller.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/window/case_controller.h"

namespace boresight::ui {

namespace {

/// What a file is, as what it does to the files taken so far.
using Take = void (*)(const std::filesystem::path& file, DroppedFiles& taken);

/// Throws when the label of an image cannot be read or lacks its pixels.
void takeImage(const std::filesystem::path& file, DroppedFiles& taken) {
  std::optional<std::string> remark;
  if (sessions::hasImageLabel(file)) {
    const sessions::ImageLabel label = sessions::readImageLabel(file);
    remark = label.camera ? std::string() : label.camera_remark;
  }
  taken.one.image = file;
  taken.label_camera_remark = remark;
}

void takeMesh(const std::filesystem::path& file, DroppedFiles& taken) {
  taken.one.parts.emplace_back().mesh = file;
}

void takeCamera(const std::filesystem::path& file, DroppedFiles& taken) { taken.one.camera = file; }

void takePose(const std::filesystem::path& file, DroppedFiles& taken) {
  if (sessions::lowerCase(file.stem().string()).find("truth") != std::string::npos)
    taken.one.truth = file;
  else
    taken.one.seed = file;
}

void takeTransform(const std::filesystem::path& file, DroppedFiles& taken) {
  taken.one.transforms.push_back(file);
}

template <std::optional<std::filesystem::path> DroppedFiles::*Member>
void takeAs(const std::filesystem::path& file, DroppedFiles& taken) {
  taken.*Member = file;
}

struct FileKind {
  std::vector<std::string> names;  ///< extensions, or values of `format`
  Take take;
};

Take findTake(const std::vector<FileKind>& kinds, const std::string& name) {
  for (const FileKind& kind : kinds)
    if (std::ranges::find(kind.names, name) != kind.names.end()) return kind.take;
  return nullptr;
}

Take takeOfJson(const std::filesystem::path& file) {
  static const std::vector<FileKind> kFormats = {
      {{"boresight-camera"}, takeCamera},
      {{"boresight-pose"}, takePose},
      {{"boresight-transform", "boresight-frames"}, takeTransform},
      {{"boresight-dataset"}, takeAs<&DroppedFiles::dataset>},
      {{"boresight-session"}, takeAs<&DroppedFiles::session>},
  };
  const auto bytes =
      sessions::readFileBytes(file, sessions::kMaxJsonBytes, sessions::FileUse::kFree);
  const sessions::JsonDocument document(file, sessions::asText(bytes));
  const std::string format = document.root().at("format").nonEmptyText();
  if (const Take take = findTake(kFormats, format)) return take;
  throw std::runtime_error(
      file.string() + ": the format '" + format +
      "' cannot be opened in the window (camera, pose, transform, dataset, session)");
}

/// Throws when it is nothing known.
Take takeOf(const std::filesystem::path& file) {
  static const std::vector<FileKind> kExtensions = {
      {{".png", ".jpg", ".jpeg", ".tif", ".tiff"}, takeImage},
      {{".ply", ".obj", ".stl", ".gltf", ".glb"}, takeMesh},
      {{".whsr"}, takeAs<&DroppedFiles::record>},
      {{".sqlite"}, takeAs<&DroppedFiles::results>},
  };
  const std::string extension = sessions::lowerCase(file.extension().string());
  if (const Take take = findTake(kExtensions, extension)) return take;
  if (extension == ".json") return takeOfJson(file);
  if (extension == ".zip")
    throw std::runtime_error(file.string() + ": an archive; unpack it, then open its session");
  if (sessions::isCahvorFile(file)) return takeCamera;
  if (sessions::hasImageLabel(file)) return takeImage;
  throw std::runtime_error(
      file.string() +
      ": not an image (png, jpg, tif, or with a VICAR, PDS3 or PDS4 label), a mesh (ply, obj, "
      "stl, gltf, glb), a camera (json, cahvor), an onboard record (whsr), results (sqlite) "
      "or a json file");
}

}  // namespace

bool DroppedFiles::isCase() const {
  return !one.image.empty() && hasCamera() && !one.seed.empty() && !one.parts.empty();
}

bool DroppedFiles::hasCamera() const {
  return !one.camera.empty() || (label_camera_remark && label_camera_remark->empty());
}

bool DroppedFiles::isRecordAlone() const {
  return record && !dataset && one.image.empty() && one.camera.empty() && one.seed.empty() &&
         one.parts.empty() && !one.truth;
}

std::string DroppedFiles::missing() const {
  std::vector<std::string> names;
  if (one.image.empty()) names.emplace_back("an image");
  if (!hasCamera())
    names.emplace_back("a camera (json)" +
                       (label_camera_remark ? ": " + *label_camera_remark : ""));
  if (one.parts.empty()) names.emplace_back("a mesh");
  if (one.seed.empty()) names.emplace_back("a seed pose (json)");
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  return text;
}

bool DroppedFiles::beginsAnew(const DroppedFiles& earlier) const {
  const bool more =
      !one.camera.empty() || !one.seed.empty() || !one.parts.empty() || one.truth.has_value();
  return isCase() || (!one.image.empty() && !earlier.one.image.empty() && more);
}

std::string DroppedFiles::keptNames(const DroppedFiles& earlier) const {
  std::string names;
  const auto add = [&names](const std::filesystem::path& file, bool replaced) {
    if (!file.empty() && !replaced) names += (names.empty() ? "" : ", ") + file.filename().string();
  };
  add(earlier.one.image, !one.image.empty());
  add(earlier.one.camera, !one.camera.empty());
  for (const sessions::PartSource& part : earlier.one.parts) add(part.mesh, !one.parts.empty());
  add(earlier.one.seed, !one.seed.empty());
  add(earlier.one.truth.value_or(""), one.truth.has_value());
  for (const std::filesystem::path& file : earlier.one.transforms) add(file, false);
  add(earlier.record.value_or(""), record.has_value());
  return names;
}

DroppedFiles classify(const std::vector<std::filesystem::path>& files,
                      const DroppedFiles& earlier) {
  DroppedFiles dropped_files;
  dropped_files.one = earlier.one;
  dropped_files.record = earlier.record;
  dropped_files.label_camera_remark = earlier.label_camera_remark;
  dropped_files.one.parts.clear();
  for (const std::filesystem::path& file : files) {
    try {
      takeOf(file)(file, dropped_files);
    } catch (const std::exception& error) {
      dropped_files.problems.emplace_back(error.what());
    }
  }
  if (dropped_files.one.parts.empty()) dropped_files.one.parts = earlier.one.parts;
  return dropped_files;
}

namespace {

constexpr int kRecentFiles = 10;
constexpr const char* kRecentKey = "recent";

QString text(const std::filesystem::path& file) { return QString::fromStdString(file.string()); }

std::filesystem::path path(const QString& file) { return file.toStdString(); }

}  // namespace

QStringList recentFiles() {
  QStringList files;
  for (const QString& file : QSettings().value(QLatin1String(kRecentKey)).toStringList())
    if (QFileInfo::exists(file)) files << file;
  return files;
}

void noteRecentFile(const std::filesystem::path& file) {
  const QString name = QString::fromStdString(std::filesystem::absolute(file).string());
  QStringList files = recentFiles();
  files.removeAll(name);
  files.prepend(name);
  while (files.size() > kRecentFiles) files.removeLast();
  QSettings().setValue(QLatin1String(kRecentKey), files);
}

SessionFiles::SessionFiles(QWidget& window, const WindowParts& parts)
    : QObject(&window), window_(window), parts_(parts) {}

bool SessionFiles::open(const std::filesystem::path& file) {
  if (!parts_.document.open(file)) return false;
  noteRecentFile(file);
  return true;
}

void SessionFiles::askForSession() {
  const QString file = QFileDialog::getOpenFileName(&window_, tr("Open a session"), {},
                                                    tr("Sessions (*.json);;All files (*)"));
  if (!file.isEmpty() && mayLeave()) open(path(file));
}

void SessionFiles::askForFiles() {
  const QStringList files = QFileDialog::getOpenFileNames(
      &window_, tr("A dataset, results, or an image, a camera, a mesh, a seed and transforms"), {},
      tr("All (*.json *.sqlite *.whsr *.img *.IMG *.vic *.VIC *.lbl *.LBL *.xml *.cahv *.cahvor "
         "*.cahvore *.png *.jpg *.jpeg *.tif *.tiff *.ply *.obj *.stl *.gltf "
         "*.glb)"));
  std::vector<std::filesystem::path> paths;
  for (const QString& file : files) paths.push_back(path(file));
  if (!paths.empty()) take(paths);
}

void SessionFiles::take(const std::vector<std::filesystem::path>& files) {
  const DroppedFiles alone = classify(files);
  const bool restarts = alone.beginsAnew(collected_);
  const DroppedFiles dropped = restarts ? alone : classify(files, collected_);
  const std::string kept = restarts ? std::string() : alone.keptNames(collected_);
  for (const std::string& problem : dropped.problems)
    Q_EMIT failed(QString::fromStdString(problem));
  if (dropped.session) {
    if (mayLeave()) open(*dropped.session);
    return;
  }
  if (dropped.results) {
    makeFrom(*dropped.results, true);
    return;
  }
  collected_ = dropped;
  // Of the case that is open, unless it comes with the files of another.
  if (dropped.isRecordAlone() && parts_.state.currentCase()) {
    parts_.onboard.attach(*std::exchange(collected_, {}).record);
    return;
  }
  if (!dropped.dataset && !dropped.isCase()) {
    if (dropped.problems.empty())
      Q_EMIT noted(tr("Added. Still needed: %1").arg(QString::fromStdString(dropped.missing())));
    return;
  }
  if (dropped.dataset) {
    if (dropped.record)
      Q_EMIT failed(tr("A dataset has many cases: open the case of %1, then drop the record again.")
                        .arg(text(dropped.record->filename())));
    makeFrom(*dropped.dataset, false);
  } else {
    addCase(QString::fromStdString(kept));
  }
}

/// Every image and mesh is read and hashed: off the UI's thread. Runs of results become cases, the
/// most troubled first, and the queue comes to the front.
void SessionFiles::makeFrom(const std::filesystem::path& file, bool results) {
  if (!mayLeave()) return;
  collected_ = {};
  Q_EMIT noted(
      (results ? tr("Reading %1 and its dataset's files ...") : tr("Reading %1 and its files ..."))
          .arg(text(file.filename())));
  parts_.tasks.start(
      QStringLiteral("make session"),
      [file, results](const std::stop_token&) {
        return results ? sessions::sessionOfResults(file) : sessions::makeSession(file);
      },
      [this, results](const sessions::Session& session) {
        Q_EMIT noted({});
        parts_.document.createUntitled(session);
        if (results) Q_EMIT queueWanted();
      });
}

/// `kept`: names of files of earlier drops that the case is made of, too.
void SessionFiles::addCase(const QString& kept) {
  if (!askForUnits()) return;
  Q_EMIT noted(tr("Reading the files ..."));
  parts_.tasks.start(
      QStringLiteral("make session"),
      [files = collected_](const std::stop_token&) {
        sessions::SessionCase session_case = sessions::makeCase(files.one).made;
        if (files.record)
          session_case.onboard_record = {*files.record, sessions::inputSha256(*files.record)};
        return session_case;
      },
      [this, kept](sessions::SessionCase session_case) {
        // Until now: whatever was wrong may be mended by a further file, e.g. a transform.
        collected_ = {};
        Q_EMIT noted(kept.isEmpty() ? QString() : tr("Also of earlier drops: %1").arg(kept));
        takeCase(std::move(session_case));
      });
}

void SessionFiles::takeCase(sessions::SessionCase session_case) {
  const QString id = QString::fromStdString(session_case.id);
  Document& document = parts_.document;
  const sessions::Session session = sessions::withCase(document.session(), std::move(session_case));
  if (!document.isEditable()) {
    document.createUntitled(session);
  } else if (document.edit(session, tr("Add %1").arg(id))) {
    parts_.cases.chooseCase(id);
  }
}

bool SessionFiles::askForUnits() {
  for (sessions::PartSource& part : collected_.one.parts) {
    if (!part.mesh_unit.empty()) continue;
    const std::string extension = part.mesh.extension().string();
    if (extension == ".gltf" || extension == ".glb") continue;  // metres by their definition
    bool chosen = false;
    const QString unit = QInputDialog::getItem(
        &window_, tr("Unit of the mesh"),
        tr("%1 states no unit. Its coordinates are in").arg(text(part.mesh.filename())),
        {QStringLiteral("m"), QStringLiteral("mm"), QStringLiteral("cm"), QStringLiteral("in"),
         QStringLiteral("ft")},
        0, false, &chosen);
    if (!chosen) return false;
    part.mesh_unit = unit.toStdString();
  }
  return true;
}

bool SessionFiles::save() {
  if (parts_.document.isUntitled()) return saveAs();
  return parts_.document.save();
}

bool SessionFiles::saveAs() {
  const QString file = QFileDialog::getSaveFileName(&window_, tr("Save the session"), {},
                                                    tr("Sessions (*.boresight.json)"));
  if (file.isEmpty() || !parts_.document.saveAs(path(file))) return false;
  noteRecentFile(path(file));
  return true;
}

void SessionFiles::offerSavingElsewhere(const QString& reason) {
  QMessageBox box(QMessageBox::Warning, tr("Boresight"), reason, QMessageBox::NoButton, &window_);
  box.setTextInteractionFlags(Qt::TextSelectableByMouse);
  box.setInformativeText(
      tr("The file keeps its last saved state; all changes are still in this window. Free space or "
         "allow writing, or save the session elsewhere."));
  QAbstractButton* elsewhere = box.addButton(tr("Save elsewhere..."), QMessageBox::AcceptRole);
  box.addButton(QMessageBox::Close);
  box.exec();
  if (box.clickedButton() == elsewhere) saveAs();
}

bool SessionFiles::mayLoseRuns() {
  const QStringList runs = parts_.cases.unstoredRuns();
  if (runs.isEmpty()) return true;
  QMessageBox box(QMessageBox::Warning, tr("Boresight"),
                  tr("No space for runs of %1; they exist only in this window.")
                      .arg(runs.join(QStringLiteral(", "))),
                  QMessageBox::Discard | QMessageBox::Cancel, &window_);
  QAbstractButton* elsewhere = box.addButton(tr("Save elsewhere..."), QMessageBox::AcceptRole);
  const int answer = box.exec();
  if (box.clickedButton() == elsewhere && saveAs()) parts_.cases.finishStoring();
  return answer == QMessageBox::Discard || parts_.cases.unstoredRuns().isEmpty();
}

bool SessionFiles::mayLeave() {
  if (!mayLoseRuns()) return false;
  Document& document = parts_.document;
  const bool untitled = document.isUntitled();
  if (!untitled && !document.isModified()) return true;
  QMessageBox box(QMessageBox::Question, tr("Boresight"),
                  untitled ? tr("Save this session? It has no name yet.")
                           : tr("Save the changes of %1?").arg(text(document.file().filename())),
                  QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, &window_);
  box.setInformativeText(
      untitled ? tr("Discarding deletes the session and its runs; its input files stay.")
               : tr("Unsaved changes stay in the journal and can be recovered when the session is "
                    "opened again."));
  const int answer = box.exec();
  if (answer == QMessageBox::Save) return save();
  if (answer == QMessageBox::Discard && untitled) document.discardUntitled();
  return answer == QMessageBox::Discard;
}

void SessionFiles::offerUntitled() {
  const std::optional<std::filesystem::path> left = Document::leftUntitled();
  if (!left) return;
  QMessageBox box(QMessageBox::Question, tr("Boresight"),
                  tr("Recover the unsaved session of the last program run?"),
                  QMessageBox::Yes | QMessageBox::No, &window_);
  box.setInformativeText(tr("It is stored in %1 until it is saved or discarded.").arg(text(*left)));
  if (box.exec() == QMessageBox::Yes) parts_.document.open(*left);
}

void SessionFiles::offerRecovery() {
  Document& document = parts_.document;
  if (!document.recovery()) return;
  const sessions::Recovery& recovery = **document.recovery();
  QMessageBox box(QMessageBox::Question, tr("Boresight"),
                  (recovery.edits.size() == 1
                       ? tr("%1 has an unsaved change of %2.")
                       : tr("%1 has %3 unsaved changes, the last of %2.")
                             .replace(QLatin1String("%3"), QString::number(recovery.edits.size())))
                      .arg(text(document.file().filename()), QString::fromStdString(recovery.time)),
                  QMessageBox::NoButton, &window_);
  QStringList edits;
  for (const std::string& edit : recovery.edits) edits << QString::fromStdString(edit);
  box.setDetailedText(edits.join(QLatin1Char('\n')));
  QAbstractButton* accept = box.addButton(tr("Recover"), QMessageBox::AcceptRole);
  box.addButton(tr("Set aside"), QMessageBox::DestructiveRole);
  box.exec();
  if (box.clickedButton() == accept)
    document.acceptRecovery();
  else
    document.declineRecovery();
}

}  // namespace boresight::ui
