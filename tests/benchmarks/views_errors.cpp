// SPDX-License-Identifier: Apache-2.0
// What several views bring: every rig of a dataset by each view alone, by all together, and with
// one view black, half covered or over-exposed. Prints errors at the views' own cameras (figures of
// resources/evidence/accuracy.md and robustness.md), after each rig.
//
//   views_errors DATASET [N]   views are spoiled in every Nth rig only; 0: in none
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "sessions/evaluation/pose_error.h"
#include "sessions/run/runner.h"
#include "sessions/session/session_maker.h"
#include "sessions/session/views_run.h"
#include "tests/benchmarks/check_cases.h"

namespace boresight::test {
namespace {

using sessions::LoadedCase;

/// The views of one rig; copies of a case may be spoiled.
using Rig = std::vector<std::shared_ptr<LoadedCase>>;

struct RigRun {
  ViewsResult result;
  double seconds = 0.0;
};

RigRun localizeViews(const Rig& rig) {
  sessions::LoadedViews loaded;
  for (const auto& item : rig) {
    View& view = loaded.views.emplace_back();
    view.image = item->image.view();
    view.ignore = item->ignore ? &item->ignore_bits : nullptr;
    view.camera = item->source.camera;
    view.mesh = item->scene.view();
    view.camera_from_rig = item->source.rig->camera_from_rig;
    loaded.cases.push_back(item);
  }
  LocalizerOptions options = defaultProfile();
  options.templates.feature_size_m = rig.front()->source.feature_size_m.value_or(0.0);
  sessions::Runner run(loaded.problem(), options, loaded.ids(),
                       {.level = sessions::RecordLevel::kSummary});
  run.advance(sessions::StepUntil::kEnd);
  const ViewsResult& result = run.joint().result;
  if (result.status == LocalizationStatus::kFault)
    throw std::runtime_error(rig.front()->source.id + ": " + statusText(result.fault));
  return {result, run.trace().seconds.total()};
}

struct Row {
  int runs = 0, converged = 0, beyond = 0, spoiled_took_part = 0;
  std::vector<double> normal_mm, lateral_mm, rotation_mrad;
  double seconds = 0.0;
};

void noteRun(const Rig& rig, const RigRun& run, Row& row) {
  ++row.runs;
  row.seconds += run.seconds;
  if (run.result.status != LocalizationStatus::kConverged) return;
  ++row.converged;
  bool within = true;
  for (std::size_t v = 0; v < rig.size(); ++v) {
    const sessions::SessionCase& session_case = rig[v]->source;
    const sessions::PoseError error = sessions::poseError(
        session_case.camera_from_station_truth.value(), run.result.views[v].camera_from_station,
        session_case.camera_from_end_effector);
    row.normal_mm.push_back(error.normal_mm);
    row.lateral_mm.push_back(error.lateral_mm);
    row.rotation_mrad.push_back(error.rotation_mrad);
    within = within && (!session_case.requirement ||
                        sessions::meetsRequirement(error, *session_case.requirement));
  }
  if (!within) ++row.beyond;
}

struct Spoiling {
  const char* name;
  int (*spoiled)(int gray, bool left);  ///< a pixel of the left or the right half
};

constexpr Spoiling kSpoilings[] = {
    {"2 black", [](int, bool) { return 0; }},
    {"3 half covered", [](int gray, bool left) { return left ? 0 : gray; }},
    {"4 over-exposed", [](int gray, bool) { return std::min(255, 6 * gray); }}};

void spoil(sessions::GrayImage& image, const Spoiling& how) {
  const auto width = static_cast<std::size_t>(image.width);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] =
        static_cast<std::uint8_t>(how.spoiled(image.pixels[i], i % width < width / 2));
}

void runWhole(const Rig& rig, std::map<std::string, Row>& rows) {
  for (const auto& view : rig) noteRun({view}, localizeViews({view}), rows["0 each view alone"]);
  noteRun(rig, localizeViews(rig), rows["1 together"]);
}

void runSpoiled(const Rig& rig, std::map<std::string, Row>& rows) {
  for (const Spoiling& how : kSpoilings) {
    for (std::size_t v = 0; v < rig.size(); ++v) {
      Rig spoiled = rig;
      spoiled[v] = copyOf(*rig[v]);
      spoil(spoiled[v]->image, how);
      const std::string text = how.name;
      noteRun({spoiled[v]}, localizeViews({spoiled[v]}), rows[text + ", alone"]);
      const RigRun run = localizeViews(spoiled);
      Row& row = rows[text + (v == 0 ? ", first of the pair" : ", second of the pair")];
      noteRun(spoiled, run, row);
      row.spoiled_took_part += run.result.views[v].tookPart() ? 1 : 0;
    }
  }
}

std::string statisticsText(const std::vector<double>& values) {
  const sessions::Statistics statistics = sessions::statistics(values);
  char text[64];
  std::snprintf(text, sizeof(text), "%.3f / %.3f / %.3f", statistics.mean, statistics.deviation,
                statistics.maximum);
  return text;
}

void print(const std::map<std::string, Row>& rows) {
  std::cout
      << "| images | runs | converged | beyond | spoiled view took part | normal mm | lateral mm "
         "| rotation mrad | s |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [name, row] : rows)
    std::cout << "| " << name.substr(2) << " | " << row.runs << " | " << row.converged << " | "
              << row.beyond << " | " << row.spoiled_took_part << " | "
              << statisticsText(row.normal_mm) << " | " << statisticsText(row.lateral_mm) << " | "
              << statisticsText(row.rotation_mrad) << " | " << row.seconds / row.runs << " |\n";
  std::cout << std::endl;
}

int run(const std::string& file, int every) {
  const sessions::Dataset dataset = sessions::readDataset(file);
  std::map<std::string, std::vector<std::string>> cases;
  for (const sessions::Case& dataset_case : dataset.cases)
    if (dataset_case.rig) cases[dataset_case.rig->id].push_back(dataset_case.id);
  std::map<std::string, Row> rows;
  int index = 0;
  for (const auto& [id, case_ids] : cases) {
    Rig rig;
    for (const auto& session_case : sessions::makeSession(dataset, case_ids).cases)
      rig.push_back(copyOf(*sessions::loadCase(*session_case)));
    runWhole(rig, rows);
    if (every > 0 && index++ % every == 0) runSpoiled(rig, rows);
    std::cout << "up to " << id << "\n\n";
    print(rows);
  }
  return 0;
}

}  // namespace
}  // namespace boresight::test

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::cerr << "usage: views_errors DATASET [N]\n";
    return 2;
  }
  try {
    return boresight::test::run(argv[1], argc > 2 ? std::atoi(argv[2]) : 1);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 3;
  }
}
