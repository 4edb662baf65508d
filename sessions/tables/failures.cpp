// SPDX-License-Identifier: Apache-2.0
#include "sessions/tables/result_figures.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <list>
#include <map>
#include <memory>
#include <utility>

#include "sessions/evaluation/pose_error.h"
#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/run_inputs.h"
#include "sessions/io/datasets/dataset_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/review/thumbnail.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

/// A part of the seed's error below which a pose counts as near.
constexpr double kNear = 0.1;

double distanceMm(const PoseError& error) { return std::hypot(error.normal_mm, error.lateral_mm); }
double angleDeg(const PoseError& error) { return error.geodesic_mrad / kMradPerDegree; }

std::string text(const PoseError& error) {
  return fixedText(distanceMm(error), 2) + " mm, " + fixedText(angleDeg(error), 2) + " deg";
}

/// What is left of the seed's error, the larger of distance and angle.
double partLeft(const PoseError& error, const PoseError& seed) {
  const auto part = [](double now, double before) { return now / std::max(before, 1e-9); };
  return std::max(part(distanceMm(error), distanceMm(seed)), part(angleDeg(error), angleDeg(seed)));
}

std::string agreement(const RunStep& step) {
  if (step.kind != "match") return "";
  return " (" + std::to_string(step.support) + " of " + std::to_string(step.matches) +
         " matches agree)";
}

/// "at the seed 31.20 mm, 4.12 deg; ..."
std::string wayText(const RunResult& run) {
  std::string way = "Off by " + text(*run.seed_error) + " at the seed";
  const RunStep* least = nearestStep(run);
  if (!run.steps.empty() && run.steps.front().error)
    way += "; " + text(*run.steps.front().error) + " after the first iteration" +
           agreement(run.steps.front());
  if (least != nullptr && least != &run.steps.front() &&
      partLeft(*least->error, *run.seed_error) < 1.0)
    way +=
        "; nearest " + text(*least->error) + " after iteration " + std::to_string(least->index + 1);
  if (run.completed && run.error) way += "; " + text(*run.error) + " at the end";
  return way + ".";
}

std::string endText(const RunResult& run) {
  if (!run.message.empty()) return run.status + ": " + run.message;
  if (run.completed && run.error && run.requirement)
    return run.status + ", " + fixedText(requirementShare(*run.error, *run.requirement), 1) +
           " times beyond what is required";
  return run.status;
}

std::string verdictText(Astray astray) {
  constexpr const char* kTexts[] = {
      // by Astray
      "",
      "",
      "No iteration was nearer to the truth than the seed: the matches moved the pose away.",
      "Some iteration was nearer to the truth, but none was near.",
      "It was near the truth, but did not end there or was rejected there.",
      ""};
  return kTexts[static_cast<std::size_t>(astray)];
}

/// Of a method that was deliberately given another mesh.
std::string meshNote(const MethodFacts& method) {
  if (!method.mesh_of.empty()) return "WRONG mesh of " + method.mesh_of;
  return method.mirror.empty() ? "" : "WRONG mesh mirrored across " + method.mirror;
}

std::vector<Failure> failuresOfFile(const std::filesystem::path& file,
                                    const ResultsFilter& filter) {
  const ResultsFacts facts = readResultsFacts(file);
  std::map<std::string, std::string> notes;
  std::map<std::string, std::string> stations;
  for (const MethodFacts& method : facts.methods) {
    notes[method.method] = meshNote(method);
    stations[method.method] = method.mesh_of;
  }
  std::vector<Failure> failures;
  forEachRun(file, [&](const RunResult& run) {
    const bool failed = !run.completed || run.success == false || run.false_positive;
    if (failed && filter.takes(run))
      failures.push_back(
          {run, facts.dataset.dataset, notes[run.method], stations[run.method], file});
  });
  std::vector<RunResult*> runs;
  for (Failure& failure : failures) runs.push_back(&failure.run);
  readSteps(file, runs);
  return failures;
}

constexpr double kMargin = 24.0;
constexpr double kGap = 12.0;
constexpr double kTitleHeight = 30.0;
constexpr double kNameHeight = 13.0;
constexpr double kStoryHeight = 76.0;
constexpr int kColumns = 2;
constexpr int kRows = 3;
constexpr std::size_t kPerPage = kColumns * kRows;
constexpr double kPixelsPerPoint = 2.5;

/// Datasets and scenes that several failures share, read once.
struct Inputs {
  std::map<std::filesystem::path, Dataset> datasets;
  /// By placed parts; a list, whose elements stay in place.
  std::list<std::pair<std::vector<PartSource>, SceneMesh>> scenes;
  std::map<std::pair<std::filesystem::path, std::string>, RunInputs> hashes;  ///< by mesh, too

  const Dataset& datasetOf(const std::filesystem::path& file) {
    const auto known = datasets.find(file);
    return known != datasets.end() ? known->second
                                   : datasets.emplace(file, readDataset(file)).first->second;
  }

  /// InputError when the inputs of the run have changed since.
  void requireUnchanged(const Failure& failure, const Dataset& dataset, const Case& dataset_case) {
    RunInputs& inputs =
        hashes.try_emplace(std::pair(failure.dataset, failure.mesh_of), dataset, failure.mesh_of)
            .first->second;
    inputs.requireUnchanged(dataset_case, failure.run.inputs_sha256, failure.results);
  }

  const SceneMesh& sceneOf(const Dataset& dataset, const Case& dataset_case) {
    const FrameTree frames = framesOf(dataset, dataset_case);
    std::vector<PartSource> parts;
    for (const PartSource& part : partsOf(dataset, dataset_case))
      if (part.state.used()) parts.push_back(placedPart(part, frames));
    for (const auto& [known, scene] : scenes)
      if (known == parts) return scene;
    return scenes.emplace_back(parts, readScene(parts)).second;
  }
};

/// The pose to draw: of a completed run its final pose. Of a failed run, whose final pose is the
/// seed, its iteration nearest to the truth; its first one when none came nearer than the seed; its
/// last one without truth.
OverlayLayer reached(const RunResult& run) {
  if (run.completed) return {"end", run.camera_from_station, kResultColor, true};
  const auto layer = [](const char* name, const RunStep& step) {
    return OverlayLayer{name, step.camera_from_station, kResultColor, true};
  };
  const RunStep* nearest = nearestStep(run);
  if (nearest == nullptr) return layer("last", run.steps.back());
  if (whereAstray(run) == Astray::kLedAway) return layer("first", run.steps.front());
  return layer("nearest", *nearest);
}

/// InputError when an input cannot be read.
ColorImage pictureOf(const Failure& failure, Inputs& inputs, int width_px, int height_px) {
  if (std::filesystem::is_directory(failure.dataset))
    throw InputError(failure.dataset, "it is a folder: pictures are made of a dataset.json only");
  const Dataset& dataset = inputs.datasetOf(failure.dataset);
  const Case* dataset_case = dataset.findCase(failure.run.case_id);
  if (dataset_case == nullptr)
    throw InputError(failure.dataset, "it has no case " + failure.run.case_id);
  inputs.requireUnchanged(failure, dataset, *dataset_case);
  const GrayImage image = readCaseImage(dataset, *dataset_case);
  const SceneMesh& scene = inputs.sceneOf(dataset, *dataset_case);
  std::vector<Pose> framed = {failure.run.camera_from_station_seed};
  std::vector<OverlayLayer> layers = {
      {"seed", failure.run.camera_from_station_seed, kSeedColor, true}};
  if (dataset_case->truth_camera_from_station) {
    framed.push_back(*dataset_case->truth_camera_from_station);
    layers.push_back({"truth", *dataset_case->truth_camera_from_station, kTruthColor, false});
  }
  if (!failure.run.steps.empty())  // over the truth, which shows on both sides of it
    layers.push_back(reached(failure.run));
  return stationPicture(image.view(), dataset.cameraOf(*dataset_case), scene.view(), framed, layers,
                        width_px, height_px);
}

std::string nameOf(const Failure& failure) {
  const RunResult& run = failure.run;
  std::string name = run.case_id;
  if (run.reseed > 0) name += ", seed " + std::to_string(run.reseed);
  name += ": " + run.method;
  if (!failure.mesh_note.empty()) name += ", " + failure.mesh_note;
  if (run.false_positive) name += run.gross_false_positive ? ", GROSS FALSE POSITIVE" : ", FALSE";
  return name;
}

constexpr double kCellWidth =
    (PdfCanvas::kWidth - 2.0 * kMargin - (kColumns - 1) * kGap) / kColumns;
constexpr double kCellHeight =
    (PdfCanvas::kHeight - 2.0 * kMargin - kTitleHeight - (kRows - 1) * kGap) / kRows;

PdfBox cellOf(std::size_t place) {
  const auto column = static_cast<double>(place % kColumns);
  const auto row = static_cast<double>(place / kColumns);
  return {kMargin + column * (kCellWidth + kGap),
          kMargin + kTitleHeight + row * (kCellHeight + kGap), kCellWidth, kCellHeight};
}

/// A picture ends below its last row; a page of a PDF is a whole one.
double heightOf(CanvasFormat format, std::size_t cells) {
  if (format == CanvasFormat::kPdf) return PdfCanvas::kHeight;
  const std::size_t rows = (std::min(cells, kPerPage) + kColumns - 1) / kColumns;
  return kMargin + kTitleHeight + static_cast<double>(rows) * (kCellHeight + kGap) + kMargin - kGap;
}

void drawCell(PdfCanvas& canvas, const PdfBox& cell, const Failure& failure, Inputs& inputs) {
  canvas.text(cell.x, cell.y, cell.width, nameOf(failure), {8.5, true, false, kInk, 1});
  const PdfBox place = {cell.x, cell.y + kNameHeight, cell.width,
                        cell.height - kNameHeight - kStoryHeight};
  try {
    canvas.picture(place,
                   pictureOf(failure, inputs, static_cast<int>(place.width * kPixelsPerPoint),
                             static_cast<int>(place.height * kPixelsPerPoint)));
  } catch (const InputError& error) {
    canvas.frame(place, kPaperGrid);
    canvas.text(place.x + 4.0, place.y + 4.0, place.width - 8.0, error.what(),
                {7.5, false, false, kFaintInk, 6});
  }
  canvas.text(cell.x, place.bottom() + 2.0, cell.width, failureStory(failure.run),
              {7.0, false, false, kInk, 7});
}

void drawTitle(PdfCanvas& canvas, std::size_t page, std::size_t pages, std::size_t count) {
  canvas.text(kMargin, kMargin, PdfCanvas::kWidth - 2.0 * kMargin,
              std::to_string(count) + (count == 1 ? " run" : " runs") +
                  " that did not succeed (page " + std::to_string(page + 1) + " of " +
                  std::to_string(pages) + ")",
              {11.0, true, false, kInk, 1});
  canvas.text(kMargin, kMargin + 14.0, PdfCanvas::kWidth - 2.0 * kMargin,
              "Edges: seed orange, truth white, where the run ended blue (or its nearest, first or "
              "last iteration).",
              {7.5, false, false, kFaintInk, 1});
}

}  // namespace

const RunStep* nearestStep(const RunResult& run) {
  const RunStep* best = nullptr;
  for (const RunStep& step : run.steps) {
    if (!step.error || !run.seed_error) continue;
    if (best == nullptr ||
        partLeft(*step.error, *run.seed_error) < partLeft(*best->error, *run.seed_error))
      best = &step;
  }
  return best;
}

Astray whereAstray(const RunResult& run) {
  if (run.inputFailed() || run.status == "bad_seed") return Astray::kNotBegun;
  if (run.completed) return run.success ? Astray::kBeyondNeed : Astray::kNoTruth;
  const RunStep* least = nearestStep(run);
  if (least == nullptr) return Astray::kNoTruth;
  const double left = partLeft(*least->error, *run.seed_error);
  if (left < kNear) return Astray::kCameNear;
  return left < 1.0 ? Astray::kPartOfWay : Astray::kLedAway;
}

std::string failureStory(const RunResult& run) {
  std::string story = endText(run);
  if (!story.empty() && !story.ends_with('.')) story += '.';
  if (run.seed_error && !run.steps.empty()) story += " " + wayText(run);
  if (const std::string verdict = verdictText(whereAstray(run)); !verdict.empty())
    story += " " + verdict;
  return story;
}

std::vector<Failure> failuresOf(const std::vector<std::filesystem::path>& files,
                                const ResultsFilter& filter) {
  std::vector<Failure> failures;
  for (const std::filesystem::path& file : files) {
    std::vector<Failure> found = failuresOfFile(file, filter);
    std::move(found.begin(), found.end(), std::back_inserter(failures));
  }
  return failures;
}

std::vector<Figure> failureSheets(std::span<const Failure> failures, CanvasFormat format,
                                  const std::stop_token& stop) {
  if (failures.empty()) return {};
  const std::size_t pages = (failures.size() + kPerPage - 1) / kPerPage;
  const bool in_one = format == CanvasFormat::kPdf;
  Inputs inputs;
  std::vector<Figure> made;
  std::unique_ptr<PdfCanvas> canvas;
  for (std::size_t page = 0; page < pages && !stop.stop_requested(); ++page) {
    const auto on_page = failures.subspan(page * kPerPage);
    if (canvas && in_one)
      canvas->nextPage();
    else
      canvas = std::make_unique<PdfCanvas>("Runs that did not succeed", format, PdfCanvas::kWidth,
                                           heightOf(format, on_page.size()));
    drawTitle(*canvas, page, pages, failures.size());
    for (std::size_t i = 0; i < std::min(kPerPage, on_page.size()); ++i)
      drawCell(*canvas, cellOf(i), on_page[i], inputs);
    if (in_one) continue;
    const std::string name = std::string(kFailureFigure) + "_" + std::to_string(page + 1);
    made.push_back({name, canvas->finish()});
  }
  if (in_one && canvas) made.push_back({kFailureFigure, canvas->finish()});
  return made;
}

}  // namespace boresight::sessions
