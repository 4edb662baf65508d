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
#include <string>
#include <vector>

#include "sessions/evaluation/rig_views.h"

namespace boresight::test {
namespace {

using sessions::RigRun;
using sessions::RigViews;

struct Row {
  int runs = 0, converged = 0, beyond = 0, spoiled_took_part = 0;
  std::vector<double> normal_mm, lateral_mm, rotation_mrad;
  double seconds = 0.0;
};

void noteRun(const RigViews& rig, const RigRun& run, Row& row) {
  ++row.runs;
  row.seconds += run.seconds;
  if (run.result.status != LocalizationStatus::kConverged) return;
  ++row.converged;
  bool within = true;
  for (std::size_t v = 0; v < run.views; ++v) {
    const sessions::PoseError error = sessions::viewError(rig, run, v).value();
    row.normal_mm.push_back(error.normal_mm);
    row.lateral_mm.push_back(error.lateral_mm);
    row.rotation_mrad.push_back(error.rotation_mrad);
    within = within && (!rig.cases[v]->requirement ||
                        sessions::meetsRequirement(error, *rig.cases[v]->requirement));
  }
  if (!within) ++row.beyond;
}

RigViews alone(const RigViews& rig, std::size_t view) {
  RigViews one = rig;
  one.cases = {rig.cases[view]};
  one.cameras = {rig.cameras[view]};
  one.images = {rig.images[view]};
  one.masks = {rig.masks[view]};
  return one;
}

enum class Spoil { kBlack, kHalf, kSaturated };

void spoil(sessions::GrayImage& image, Spoil how) {
  const auto width = static_cast<std::size_t>(image.width);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    std::uint8_t& gray = image.pixels[i];
    if (how == Spoil::kBlack) gray = 0;
    if (how == Spoil::kHalf && i % width < width / 2) gray = 0;
    if (how == Spoil::kSaturated)
      gray = static_cast<std::uint8_t>(std::min(255, 6 * static_cast<int>(gray)));
  }
}

void runWhole(const RigViews& rig, std::map<std::string, Row>& rows) {
  const LocalizerOptions options = defaultProfile();
  for (std::size_t v = 0; v < rig.cases.size(); ++v) {
    const RigViews one = alone(rig, v);
    noteRun(one, sessions::localizeViews(one, options), rows["0 each view alone"]);
  }
  noteRun(rig, sessions::localizeViews(rig, options), rows["1 together"]);
}

void runSpoiled(const RigViews& rig, std::map<std::string, Row>& rows) {
  const LocalizerOptions options = defaultProfile();
  const char* const names[] = {"black", "half covered", "over-exposed"};
  for (int how = 0; how < 3; ++how) {
    for (std::size_t v = 0; v < rig.cases.size(); ++v) {
      RigViews spoiled = rig;
      spoil(spoiled.images[v], static_cast<Spoil>(how));
      const std::string text = std::to_string(2 + how) + " " + names[how];
      const RigViews one = alone(spoiled, v);
      noteRun(one, sessions::localizeViews(one, options), rows[text + ", alone"]);
      const RigRun run = sessions::localizeViews(spoiled, options);
      Row& row = rows[text + (v == 0 ? ", first of the pair" : ", second of the pair")];
      noteRun(spoiled, run, row);
      row.spoiled_took_part += run.result.views[v].tookPart() ? 1 : 0;
    }
  }
}

std::string statisticsText(const std::vector<double>& values) {
  const sessions::Statistics made = sessions::statistics(values);
  char text[64];
  std::snprintf(text, sizeof(text), "%.3f / %.3f / %.3f", made.mean, made.deviation, made.maximum);
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
  std::map<std::string, Row> rows;
  int index = 0;
  for (const std::string& id : sessions::rigIds(dataset)) {
    const RigViews rig = sessions::readRigViews(dataset, id);
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
