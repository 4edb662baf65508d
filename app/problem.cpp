// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "app/commands.h"
#include "app/problem_inputs.h"
#include "core/localizer/problem_bytes.h"
#include "sessions/io/atomic_file.h"
#include "sessions/io/dataset_file.h"
#include "sessions/io/labels/image_label.h"

namespace boresight::app {
namespace {

struct ProblemArguments : InputArguments {
  std::string dataset, case_id;
  std::string out, image_out;

  void addTo(CLI::App& command);
};

void ProblemArguments::addTo(CLI::App& command) {
  InputArguments::addTo(command);
  addFile(command, "--dataset", dataset, "dataset.json with the case, instead of the files above");
  command.add_option("--case", case_id, "Which of its cases")->type_name("ID");
  for (const char* name : {"--image", "--camera", "--mesh", "--seed"})
    command.get_option(name)->required(false)->excludes("--dataset");
  for (const char* name : {"--mesh-unit", "--ignore", "--uncertainty", "--pivot", "--bit-depth"})
    command.get_option(name)->excludes("--dataset");
  command.get_option("--dataset")->needs("--case");
  command.get_option("--case")->needs("--dataset");
  addFile(command, "--out", out, "Writes the problem: everything but the pixels")->required();
  addFile(command, "--image-out", image_out, "Writes the 8-bit gray pixels as a binary PGM")
      ->required();
}

/// What evaluate runs for this case from its own seed.
ProblemInputs readCaseInputs(const ProblemArguments& arguments) {
  const sessions::Dataset dataset = sessions::readDataset(arguments.dataset);
  const sessions::Case* one = dataset.findCase(arguments.case_id);
  if (one == nullptr)
    throw sessions::InputError(dataset.file, "cases",
                               "there is no case \"" + arguments.case_id + "\"");
  if (!one->uncertainty)
    throw sessions::InputError(dataset.file, "cases." + one->id + ".uncertainty",
                               "neither the case nor its station states one");
  const sessions::Station& station = dataset.stations.at(one->station);
  ProblemInputs inputs;
  inputs.options = arguments.options.read();
  double& feature_size_m = inputs.options.templates.feature_size_m;
  if (arguments.feature_size_m > 0.0) feature_size_m = arguments.feature_size_m;
  if (feature_size_m == 0.0) feature_size_m = station.feature_size_m.value_or(0.0);
  inputs.camera = dataset.cameras.at(one->camera);
  inputs.image = sessions::readCaseImage(dataset, *one);
  inputs.ignore_mask = sessions::readCaseMask(dataset, *one);
  if (inputs.ignore_mask) inputs.ignore = inputs.ignore_mask->view();
  inputs.scene = sessions::readStationScene(station);
  inputs.seed.camera_from_station = one->seed_camera_from_station;
  inputs.uncertainty = *one->uncertainty;
  inputs.notes = dataset.notes;
  return inputs;
}

void requireFilesNamed(const ProblemArguments& arguments) {
  if (arguments.image.empty()) throw CLI::RequiredError("--image (or --dataset and --case)");
  if (arguments.camera.empty() && !sessions::hasImageLabel(arguments.image))
    throw CLI::RequiredError("--camera");
  if (arguments.mesh.mesh.empty()) throw CLI::RequiredError("--mesh");
  if (arguments.seed.empty()) throw CLI::RequiredError("--seed");
}

std::string pgmOf(const sessions::GrayImage& image) {
  std::string file =
      "P5\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n";
  file.append(reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size());
  return file;
}

int writeProblem(const ProblemArguments& arguments) {
  const bool from_dataset = !arguments.dataset.empty();
  if (!from_dataset) requireFilesNamed(arguments);
  const ProblemInputs inputs =
      from_dataset ? readCaseInputs(arguments) : readProblemInputs(arguments);
  for (const std::string& file : {arguments.out, arguments.image_out})
    sessions::requireWritable(file);
  requireSensibleSeed(inputs, from_dataset ? arguments.dataset : arguments.seed);
  for (const std::string& line : inputs.notes) note(line);
  const LocalizationProblem problem = inputs.problem();
  std::vector<std::uint8_t> bytes(encodeProblem(problem, inputs.options, {}));
  encodeProblem(problem, inputs.options, bytes);
  sessions::writeFileAtomically(arguments.image_out, pgmOf(inputs.image));
  sessions::writeFileAtomically(arguments.out, bytes);
  std::cout << bytes.size() << " bytes: " << problem.mesh.vertices_in_station_m.size()
            << " vertices, " << problem.mesh.faces.size() << " faces, image " << inputs.image.width
            << " x " << inputs.image.height << "\n";
  return kDone;
}

}  // namespace

void addProblem(CLI::App& app, int& exit_code) {
  const auto [command, arguments] =
      addCommand(app, exit_code, "problem",
                 "Writes one localization as the flight driver reads it: binary problem and pixels",
                 writeProblem);
  arguments->addTo(*command);
}

}  // namespace boresight::app
