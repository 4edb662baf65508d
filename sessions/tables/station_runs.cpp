// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/station_runs.h"

#include <map>
#include <utility>

namespace boresight::sessions {

const std::array<ErrorAxis, 3> kErrorAxes = {{
    {"normal error, mm", &PoseError::normal_mm,
     [](const Requirement& required) { return required.normal_mm; }, true},
    {"lateral error, mm", &PoseError::lateral_mm,
     [](const Requirement& required) { return required.lateral_mm; }, false},
    {"rotation error, mrad", &PoseError::rotation_mrad, &rotationLimit_mrad, false},
}};

std::vector<StationRuns> stationRuns(std::span<const RunResult> runs) {
  std::map<std::pair<std::string, bool>, StationRuns> stations;
  for (RunGroup& group : runGroups(runs)) {
    StationRuns& station = stations[{group.station, group.far}];
    station.title = group.station + (group.far ? ", far" : "");
    station.all.insert(station.all.end(), group.runs.begin(), group.runs.end());
    station.methods.push_back(std::move(group));
  }
  std::vector<StationRuns> listed;
  for (auto& [key, station] : stations) listed.push_back(std::move(station));
  return listed;
}

std::optional<double> sharedLimit(std::span<const RunResult* const> runs, RequirementLimit limit) {
  std::optional<double> shared;
  for (const RunResult* run : runs) {
    const std::optional<double> value = run->requirement ? limit(*run->requirement) : std::nullopt;
    if (!value || (shared && *shared != *value)) return std::nullopt;
    shared = value;
  }
  return shared;
}

}  // namespace boresight::sessions
