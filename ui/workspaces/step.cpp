// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/step.h"

#include <array>

#include <QCoreApplication>

namespace boresight::ui {
namespace {

#define STEP_TEXT(text) QT_TRANSLATE_NOOP("Step", text)

/// In the order of `Step`.
constexpr std::array kSteps = {
    StepInfo{"", "", Icon::kNone},
    StepInfo{STEP_TEXT("Choose files..."), STEP_TEXT("Add the files that are still needed"),
             Icon::kFolder},
    StepInfo{STEP_TEXT("Fix files..."),
             STEP_TEXT("Search missing files below the session's folder, or accept changed ones"),
             Icon::kFolder},
    StepInfo{STEP_TEXT("Run"), STEP_TEXT("Run the case to its end"), Icon::kRun},
    StepInfo{STEP_TEXT("Stop"), STEP_TEXT("Stop; the run can be continued"), Icon::kStop},
    StepInfo{STEP_TEXT("Go on"), STEP_TEXT("Continue the run to its end"), Icon::kRun},
    StepInfo{STEP_TEXT("Run again"), STEP_TEXT("Run the case with the inputs and options as they are now"),
             Icon::kRun},
    StepInfo{STEP_TEXT("Review"), STEP_TEXT("Check the pose, then validate or reject it"),
             Icon::kShield},
    StepInfo{STEP_TEXT("Try a wider search"),
             STEP_TEXT("Allow the seed to be turned by up to 180 deg about the view axis, and run again"),
             Icon::kSearch},
    StepInfo{STEP_TEXT("Nudge seed"),
             STEP_TEXT("Move and turn the seed over the image until its edges fit"), Icon::kMove},
    StepInfo{STEP_TEXT("Mask..."), STEP_TEXT("Mark what is not the station, so that it is ignored"),
             Icon::kMask},
    StepInfo{STEP_TEXT("State uncertainty..."),
             STEP_TEXT("State how far the seed may be off, and run again"), Icon::kTarget},
    StepInfo{STEP_TEXT("Annotate"),
             STEP_TEXT("Mark four or more points in the image and on the station; they give a pose"),
             Icon::kPencil},
    StepInfo{STEP_TEXT("Inspect"), STEP_TEXT("Look at single matches and their score maps"),
             Icon::kSearch},
    StepInfo{STEP_TEXT("Competing poses"), STEP_TEXT("Show the other poses next to the result"),
             Icon::kCube},
    StepInfo{STEP_TEXT("Inputs"), STEP_TEXT("Show the inputs' properties and warnings"), Icon::kInfo},
    StepInfo{STEP_TEXT("Use as seed"), STEP_TEXT("The pose of the annotations becomes the seed"),
             Icon::kTarget},
    StepInfo{STEP_TEXT("Switch off"), STEP_TEXT("Solve without this annotation; it is kept"),
             Icon::kCross},
    StepInfo{STEP_TEXT("Run convergence test"),
             STEP_TEXT("Run from further seeds within the uncertainty; all must end at this pose"),
             Icon::kRun},
    StepInfo{STEP_TEXT("Stop test"), STEP_TEXT("Stop the convergence test; what has run counts"),
             Icon::kStop},
    StepInfo{STEP_TEXT("Next case"), STEP_TEXT("Show the next case that is not decided"), Icon::kNext},
    StepInfo{STEP_TEXT("Show first difference"),
             STEP_TEXT("Show where onboard and ground run differ first"), Icon::kSearch},
    StepInfo{STEP_TEXT("Load record..."), STEP_TEXT("Attach a downlinked record to the case"),
             Icon::kFolder},
};
static_assert(kSteps.size() == static_cast<std::size_t>(Step::kLoadRecord) + 1);

}  // namespace

const StepInfo& stepInfo(Step step) { return kSteps[static_cast<std::size_t>(step)]; }

}  // namespace boresight::ui
