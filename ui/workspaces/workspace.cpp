// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/workspace.h"

#include <array>
#include <utility>

#include <QCoreApplication>

#include "ui/style/tokens.h"

namespace boresight::ui {
namespace {

constexpr Qt::DockWidgetArea kLeft = Qt::LeftDockWidgetArea;
constexpr Qt::DockWidgetArea kRight = Qt::RightDockWidgetArea;
constexpr Qt::DockWidgetArea kBottom = Qt::BottomDockWidgetArea;
constexpr int kTableDrawer = 160;  // height
constexpr int kIterationsTable = 150;
constexpr int kAnnotationTable = 220;

const std::array<WorkspaceInfo, kWorkspaceCount>& infos() {
  static const std::array<WorkspaceInfo, kWorkspaceCount> kInfos = {{
      {QT_TRANSLATE_NOOP("Workspace", "Start"),
       QT_TRANSLATE_NOOP("Workspace", "Create a case from files, open a session or an example")},
      {QT_TRANSLATE_NOOP("Workspace", "Run"),
       QT_TRANSLATE_NOOP("Workspace", "Run the case and watch how the pose is found"),
       {{"scene", kRight, kWide.run_side, nullptr, 3},
        {"closeUps", kRight, kWide.run_side, nullptr, 3},
        {"result", kRight, kWide.run_side, nullptr, 3}},
       {},
       {"scene", "closeUps", "result"}},
      {QT_TRANSLATE_NOOP("Workspace", "Diagnose"),
       QT_TRANSLATE_NOOP("Workspace", "Find the cause of a failed run, and a remedy"),
       {{"inspector", kRight, kWide.diagnose_side},
        {"remedies", kRight, kWide.diagnose_side, "inspector"},
        {"hypotheses", kRight, kWide.diagnose_side, "inspector"},
        {"configuration", kRight, kWide.diagnose_side, "inspector"},
        {"iterations", kBottom, kIterationsTable}},
       {{"inspector", kRight, kNarrow.diagnose_side}},
       {"inspector", "remedies", "iterations", "hypotheses", "configuration"},
       true},
      {QT_TRANSLATE_NOOP("Workspace", "Annotate"),
       QT_TRANSLATE_NOOP("Workspace", "Mark points and lines in the image and on the station"),
       {{"scene", kRight, 760}, {"annotation", kBottom, kAnnotationTable}},
       {{"scene", kRight, 520}, {"annotation", kBottom, kTableDrawer}},
       {"scene", "annotation", "mask", "levels"},
       true},
      {QT_TRANSLATE_NOOP("Workspace", "Review"),
       QT_TRANSLATE_NOOP("Workspace", "Check the pose, then validate or reject it"),
       {{"queue", kLeft, kWide.queue_width}, {"review", kRight, kWide.review_side}},
       {{"review", kRight, kNarrow.review_side}},
       {"review", "queue"}},
      {QT_TRANSLATE_NOOP("Workspace", "Onboard"),
       QT_TRANSLATE_NOOP("Workspace", "Compare the onboard run with a ground run"),
       {{"onboard", kBottom, 260}},
       {{"onboard", kBottom, 200}},
       {"onboard"}},
  }};
  return kInfos;
}

}  // namespace

const WorkspaceInfo& workspaceInfo(Workspace workspace) {
  return infos()[static_cast<std::size_t>(workspace)];
}

QString workspaceTitle(Workspace workspace) {
  return QCoreApplication::translate("Workspace", workspaceInfo(workspace).name);
}

QString workspaceHelp(Workspace workspace) {
  return QCoreApplication::translate("Workspace", workspaceInfo(workspace).help);
}

std::optional<Workspace> workspaceNamed(const QString& name) {
  for (int i = 0; i < kWorkspaceCount; ++i) {
    const auto workspace = static_cast<Workspace>(i);
    if (name.compare(QLatin1String(workspaceInfo(workspace).name), Qt::CaseInsensitive) == 0)
      return workspace;
  }
  return std::nullopt;
}

std::optional<Workspace> homeOf(const QString& dock) {
  static constexpr std::pair<const char*, Workspace> kHomes[] = {
      {"inspector", Workspace::kDiagnose},  {"hypotheses", Workspace::kDiagnose},
      {"annotation", Workspace::kAnnotate}, {"review", Workspace::kReview},
      {"queue", Workspace::kReview},        {"onboard", Workspace::kOnboard},
  };
  for (const auto& [name, home] : kHomes)
    if (dock == QLatin1String(name)) return home;
  return std::nullopt;
}

}  // namespace boresight::ui
