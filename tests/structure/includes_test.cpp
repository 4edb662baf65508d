// SPDX-License-Identifier: Apache-2.0
// The floors of the house, as the #include lines show them. The stages of core/ have a test of
// their own (tests/core/base/layering_test.cpp), as core/ is also built alone.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace boresight {
namespace {

namespace fs = std::filesystem;

/// Floors from the ground up: a folder may include itself and folders of lower floors, never one
/// of its own floor.
const std::vector<std::vector<std::string>> kFloors = {
    {"core"},
    {"sessions"},  // version.h
    {"sessions/text"},
    {"sessions/log"},
    {"sessions/io/files"},
    {"sessions/io/json"},
    {"sessions/io/cameras"},
    {"sessions/io/images", "sessions/io/meshes"},
    {"sessions/io/datasets"},
    {"sessions/decision", "sessions/trace"},
    {"sessions/run"},
    {"sessions/annotation", "sessions/baselines", "sessions/record"},
    {"sessions/evaluation"},
    {"sessions/session"},
    {"sessions/calibration", "sessions/checks"},
    {"sessions/review"},
    {"sessions/exchange", "sessions/report"},
    {"sessions/tables"},
    {"ui/style"},
    {"ui/manual", "ui/models", "ui/plots", "ui/state"},
    {"ui/run", "ui/widgets"},
    {"ui/views"},
    {"ui/panels/annotate", "ui/panels/case", "ui/panels/diagnose", "ui/panels/run"},
    {"ui/annotation", "ui/review"},
    {"ui/scene"},
    {"ui/workspaces"},
    {"ui/window"},
    {"app/flight"},
    {"app", "app/python"},
};

/// Floor of a folder; the number of floors when it is on none.
std::size_t floorOf(const std::string& folder) {
  const auto found = std::ranges::find_if(kFloors, [&](const std::vector<std::string>& floor) {
    return std::ranges::find(floor, folder) != floor.end();
  });
  return static_cast<std::size_t>(found - kFloors.begin());
}

/// "sessions/io/images" of "sessions/io/images/labels/image_label.h", "sessions/run" of
/// "sessions/run/runner.h", "core" of whatever is in core/.
std::string folderOf(const std::string& file) {
  if (file.starts_with("core/")) return "core";
  const bool rooms = file.starts_with("sessions/io/") || file.starts_with("ui/panels/");
  std::size_t end = file.find('/');
  for (int level = rooms ? 2 : 1; level > 0; --level) {
    const std::size_t next = file.find('/', end + 1);
    if (next == std::string::npos) break;
    end = next;
  }
  return file.substr(0, end);
}

/// "" when `file` may include `header`, else why not.
std::string fault(const std::string& file, const std::string& header) {
  const std::string folder = folderOf(file);
  if (floorOf(folder) == kFloors.size()) return "is on no floor";
  const bool qt = header.starts_with("Qt") || header.starts_with("qwt_");
  if (qt && !folder.starts_with("ui/") && !folder.starts_with("app")) return "includes " + header;
  const bool vtk = header.starts_with("vtk") || header.starts_with("QVTK");
  if (vtk && folder != "ui/scene") return "includes " + header + ", which only ui/scene may";
  static const std::set<std::string> house = {"core", "sessions", "ui", "app"};
  if (!house.contains(header.substr(0, header.find('/')))) return "";
  const std::string other = folderOf(header);
  if (floorOf(other) == kFloors.size()) return "includes " + header + ", which is on no floor";
  if (other == folder || floorOf(other) < floorOf(folder)) return "";
  return "includes " + header + " of its own floor or one above";
}

std::vector<std::string> headersOf(const fs::path& file) {
  static const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<std::string> headers;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (std::regex_search(line, match, pattern)) headers.push_back(match[1]);
  }
  return headers;
}

TEST(Floors, EveryIncludePointsDownwards) {
  const fs::path root = BORESIGHT_SOURCE_DIR;
  int headers = 0;
  for (const char* top : {"core", "sessions", "ui", "app"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      const std::string file = fs::relative(entry.path(), root).generic_string();
      for (const std::string& header : headersOf(entry.path())) {
        ++headers;
        EXPECT_EQ(fault(file, header), "") << file;
      }
    }
  }
  EXPECT_GT(headers, 1000) << "the sources were not found in " << root;
}

TEST(Floors, IncludesUpwardsAndSidewardsAreFaults) {
  EXPECT_NE(fault("core/base/math.h", "sessions/io/files/errors.h"), "");
  EXPECT_NE(fault("sessions/io/files/errors.h", "sessions/session/session.h"), "");
  EXPECT_NE(fault("sessions/io/images/labels/image_label.h", "sessions/run/runner.h"), "");
  EXPECT_NE(fault("sessions/io/json/json_reader.h", "sessions/io/cameras/pose_file.h"), "");
  EXPECT_NE(fault("ui/panels/run/pose_panel.cpp", "ui/panels/case/cases_panel.h"), "");
  EXPECT_NE(fault("sessions/record/onboard_record.h", "sessions/annotation/annotations.h"), "");
  EXPECT_NE(fault("sessions/review/queue.h", "ui/state/document.h"), "");
  EXPECT_NE(fault("sessions/review/queue.h", "QtCore/QString"), "");
  EXPECT_NE(fault("ui/panels/run/pose_panel.cpp", "vtkActor.h"), "");
  EXPECT_NE(fault("ui/review/queue_panel.cpp", "ui/annotation/loupe.h"), "");
  EXPECT_NE(fault("ui/unheard_of/x.h", "core/base/math.h"), "");
  EXPECT_EQ(fault("sessions/io/images/image_file.cpp", "sessions/io/images/labels/image_label.h"),
            "");
  EXPECT_EQ(fault("sessions/tables/table.h", "sessions/text/text_table.h"), "");
  EXPECT_EQ(fault("ui/scene/vtk_canvas.cpp", "vtkActor.h"), "");
  EXPECT_EQ(fault("app/run.cpp", "ui/window/application.h"), "");
}

}  // namespace
}  // namespace boresight
