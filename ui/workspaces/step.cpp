// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/step.h"

#include <iterator>

#include <QCoreApplication>

namespace boresight::ui {
namespace {

struct StepEntry {
  const char* text;
  const char* help;
  Icon icon;
};

/// In the order of `Step`.
constexpr StepEntry kSteps[] = {
    {"", "", Icon::kNone},
    {"Choose files...", "Add the files that are still needed", Icon::kFolder},
    {"Fix files...", "Search missing files below the session's folder, or accept changed ones",
     Icon::kFolder},
    {"Change file...", "Replace the file by another one", Icon::kFolder},
    {"Run", "Run the case to its end", Icon::kRun},
    {"Stop", "Stop; the run can be continued", Icon::kStop},
    {"Go on", "Continue the run to its end", Icon::kRun},
    {"Run again", "Run the case with the current inputs and options", Icon::kRun},
    {"Run the rest", "Run the cases that have no run with their current inputs and options",
     Icon::kRun},
    {"Show", "List the cases, the worst first", Icon::kFilter},
    {"Review", "Check the pose, then validate or reject it", Icon::kShield},
    {"Try a wider search",
     "Allow the seed to be turned by up to 180 deg about the view axis, and run again",
     Icon::kSearch},
    {"Nudge seed", "Move and turn the seed over the image until its edges fit", Icon::kMove},
    {"Mask...", "Mark pixels outside the station, to ignore them", Icon::kMask},
    {"State uncertainty...", "State how far the seed may be off, and run again", Icon::kTarget},
    {"Annotate", "Mark four or more points in the image and on the station; they give a pose",
     Icon::kPencil},
    {"Annotate from this pose",
     "Mark five points; the edges of the doubtful pose show where the station may be",
     Icon::kPencil},
    {"Inspect", "Look at single matches and their score maps", Icon::kSearch},
    {"Competing poses", "Show the other poses next to the result", Icon::kCube},
    {"Inputs", "Show the inputs' properties and warnings", Icon::kInfo},
    {"Use as seed", "The pose of the annotations becomes the seed, with 3 sigma as its uncertainty",
     Icon::kTarget},
    {"Switch off", "Solve without this annotation; it is kept", Icon::kCross},
    {"Robust", "Solve again; annotations that fit badly count little or nothing", Icon::kFilter},
    {"Run convergence test",
     "Run from further seeds within the uncertainty; all must end at this pose", Icon::kRun},
    {"Stop test", "Stop the convergence test; the seeds run so far count", Icon::kStop},
    {"Validate...", "Give name and reason, then validate this pose", Icon::kShield},
    {"Export pose...", "Write the pose with its checks and its decision to a file", Icon::kFolder},
    {"Report...", "Write the pose on two pages as PDF", Icon::kFolder},
    {"Next case", "Show the next case that is not decided", Icon::kNext},
    {"Show first difference", "Show where onboard and ground run differ first", Icon::kSearch},
    {"Re-run here", "Run the case on the ground with the options of the record", Icon::kRun},
    {"Load record...", "Attach a downlinked record to the case", Icon::kFolder},
};
static_assert(std::size(kSteps) == static_cast<std::size_t>(Step::kLoadRecord) + 1);

}  // namespace

StepInfo stepInfo(Step step) {
  const StepEntry& entry = kSteps[static_cast<std::size_t>(step)];
  const auto translated = [](const char* text) {
    return QCoreApplication::translate("Step", text);
  };
  return {translated(entry.text), translated(entry.help), entry.icon};
}

}  // namespace boresight::ui
