// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "app/case_arguments.h"
#include "sessions/io/cameras/camera_field.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/config_file.h"
#include "sessions/record/onboard_record.h"
#include "sessions/session/case_run.h"
#include "sessions/session/input_check.h"
#include "sessions/session/input_sheet.h"
#include "sessions/session/session_of_results.h"

namespace boresight::app {
namespace {

struct NewArguments : CaseArguments {
  DatasetArguments dataset;
  std::string results;
  std::vector<std::string> cases;
  std::string id, record, out;
  std::optional<double> mesh_scale_sigma;

  void addTo(CLI::App& command) {
    CLI::Option* from_dataset =
        addFile(command, "--dataset", dataset.path,
                "dataset.json or folder of a BOP dataset with the session's cases");
    addOption(command, "--case", "ID", cases, "Only this case of the dataset; may be repeated")
        ->needs(from_dataset);
    addFile(
        command, "--results", results,
        "Results of `whs evaluate`: each run becomes a case with its seed and options, the worst "
        "first")
        ->excludes(from_dataset);
    CaseArguments::addTo(command);
    addTruthTo(command);
    addEndEffectorTo(command);
    addRequirementTo(command);
    addSymmetryTo(command);
    command.add_option("--id", id, "Name of the case (default: the image's)");
    addOption(command, "--mesh-scale-sigma", "S", mesh_scale_sigma,
              "One sigma of the mesh's scale, relative (default: 0.0002)")
        ->check(numberIn(0.0, sessions::kMaxScaleSigma));
    CLI::Option* from_image = command.get_option("--image")->excludes(from_dataset);
    for (const char* name :
         {"--camera", "--frames", "--mesh", "--mesh-unit", "--seed", "--truth", "--ignore", "--id",
          "--bit-depth", "--levels", "--bayer", "--feature-size", "--mesh-scale-sigma",
          "--end-effector", "--requirement", "--symmetry"})
      command.get_option(name)->needs(from_image);
    addFile(command, "--record", record, "Onboard record (run.whsr) of the session's one case");
    dataset.addTo(command);
    command.get_option("--part")->needs(from_dataset);
    addFile(command, "--out", out, "Session file to create, e.g. sol12.boresight.json")->required();
  }
};

/// Notes on the files; refuses inputs that an edit of the session cannot correct: an image of
/// another size than the camera's, a camera that folds. A seed can be moved later.
void requireUsable(const sessions::SessionCase& session_case) {
  const auto loaded = sessions::loadCase(session_case);
  for (const std::string& text : sessions::fileNotes(*loaded)) note(text);
  sessions::requireSameSize(loaded->image, session_case.camera);
  sessions::requireField("case " + session_case.id, "camera", session_case.camera);
  if (!session_case.has_seed) {
    note("case " + session_case.id +
         " has no seed: annotate it in the desktop program, and use the solved pose as its seed");
    return;
  }
  try {
    sessions::requireRunnable(*loaded);
  } catch (const sessions::InputError& refusal) {
    note(std::string("a run cannot start from this seed: ") + refusal.what() +
         "; move the seed in the desktop program, or create the session with another seed");
  }
}

sessions::Session sessionOf(const NewArguments& arguments) {
  if (!arguments.results.empty()) return sessions::sessionOfResults(arguments.results);
  if (!arguments.dataset.path.empty())
    return sessions::makeSession(arguments.dataset.open(), arguments.cases);
  for (const auto& [name, value] :
       {std::pair("--image", &arguments.image), std::pair("--mesh", &arguments.mesh)})
    if (value->empty()) throw CLI::ValidationError(name, "is needed where there is no --dataset");
  sessions::CaseFiles case_files = arguments.files();
  case_files.id = arguments.id;
  case_files.mesh_scale_sigma = arguments.mesh_scale_sigma;
  const sessions::MadeCase new_case = sessions::makeCase(case_files);
  for (const std::string& text : new_case.notes) note(text);
  requireUsable(new_case.made);
  return withCase({}, new_case.made);
}

/// The session with the record attached to its case.
sessions::Session withRecord(const sessions::Session& session, const std::string& file) {
  if (session.cases.size() != 1)
    throw CLI::ValidationError("--record", "belongs to one case; choose it with --case");
  (void)sessions::readRecord(file);  // that it is one
  sessions::SessionCase session_case = *session.cases.front();
  session_case.onboard_record = sessions::InputFile{
      std::filesystem::absolute(file).lexically_normal(), sessions::inputSha256(file)};
  return withCase(session, std::move(session_case));
}

int makeNew(const NewArguments& arguments) {
  sessions::Session session = sessionOf(arguments);
  if (!arguments.record.empty()) session = withRecord(session, arguments.record);
  for (const auto& session_case : session.cases)
    for (const std::string& warning : sessions::labelWarnings(*session_case))
      note("case " + session_case->id + ": " + warning);
  if (arguments.results.empty()) {
    arguments.options.noteUnlimited();
    const std::string name = arguments.options.profileName();
    session = withOptions(session, sessions::profileOptions(name) ? name : "default",
                          arguments.options.read());
  }
  const auto document = sessions::SessionDocument::create(arguments.out, session);
  print(document.file().string() + ": " + std::to_string(session.cases.size()) +
        (session.cases.size() == 1 ? " case" : " cases"));
  return kDone;
}

}  // namespace

void addNew(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "new",
             "Creates a session from a dataset or from the files of one case", makeNew);
}

}  // namespace boresight::app
