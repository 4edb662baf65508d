// SPDX-License-Identifier: Apache-2.0
#include "ui/window/change_input.h"

#include <QtWidgets>

#include "ui/models/text.h"
#include "ui/state/document.h"
#include "ui/widgets/widgets.h"
#include "ui/window/case_controller.h"
#include "ui/window/session_files.h"

namespace boresight::ui {
namespace {

QString changeText(const char* text) { return QCoreApplication::translate("ChangeInput", text); }

struct InputText {
  const char* name;
  const char* filter;
};
/// In the order of `InputKind`.
constexpr InputText kInputTexts[] = {
    {"image", "Images (*.png *.jpg *.jpeg *.tif *.tiff *.img *.IMG *.vic *.VIC *.lbl *.LBL *.xml)"},
    {"camera", "Cameras (*.json *.cahv *.cahvor *.cahvore)"},
    {"mesh", "Meshes (*.ply *.obj *.stl *.gltf *.glb)"},
    {"seed", "Poses and transforms (*.json)"},
};
static_assert(std::size(kInputTexts) == sessions::kInputKinds);

/// Unless another case, or session, was opened below the dialog.
void changeIfOpen(WindowParts& parts, const CaseOpening& seen, const QString& case_id,
                  InputKind kind, const std::filesystem::path& file, const std::string& unit) {
  if (seen == parts.state.opening())
    parts.cases.changeInput(case_id, kind, file, unit);
  else
    Q_EMIT parts.cases.failed(leftText(seen));
}

/// Empty when the operator has cancelled.
std::string askUnit(QWidget& window, const QString& mesh, const std::string& former) {
  QStringList units;
  for (const char* unit : kMeshUnits) units << QString::fromLatin1(unit);
  bool chosen = false;
  const QString unit = QInputDialog::getItem(
      &window, changeText("Unit of the mesh"), changeText("The coordinates of %1 are in").arg(mesh),
      units, std::max(0, static_cast<int>(units.indexOf(fromText(former)))), false, &chosen);
  return chosen ? unit.toStdString() : std::string();
}

}  // namespace

QString inputName(InputKind kind) {
  return changeText(kInputTexts[static_cast<std::size_t>(kind)].name);
}

QString inputFilter(InputKind kind) {
  return changeText(kInputTexts[static_cast<std::size_t>(kind)].filter) +
         changeText(";;All files (*)");
}

void askForInput(WindowParts& parts, QWidget& window, const QString& case_id, InputKind kind) {
  const sessions::SessionCase* found = parts.document.session().findCase(case_id.toStdString());
  if (!found) return;
  const CaseOpening seen = parts.state.opening();
  const std::filesystem::path former =
      kind == InputKind::kMesh ? found->parts.front().source.mesh : found->image.source.file;
  const std::string former_unit = found->parts.front().source.mesh_unit;
  const QString file = QFileDialog::getOpenFileName(
      &window, changeText("Another %1 for %2").arg(inputName(kind), case_id),
      fromText(former.parent_path().string()), inputFilter(kind));
  if (file.isEmpty()) return;
  std::string unit;
  if (kind == InputKind::kMesh && !sessions::statesUnit(file.toStdString())) {
    unit = askUnit(window, QFileInfo(file).fileName(), former_unit);
    if (unit.empty()) return;
  }
  changeIfOpen(parts, seen, case_id, kind, file.toStdString(), unit);
}

void askForMeshUnit(WindowParts& parts, QWidget& window, const QString& case_id) {
  const sessions::SessionCase* found = parts.document.session().findCase(case_id.toStdString());
  if (!found) return;
  const CaseOpening seen = parts.state.opening();
  const sessions::PartSource source = found->parts.front().source;
  const std::string unit =
      askUnit(window, fromText(source.mesh.filename().string()), source.mesh_unit);
  if (!unit.empty()) changeIfOpen(parts, seen, case_id, InputKind::kMesh, source.mesh, unit);
}

void addChangeInput(QMenu& menu, WindowParts& parts, QWidget& window, const QString& case_id) {
  for (const InputKind kind : kAllInputs) {
    QString text = inputName(kind);
    text[0] = text[0].toUpper();
    menu.addAction(changeText("%1...").arg(text), &parts.cases,
                   [&parts, &window, case_id, kind] { askForInput(parts, window, case_id, kind); });
  }
  menu.addAction(changeText("Unit of the mesh..."), &parts.cases,
                 [&parts, &window, case_id] { askForMeshUnit(parts, window, case_id); });
}

}  // namespace boresight::ui
