// SPDX-License-Identifier: Apache-2.0
#include "ui/window/session_files.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <QtWidgets>

#include "sessions/io/meshes/mesh_file.h"
#include "sessions/io/meshes/scene_mesh.h"
#include "sessions/session/input_check.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_of_results.h"
#include "ui/models/text.h"
#include "ui/review/onboard_controller.h"
#include "ui/review/pose_export.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/views/display_image.h"
#include "ui/widgets/wait_box.h"
#include "ui/widgets/widgets.h"
#include "ui/window/case_controller.h"
#include "ui/window/change_input.h"
#include "ui/window/log_hint.h"

namespace boresight::ui {

namespace {

constexpr int kRecentFiles = 10;
constexpr QSize kPicture(512, 192);  ///< of a chosen image, at most
constexpr const char* kRecentKey = "recent";

QString text(const std::filesystem::path& file) { return fromText(file.string()); }

std::filesystem::path path(const QString& file) { return file.toStdString(); }

}  // namespace

QStringList recentFiles() {
  QStringList files;
  for (const QString& file : QSettings().value(QLatin1String(kRecentKey)).toStringList())
    if (QFileInfo::exists(file)) files << file;
  return files;
}

void noteRecentFile(const std::filesystem::path& file) {
  const QString name = fromText(std::filesystem::absolute(file).string());
  QStringList files = recentFiles();
  files.removeAll(name);
  files.prepend(name);
  while (files.size() > kRecentFiles) files.removeLast();
  QSettings().setValue(QLatin1String(kRecentKey), files);
}

std::filesystem::path sessionFileName(std::filesystem::path file) {
  constexpr std::string_view kJson = ".json";
  if (file.extension() != kJson) file += ".boresight.json";
  return file;
}

QString meshUnitText(const char* unit, const std::optional<double>& extent) {
  if (!extent) return QString::fromLatin1(unit);
  const double size_mm = 1e3 * sessions::metresPerUnit(unit).value_or(1.0) * *extent;
  return QObject::tr("%1: %2 mm across").arg(QString::fromLatin1(unit)).arg(size_mm, 0, 'g', 3);
}

SessionFiles::SessionFiles(QWidget& window, WindowParts& parts)
    : QObject(&window), window_(window), parts_(parts) {
  // Tasks of the session that is left end without a result.
  connect(&parts_.document, &Document::left, this, [this] {
    if (!std::exchange(requested_, {}).empty()) Q_EMIT noted({});
  });
}

bool SessionFiles::open(const std::filesystem::path& file, Former former) {
  if (!parts_.document.open(file, former)) return false;
  noteRecentFile(file);
  return true;
}

void SessionFiles::leaveFor(const std::filesystem::path& file) {
  if (const auto former = mayLeave()) open(file, *former);
}

void SessionFiles::askForSession() {
  const QString file = QFileDialog::getOpenFileName(&window_, tr("Open a session"), {},
                                                    tr("Sessions (*.json);;All files (*)"));
  if (!file.isEmpty()) leaveFor(path(file));
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
  const bool restarts = alone.startsNewCase(collected_);
  const DroppedFiles dropped = restarts ? alone : classify(files, collected_);
  const std::string kept = restarts ? std::string() : alone.keptNames(collected_);
  for (const std::string& problem : dropped.problems) Q_EMIT failed(fromText(problem));
  if (!files.empty() && alone.problems.size() == files.size()) return;  // none can be used
  if (dropped.session) {
    leaveFor(*dropped.session);
    return;
  }
  if (dropped.results) return makeFrom(*dropped.results, true);
  kept_ = fromText(kept);
  collect(dropped, !restarts && !dropped.dataset);
  // Of the case that is open, unless it comes with the files of another.
  if (dropped.isRecordAlone() && parts_.state.currentCase()) {
    const std::filesystem::path record = *collected_.record;
    forgetCollected();
    parts_.onboard.attach(record);
    return;
  }
  if (dropped.dataset) {
    if (dropped.record)
      Q_EMIT failed(tr("A dataset has many cases: open the case of %1, then drop the record again.")
                        .arg(text(dropped.record->filename())));
    return makeFrom(*dropped.dataset, false);
  }
  if (!dropped.isCase() && dropped.problems.empty())
    Q_EMIT noted(tr("%1 of 4 files added. Still needed: %2.")
                     .arg(dropped.count())
                     .arg(fromText(dropped.missing())));
  measureMesh();
  if (dropped.isCase()) makeCollected();
}

void SessionFiles::collect(const DroppedFiles& files, bool amends) {
  if (amends && requested_.erase(collection_) && requested_.empty())
    Q_EMIT noted({});  // no files are read for a case any more
  collected_ = files;
  ++collection_;
  judgeCollected();
}

/// Each is read at once, so that a wrong one is known before the others are there.
void SessionFiles::judgeCollected() {
  struct Judged {
    sessions::JudgedFiles files;
    QImage picture;
  };
  judged_ = {};
  picture_ = {};
  Q_EMIT collectedChanged();
  parts_.tasks.replace(
      judging_,
      [files = collected_.one](const std::stop_token&) {
        Judged judged{sessions::judgeFiles(files), {}};
        if (const auto image = std::move(judged.files.front().image))
          judged.picture = grayImage(image->view())
                               .scaled(kPicture, Qt::KeepAspectRatio, Qt::SmoothTransformation);
        return judged;
      },
      [this](const Judged& judged) {
        judged_ = judged.files;
        picture_ = judged.picture;
        Q_EMIT collectedChanged();
      },
      reportTo(this, &SessionFiles::failed));
}

std::optional<InputKind> SessionFiles::nextKind() const {
  for (const InputKind kind : kAllInputs)
    if (!judged_[static_cast<std::size_t>(kind)].problem.empty()) return kind;
  for (const InputKind kind : kAllInputs)
    if (!collected_.has(kind)) return kind;
  return std::nullopt;
}

void SessionFiles::askForFile(InputKind kind) {
  const QString file = QFileDialog::getOpenFileName(
      &window_, tr("The %1 of the case").arg(inputName(kind)), {}, inputFilter(kind));
  if (!file.isEmpty()) take({path(file)});
}

void SessionFiles::askForNext() {
  if (collected_.count() == 0) return askForFiles();
  if (const auto kind = nextKind())
    askForFile(*kind);
  else
    makeCollected();
}

void SessionFiles::removeFile(InputKind kind) {
  DroppedFiles files = collected_;
  if (kind == InputKind::kImage) {
    files.one.image.clear();
    files.label_camera_remark.reset();
  } else if (kind == InputKind::kCamera) {
    files.one.camera.clear();
  } else if (kind == InputKind::kMesh) {
    files.one.parts.clear();
    mesh_extent_.reset();
  } else {
    files.one.seed.clear();
  }
  collect(files);
}

FilesSituation SessionFiles::situation() const {
  FilesSituation situation{collected_.count(), {}};
  const auto next = nextKind();
  if (situation.added == 0 || !next) return situation;
  const std::string missing = collected_.missing();
  if (!missing.empty()) situation.missing = tr("Still needed: %1.").arg(fromText(missing));
  situation.next = inputName(*next);
  situation.problem = fromText(judged_[static_cast<std::size_t>(*next)].problem);
  return situation;
}

void SessionFiles::forgetCollected() {
  collected_ = {};
  ++collection_;
  judged_ = {};
  picture_ = {};
  mesh_extent_.reset();
  Q_EMIT collectedChanged();
}

void SessionFiles::makeSeedless() {
  if (collected_.isSeedless()) makeCollected();
}

void SessionFiles::setMeshUnit(const std::string& unit) {
  DroppedFiles files = collected_;
  for (sessions::PartSource& part : files.one.parts) part.mesh_unit = unit;
  collect(files);
  if (collected_.isCase()) makeCollected();
}

/// What the unit would make of the mesh: a mesh takes a while to read.
void SessionFiles::measureMesh() {
  mesh_extent_.reset();
  if (collected_.one.parts.empty() || !collected_.one.parts.front().mesh_unit.empty()) return;
  std::vector<sessions::PartSource> parts = collected_.one.parts;
  for (sessions::PartSource& part : parts) {
    if (sessions::statesUnit(part.mesh)) return;
    part.mesh_unit = "m";
  }
  parts_.tasks.replace(
      measuring_,
      [parts](const std::stop_token&) {
        const sessions::SceneMesh scene = sessions::readScene(parts);
        double extent = 0.0;
        for (const sessions::MeshInfo& info : scene.infos)
          extent = std::max(extent, info.diagonal_m());
        return extent;
      },
      [this, mesh = parts.front().mesh](double extent) {
        if (collected_.one.parts.empty() || collected_.one.parts.front().mesh != mesh) return;
        mesh_extent_ = extent;
        Q_EMIT collectedChanged();
      },
      [](const QString&) {});  // reported when the case is created
}

/// After the mesh was measured: the same thread does one after the other. Of the same files one
/// case is made, however often it is requested.
void SessionFiles::makeCollected() {
  if (!requested_.insert(collection_).second) return;
  const Request request{collected_, collection_, kept_};
  parts_.of_document.ofDocument(
      newCaseName(), [](const std::stop_token&) { return true; },
      [this, request](bool) {
        if (isRequested(request) && !addCase(request)) requested_.erase(request.collection);
      },
      [this, request](const QString& message) {
        if (requested_.erase(request.collection)) Q_EMIT failed(message);
      });
}

void SessionFiles::openExample(const std::filesystem::path& file) {
  const std::optional<Former> former = mayLeave();
  if (!former) return;
  try {
    const auto example = sessions::SessionDocument::open(file, sessions::Access::kReadOnly);
    if (parts_.document.createUntitled(example.session(), *former)) parts_.cases.runOnceLoaded();
  } catch (const std::exception& error) {
    Q_EMIT failed(QString::fromUtf8(error.what()));
  }
}

void SessionFiles::recoverUntitled(const std::filesystem::path& file) {
  const std::optional<Former> former = mayLeave();
  if (!former) return;
  recovers_ = true;  // as the operator has requested
  const bool opened = parts_.document.open(file, *former);
  recovers_ = false;
  if (opened && parts_.document.recovery()) parts_.document.acceptRecovery();
}

void SessionFiles::closeSession() {
  if (const auto former = mayLeave()) parts_.document.close(*former);
}

/// Every image and mesh is read and hashed: off the UI's thread. Runs of results become cases, the
/// worst first, and the queue is brought to the front. The open session is left when that is done.
void SessionFiles::makeFrom(const std::filesystem::path& file, bool results) {
  forgetCollected();
  Q_EMIT noted(
      (results ? tr("Reading %1 and its dataset's files ...") : tr("Reading %1 and its files ..."))
          .arg(text(file.filename())));
  parts_.tasks.replace(
      making_,
      [file, results](const std::stop_token&) {
        return results ? sessions::sessionOfResults(file) : sessions::makeSession(file);
      },
      [this, results](const sessions::Session& session) {
        Q_EMIT noted({});
        // Asked now: during the reading the open session was worked on.
        const std::optional<Former> former = mayLeave();
        if (former && parts_.document.createUntitled(session, *former) && results)
          Q_EMIT queueWanted();
      },
      reportTo(this, &SessionFiles::failed));
}

ResultName SessionFiles::newCaseName() {
  return {tr("The new case"), tr("choose its files again")};
}

/// Whether a dialog was about the session that is open; tells where it was not.
bool SessionFiles::isStillOpen(int opening) {
  if (opening == parts_.document.openings()) return true;
  Q_EMIT failed(
      tr("The new case was not added: another session was opened meanwhile. Choose its "
         "files again in the session that it belongs to."));
  return false;
}

/// False: no case is made of them.
bool SessionFiles::addCase(Request request) {
  // Also shown at its file, which is out of sight where a case is open.
  const FilesSituation files = situation();
  if (request.collection == collection_ && !files.problem.isEmpty()) {
    std::filesystem::path file = collected_.fileOf(*nextKind());
    if (file.empty()) file = collected_.one.image;  // the camera is in the image's label
    Q_EMIT failed(tr("%1: %2").arg(text(file.filename()), files.problem));
    return false;
  }
  const int opening = parts_.document.openings();
  if (!askForUnits(request.files) || !isStillOpen(opening) || !isRequested(request)) return false;
  if (request.collection == collection_) collected_.one.parts = request.files.one.parts;
  makeCase(request);
  return true;
}

void SessionFiles::makeCase(const Request& request) {
  Q_EMIT noted(tr("Reading the files ..."));
  parts_.of_document.ofDocument(
      newCaseName(),
      [files = request.files](const std::stop_token&) {
        sessions::SessionCase session_case = sessions::makeCase(files.one).made;
        if (files.record)
          session_case.onboard_record = {*files.record, sessions::inputSha256(*files.record)};
        return session_case;
      },
      [this, request](sessions::SessionCase session_case) {
        if (!isRequested(request)) return;  // withdrawn, with its note
        const bool taken = takeCase(std::move(session_case));
        requested_.erase(request.collection);
        // The collected files stay when they make no case yet: a further file may be needed. So do
        // those of a later drop.
        if (taken && request.collection == collection_) forgetCollected();
        Q_EMIT noted(taken && !request.kept.isEmpty()
                         ? tr("Also of earlier drops: %1").arg(request.kept)
                         : QString());
      },
      [this, request](const QString& message) {
        if (requested_.erase(request.collection)) Q_EMIT failed(message);
      });
}

/// Part of the open session, or a new one where none can be edited. False when it is in no session:
/// the operator has cancelled, or it cannot be written.
bool SessionFiles::takeCase(sessions::SessionCase session_case) {
  Document& document = parts_.document;
  if (!document.isEditable()) {
    const std::optional<Former> former = mayLeave();
    return former && document.createUntitled(
                         sessions::withCase(sessions::Session(), std::move(session_case)), *former);
  }
  const int opening = document.openings();
  if (!askForId(session_case) || !isStillOpen(opening)) return false;
  const QString id = fromText(session_case.id);
  if (!document.edit(sessions::withCase(document.session(), std::move(session_case)),
                     tr("Add %1").arg(id)))
    return false;
  parts_.cases.chooseCase(id);
  Q_EMIT caseAdded();
  return true;
}

/// A case of the same id may be replaced, or both kept. False: neither.
bool SessionFiles::askForId(sessions::SessionCase& session_case) {
  const sessions::Session session = parts_.document.session();
  if (session.findCase(session_case.id) == nullptr) return true;
  const std::string free = sessions::freeCaseId(session, session_case.id);
  const QString id = fromText(session_case.id);
  QMessageBox box(QMessageBox::Question, tr("Boresight"),
                  tr("The session has a case %1. Replace it, or keep both?").arg(id),
                  QMessageBox::Cancel, &window_);
  box.setInformativeText(tr("Replacing drops its inputs; its runs become outdated. Keeping both "
                            "names the new case %1.")
                             .arg(fromText(free)));
  QAbstractButton* both =
      named(box.addButton(tr("Keep both"), QMessageBox::AcceptRole), "keepBoth");
  QAbstractButton* replace =
      named(box.addButton(tr("Replace"), QMessageBox::DestructiveRole), "replaceCase");
  box.exec();
  // Of the session as it is by now.
  if (box.clickedButton() == both)
    session_case.id = sessions::freeCaseId(parts_.document.session(), session_case.id);
  return box.clickedButton() == both || box.clickedButton() == replace;
}

bool SessionFiles::askForUnits(DroppedFiles& files) {
  QStringList units;
  for (const char* unit : kMeshUnits) units << meshUnitText(unit, mesh_extent_);
  for (sessions::PartSource& part : files.one.parts) {
    if (!part.mesh_unit.empty() || sessions::statesUnit(part.mesh)) continue;
    bool chosen = false;
    const QString unit = QInputDialog::getItem(
        &window_, tr("Unit of the mesh"),
        tr("%1 states no unit. Its coordinates are in").arg(text(part.mesh.filename())), units, 0,
        false, &chosen);
    if (!chosen) return false;
    part.mesh_unit = kMeshUnits[static_cast<std::size_t>(units.indexOf(unit))];
  }
  return true;
}

bool SessionFiles::save() {
  if (parts_.document.isUntitled() || !parts_.document.isEditable()) return saveAs();
  return parts_.document.save();
}

bool SessionFiles::saveAs() {
  const Document& document = parts_.document;
  const int opening = document.openings();
  const QString name = document.isUntitled() || !document.isOpen()
                           ? tr("session.boresight.json")
                           : text(document.file().filename());
  const QString chosen = QFileDialog::getSaveFileName(&window_, tr("Save the session"),
                                                      inSessionFolder(document, name),
                                                      tr("Sessions (*.boresight.json)"));
  if (chosen.isEmpty()) return false;
  const std::filesystem::path file = sessionFileName(path(chosen));
  // The dialog has asked about the name without the suffix.
  if (file != path(chosen) && std::filesystem::exists(file) &&
      QMessageBox::question(&window_, tr("Save the session"),
                            tr("%1 exists. Replace it?").arg(text(file.filename()))) !=
          QMessageBox::Yes)
    return false;
  if (opening != document.openings()) {
    Q_EMIT failed(tr("Nothing was saved: another session was opened meanwhile."));
    return false;
  }
  if (!parts_.document.saveAs(file)) return false;
  noteRecentFile(file);
  return true;
}

void SessionFiles::offerSavingElsewhere(const QString& reason) {
  QMessageBox box(QMessageBox::Warning, tr("Boresight"), reason, QMessageBox::NoButton, &window_);
  box.setTextInteractionFlags(Qt::TextSelectableByMouse);
  box.setInformativeText(
      tr("The file keeps its last saved state; all changes are still in this window. Free space or "
         "allow writing, or save the session elsewhere."));
  noteInLog(box);
  QAbstractButton* elsewhere = box.addButton(tr("Save elsewhere..."), QMessageBox::AcceptRole);
  box.addButton(QMessageBox::Close);
  box.exec();
  if (box.clickedButton() == elsewhere) saveAs();
}

void SessionFiles::offerReadingAgain(const QString& reason) {
  const Document& document = parts_.document;
  const int opening = document.openings();
  QMessageBox box(QMessageBox::Warning, tr("Boresight"), reason, QMessageBox::NoButton, &window_);
  box.setTextInteractionFlags(Qt::TextSelectableByMouse);
  box.setInformativeText(
      document.isModified()
          ? tr("Nothing was written: the file is as the other program left it, all changes are "
               "still in this window. Save them under another name; reading the file again drops "
               "them.")
          : tr("Nothing was written: the file is as the other program left it. This window has no "
               "unsaved changes."));
  noteInLog(box);
  QAbstractButton* elsewhere = box.addButton(tr("Save as..."), QMessageBox::AcceptRole);
  QAbstractButton* again = box.addButton(tr("Read again"), QMessageBox::DestructiveRole);
  box.addButton(QMessageBox::Close);
  box.exec();
  if (opening != document.openings()) return;  // it was about another session
  if (box.clickedButton() == elsewhere) saveAs();
  if (box.clickedButton() == again) open(document.file(), Former::kDiscard);
}

/// Runs are stored in the session that they were run from.
void SessionFiles::finishStoring() {
  waitOrLeave(
      &window_,
      tr("Runs of %1 are being written next to %2. Its folder may not answer.")
          .arg(parts_.store.waiting().join(QStringLiteral(", ")), text(parts_.document.file())),
      tr("Do not wait"), [this] { return !parts_.store.isStoring(); });
}

bool SessionFiles::mayLoseRuns() {
  const QStringList runs = parts_.store.waiting();
  if (runs.isEmpty()) return true;
  QMessageBox box(QMessageBox::Warning, tr("Boresight"),
                  tr("Runs of %1 are not stored; they exist only in this window.")
                      .arg(runs.join(QStringLiteral(", "))),
                  QMessageBox::Discard | QMessageBox::Cancel, &window_);
  box.setInformativeText(parts_.store.unstoredReason());
  noteInLog(box);
  QAbstractButton* elsewhere = box.addButton(tr("Save elsewhere..."), QMessageBox::AcceptRole);
  const int answer = box.exec();
  if (answer == QMessageBox::Cancel) return false;  // also where they were stored meanwhile
  if (box.clickedButton() == elsewhere && saveAs()) finishStoring();
  return answer == QMessageBox::Discard || parts_.store.waiting().isEmpty();
}

std::optional<Former> SessionFiles::mayLeave() {
  Q_EMIT parts_.document.aboutToChange();  // or a gesture under way would be lost
  finishStoring();
  if (!mayLoseRuns()) return std::nullopt;
  const Document& document = parts_.document;
  const std::filesystem::path asked = document.file();
  const bool untitled = document.isUntitled();
  if (!untitled && !document.isModified()) return Former::kKeep;
  QMessageBox box(QMessageBox::Question, tr("Boresight"),
                  untitled ? tr("Save this session? It has no name yet.")
                           : tr("Save the changes of %1?").arg(text(document.file().filename())),
                  QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, &window_);
  box.setInformativeText(
      untitled ? tr("Discarding deletes the session and its runs; its input files stay.")
               : tr("Discarding drops them for good."));
  const int answer = box.exec();
  if (document.file() != asked) return std::nullopt;  // a task has opened another one meanwhile
  if (answer == QMessageBox::Discard) return Former::kDiscard;
  // Where saving failed it may have been saved under another name.
  const bool saved = answer == QMessageBox::Save &&
                     (save() || (document.file() != asked && !document.isModified()));
  return saved ? std::optional(Former::kKeep) : std::nullopt;
}

void SessionFiles::offerRecovery(const QString& notices) {
  Document& document = parts_.document;
  if (!document.recovery() || recovers_) return;
  const sessions::Recovery& recovery = **document.recovery();
  const QString time = tr("%1 UTC").arg(timeText(recovery.time));
  const QString changes =
      recovery.edits.size() == 1 ? tr("1 change") : tr("%1 changes").arg(recovery.edits.size());
  QMessageBox box(QMessageBox::Question, tr("Boresight"),
                  tr("Recover unsaved work of %1 from %2 (%3)?")
                      .arg(text(document.file().filename()), time, changes),
                  QMessageBox::NoButton, &window_);
  box.setInformativeText(notices);
  QStringList edits;
  for (const std::string& edit : recovery.edits) edits << fromText(edit);
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
