// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ui/annotation/annotation_controller.h"
#include "ui/review/onboard_controller.h"
#include "ui/review/quality_controller.h"
#include "ui/run/document_tasks.h"
#include "ui/run/export_runner.h"
#include "ui/run/run_controller.h"
#include "ui/run/sequence_runner.h"
#include "ui/run/task_runner.h"
#include "ui/state/document.h"
#include "ui/state/view_state.h"
#include "ui/window/case_controller.h"
#include "ui/window/run_store.h"

namespace boresight::ui {

/// Objects shared by the parts of the window. Destroyed before the window's child objects, whose
/// destructors must not use them.
struct WindowParts {
  Document document;
  ViewState state;
  TaskRunner tasks;
  DocumentTasks of_document{document, tasks};
  RunController run;
  RunStore store{document};
  CaseController cases{document, state, run, store, tasks, of_document};
  AnnotationController annotation{document, state};
  OnboardController onboard{document, state, tasks};
  QualityController quality{document, state, tasks};
  SequenceRunner sequence;
  ExportRunner exports;
};

}  // namespace boresight::ui
