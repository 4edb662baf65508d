// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/rig_file.h"

#include <set>

#include "sessions/annotation/marks_file.h"
#include "sessions/io/camera_file.h"
#include "sessions/io/json_document.h"
#include "sessions/io/pose_file.h"

namespace boresight::sessions {

namespace {

std::vector<MarkedView> readViews(const JsonReader& root) {
  std::vector<MarkedView> views;
  std::set<std::string> names;
  for (const JsonReader& json : root.at("views").elements()) {
    MarkedView view;
    view.name = json.at("name").nonEmptyText();
    if (!names.insert(view.name).second)
      json.failMember("name", "'" + view.name + "' is given twice");
    view.camera = readCamera(json.at("camera").path());
    view.camera_from_rig = readTransform(json.at("camera_from_rig"));
    view.marks = readMarks(json.at("points").path());
    views.push_back(view);
  }
  if (views.empty()) root.failMember("views", "there is none");
  return views;
}

}  // namespace

std::vector<MarkedView> readRig(const std::filesystem::path& file) {
  return JsonDocument(file).read("boresight-rig", 1, readViews);
}

}  // namespace boresight::sessions
