// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace boresight::ui {

class AnnotationController;
class CaseController;
class Document;
class ExportRunner;
class OnboardController;
class QualityController;
class RunController;
class SequenceRunner;
class TaskRunner;
class ViewState;

/// Objects shared by the parts of the window. The window owns them, and they outlive the parts.
struct WindowParts {
  Document& document;
  ViewState& state;
  TaskRunner& tasks;
  RunController& run;
  CaseController& cases;
  AnnotationController& annotation;
  OnboardController& onboard;
  QualityController& quality;
  SequenceRunner& sequence;
  ExportRunner& exports;
};

}  // namespace boresight::ui
