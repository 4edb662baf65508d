// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/step.h"

#include <array>

#include <QCoreApplication>

namespace boresight::ui {
namespace {

/// In the order of `Step`.
constexpr std::array kSteps = {
    StepInfo{"", "", Icon::kNone},
    StepInfo{QT_TR_NOOP("Choose files..."), QT_TR_NOOP("Add the files that are still needed"),
             Icon::kFolder},
    StepInfo{QT_TR_NOOP("Fix files..."),
             QT_TR_NOOP("Search missing files below the session's folder, or accept changed ones"),
             Icon::kFolder},
    StepInfo{QT_TR_NOOP("Change file..."), QT_TR_NOOP("Replace the file by another one"),
             Icon::kFolder},
    StepInfo{QT_TR_NOOP("Run"), QT_TR_NOOP("Run the case to its end"), Icon::kRun},
    StepInfo{QT_TR_NOOP("Stop"), QT_TR_NOOP("Stop; the run can be continued"), Icon::kStop},
    StepInfo{QT_TR_NOOP("Go on"), QT_TR_NOOP("Continue the run to its end"), Icon::kRun},
    StepInfo{QT_TR_NOOP("Run again"),
             QT_TR_NOOP("Run the case with the current inputs and options"), Icon::kRun},
    StepInfo{QT_TR_NOOP("Run the rest"),
             QT_TR_NOOP("Run the cases that have no run with their current inputs and options"),
             Icon::kRun},
    StepInfo{QT_TR_NOOP("Show"), QT_TR_NOOP("List the cases, the worst first"), Icon::kFilter},
    StepInfo{QT_TR_NOOP("Review"), QT_TR_NOOP("Check the pose, then validate or reject it"),
             Icon::kShield},
    StepInfo{QT_TR_NOOP("Try a wider search"),
             QT_TR_NOOP(
                 "Allow the seed to be turned by up to 180 deg about the view axis, and run again"),
             Icon::kSearch},
    StepInfo{QT_TR_NOOP("Nudge seed"),
             QT_TR_NOOP("Move and turn the seed over the image until its edges fit"), Icon::kMove},
    StepInfo{QT_TR_NOOP("Mask..."), QT_TR_NOOP("Mark pixels outside the station, to ignore them"),
             Icon::kMask},
    StepInfo{QT_TR_NOOP("State uncertainty..."),
             QT_TR_NOOP("State how far the seed may be off, and run again"), Icon::kTarget},
    StepInfo{
        QT_TR_NOOP("Annotate"),
        QT_TR_NOOP("Mark four or more points in the image and on the station; they give a pose"),
        Icon::kPencil},
    StepInfo{QT_TR_NOOP("Inspect"), QT_TR_NOOP("Look at single matches and their score maps"),
             Icon::kSearch},
    StepInfo{QT_TR_NOOP("Competing poses"), QT_TR_NOOP("Show the other poses next to the result"),
             Icon::kCube},
    StepInfo{QT_TR_NOOP("Inputs"), QT_TR_NOOP("Show the inputs' properties and warnings"),
             Icon::kInfo},
    StepInfo{
        QT_TR_NOOP("Use as seed"),
        QT_TR_NOOP("The pose of the annotations becomes the seed, with 3 sigma as its uncertainty"),
        Icon::kTarget},
    StepInfo{QT_TR_NOOP("Switch off"), QT_TR_NOOP("Solve without this annotation; it is kept"),
             Icon::kCross},
    StepInfo{QT_TR_NOOP("Robust"),
             QT_TR_NOOP("Solve again; annotations that fit badly count little or nothing"),
             Icon::kFilter},
    StepInfo{QT_TR_NOOP("Run convergence test"),
             QT_TR_NOOP("Run from further seeds within the uncertainty; all must end at this pose"),
             Icon::kRun},
    StepInfo{QT_TR_NOOP("Stop test"),
             QT_TR_NOOP("Stop the convergence test; the seeds run so far count"), Icon::kStop},
    StepInfo{QT_TR_NOOP("Validate..."), QT_TR_NOOP("Give name and reason, then validate this pose"),
             Icon::kShield},
    StepInfo{QT_TR_NOOP("Export pose..."),
             QT_TR_NOOP("Write the pose with its checks and its decision to a file"),
             Icon::kFolder},
    StepInfo{QT_TR_NOOP("Report..."), QT_TR_NOOP("Write the pose on two pages as PDF"),
             Icon::kFolder},
    StepInfo{QT_TR_NOOP("Next case"), QT_TR_NOOP("Show the next case that is not decided"),
             Icon::kNext},
    StepInfo{QT_TR_NOOP("Show first difference"),
             QT_TR_NOOP("Show where onboard and ground run differ first"), Icon::kSearch},
    StepInfo{QT_TR_NOOP("Re-run here"),
             QT_TR_NOOP("Run the case on the ground with the options of the record"), Icon::kRun},
    StepInfo{QT_TR_NOOP("Load record..."), QT_TR_NOOP("Attach a downlinked record to the case"),
             Icon::kFolder},
};
static_assert(kSteps.size() == static_cast<std::size_t>(Step::kLoadRecord) + 1);

}  // namespace

const StepInfo& stepInfo(Step step) { return kSteps[static_cast<std::size_t>(step)]; }

}  // namespace boresight::ui
