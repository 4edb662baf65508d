// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <QString>
#include <Qt>

namespace boresight::ui {

/// Workspaces of the window, one per task, in the order of their tabs and keys (Ctrl+1 to 6).
enum class Workspace { kStart, kRun, kDiagnose, kAnnotate, kReview, kOnboard };
inline constexpr int kWorkspaceCount = 6;

/// Default placement of a dock in a workspace.
struct PlacedDock {
  const char* dock;  ///< object name
  Qt::DockWidgetArea area;
  int size;                      ///< px: width at the sides, height at the bottom
  const char* behind = nullptr;  ///< name of a dock whose tab it shares, or none
  int share = 1;                 ///< of the height among the docks of a side
};

struct WorkspaceInfo {
  const char* name;
  const char* help;
  std::vector<PlacedDock> wide = {};    ///< from kWideWindow pixels on
  std::vector<PlacedDock> narrow = {};  ///< below
  /// Docks of which a narrow window shows only one at a time.
  std::vector<const char*> drawers = {};
  /// Whether buttons below the canvas open the drawers; otherwise the side pane's button does, and
  /// the image has the full height.
  bool handles = false;
};

const WorkspaceInfo& workspaceInfo(Workspace workspace);
/// Translated name and help of a workspace.
QString workspaceTitle(Workspace workspace);
QString workspaceHelp(Workspace workspace);

/// The workspace of this name, ignoring letter case.
std::optional<Workspace> workspaceNamed(const QString& name);

/// The workspace that a panel belongs to, if there is exactly one.
std::optional<Workspace> homeOf(const QString& dock);

}  // namespace boresight::ui
