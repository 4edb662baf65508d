// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "app/case_arguments.h"
#include "core/record/problem_bytes.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/session/input_sheet.h"

namespace boresight::app {
namespace {

struct ProblemArguments : CaseArguments {
  std::string dataset, case_id, out, image_out;

  void addTo(CLI::App& command) {
    CaseArguments::addTo(command);
    addUncertaintyTo(command);
    addEndEffectorTo(command);
    addFile(command, "--dataset", dataset, "dataset.json with the case (replaces the files above)");
    addOption(command, "--case", "ID", case_id, "Case of the dataset");
    for (const char* name :
         {"--image", "--camera", "--mesh", "--seed", "--mesh-unit", "--ignore", "--uncertainty",
          "--pivot", "--bit-depth", "--levels", "--bayer", "--end-effector"})
      command.get_option(name)->excludes("--dataset");
    command.get_option("--dataset")->needs("--case");
    command.get_option("--case")->needs("--dataset");
    addFile(command, "--out", out, "Problem file: all inputs except the pixels")->required();
    addFile(command, "--image-out", image_out, "Image file: the 8-bit gray pixels as a binary PGM")
        ->required();
  }
};

/// The case as evaluate runs it from its own seed.
ReadCase readCaseOfDataset(const ProblemArguments& arguments) {
  const sessions::Dataset dataset = sessions::readDataset(arguments.dataset);
  const sessions::Session session = sessions::makeSession(dataset, {arguments.case_id});
  ReadCase read{sessions::loadCase(*session.cases.front()), dataset.notes};
  for (std::string& text : sessions::fileNotes(*read.loaded)) read.notes.push_back(std::move(text));
  return read;
}

void requireFilesNamed(const ProblemArguments& arguments) {
  if (arguments.image.empty()) throw CLI::RequiredError("--image (or --dataset and --case)");
  if (arguments.camera.empty() && !sessions::hasImageLabel(arguments.image))
    throw CLI::RequiredError("--camera");
  if (arguments.mesh.empty()) throw CLI::RequiredError("--mesh");
  arguments.requireSeed();
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
  const ReadCase input = from_dataset ? readCaseOfDataset(arguments) : readCase(arguments);
  const sessions::LoadedCase& loaded = *input.loaded;
  requireWritable({arguments.out, arguments.image_out});
  if (from_dataset)
    requireRunnable(loaded, arguments.dataset, arguments.dataset);
  else
    requireRunnable(loaded, arguments.cameraFile(), arguments.seedFile());
  for (const std::string& line : input.notes) note(line);
  const LocalizationProblem problem = loaded.problem();
  const LocalizerOptions options = arguments.optionsOf(loaded.source);
  std::vector<std::uint8_t> bytes(encodeProblem(problem, options, {}));
  encodeProblem(problem, options, bytes);
  sessions::writeFileAtomically(arguments.image_out, pgmOf(loaded.image));
  sessions::writeFileAtomically(arguments.out, bytes);
  std::cout << bytes.size() << " bytes: " << problem.mesh.vertices_in_station_m.size()
            << " vertices, " << problem.mesh.faces.size() << " faces, image " << loaded.image.width
            << " x " << loaded.image.height << "\n";
  return kDone;
}

}  // namespace

void addProblem(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "problem",
             "Writes one localization for the flight driver: binary problem and pixels",
             writeProblem);
}

}  // namespace boresight::app
