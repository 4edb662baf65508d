// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <QString>
#include <Qt>

namespace boresight::ui {

/// The tasks that the window is arranged for, in the order of their tabs and keys (Ctrl+1 to 6).
enum class Workspace { kStart, kRun, kDiagnose, kAnnotate, kReview, kOnboard };
inline constexpr int kWorkspaceCount = 6;

/// A dock of a workspace as it is at first.
struct PlacedDock {
  const char* dock;  ///< object name
  Qt::DockWidgetArea area;
  int size;                       ///< px: width at the sides, height at the bottom
  const char* behind = nullptr;   ///< name of a dock whose tab it shares, or none
  int share = 1;                  ///< of the height among the docks of a side
};

struct WorkspaceInfo {
  const char* name;
  const char* help;
  bool has_canvas;
  std::vector<PlacedDock> wide;    ///< from kWideWindow pixels on
  std::vector<PlacedDock> narrow;  ///< below
  /// Docks of which a narrow window shows one at a time.
  std::vector<const char*> drawers;
  /// Whether buttons below the canvas open them there; else the side pane's button does, and the
  /// image has all the height.
  bool handles = false;
};

const WorkspaceInfo& workspaceInfo(Workspace workspace);

/// By its name, whatever the case of its letters.
std::optional<Workspace> workspaceNamed(const QString& name);

/// The workspace whose task a panel belongs to, where there is just one.
std::optional<Workspace> homeOf(const QString& dock);

}  // namespace boresight::ui
