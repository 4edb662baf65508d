// SPDX-License-Identifier: Apache-2.0
#include "ui/window/window_frame.h"

#include <QtWidgets>

#include "ui/models/text.h"
#include "ui/panels/case/cases_panel.h"
#include "ui/review/onboard_controller.h"
#include "ui/state/document.h"
#include "ui/style/icons.h"
#include "ui/style/theme.h"
#include "ui/views/compare_view.h"
#include "ui/views/image_panel.h"
#include "ui/views/layers_panel.h"
#include "ui/widgets/widgets.h"
#include "ui/window/case_controller.h"
#include "ui/window/case_menu.h"
#include "ui/window/session_files.h"
#include "ui/window/start_page.h"
#include "ui/window/window_docks.h"
#include "ui/workspaces/canvas_frame.h"
#include "ui/workspaces/case_strip.h"
#include "ui/workspaces/drawer_bar.h"
#include "ui/workspaces/job_strip.h"
#include "ui/workspaces/run_bar.h"
#include "ui/workspaces/top_bar.h"
#include "ui/workspaces/verdict_bar.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

QToolButton* toolOf(Icon icon, const char* name, const QString& tip) {
  auto* button = named(new QToolButton, name, tip);
  button->setIcon(iconOf(icon));
  button->setAccessibleName(tip);
  button->setAutoRaise(true);
  button->setFixedSize(kButtonHeight, kButtonHeight);
  return button;
}

/// The layers that a workspace's task needs; the others are in "all layers".
std::vector<LayerId> layersOf(Workspace workspace) {
  switch (workspace) {
    case Workspace::kAnnotate:
      return {LayerId::kPoints,    LayerId::kAnnotationEdges, LayerId::kAnnotationResiduals,
              LayerId::kSeedEdges, LayerId::kProposals,       LayerId::kIgnoreMask};
    case Workspace::kDiagnose:
      return {LayerId::kSeedEdges, LayerId::kIterationEdges, LayerId::kMatches,
              LayerId::kTemplates, LayerId::kAgreement,      LayerId::kResiduals};
    case Workspace::kReview:
      return {LayerId::kSeedEdges, LayerId::kIterationEdges, LayerId::kTruthEdges,
              LayerId::kTestEdges, LayerId::kAgreement};
    default:
      return {LayerId::kSeedEdges, LayerId::kIterationEdges, LayerId::kTruthEdges,
              LayerId::kTestEdges, LayerId::kMatches};
  }
}

/// "bc-000041: run 2 of 3, converged".
QString shownTitle(const sessions::Session& session, const ViewState& state) {
  if (!state.currentCase()) return {};
  const std::string& id = state.currentCase()->source.id;
  const ViewState::SnapshotPtr& shown = state.snapshot();
  if (state.missingRun()) return WindowFrame::tr("%1: no run to show").arg(fromText(id));
  if (!shown && session.lastRunOf(id)) return fromText(id);  // it is being read, or about to run
  if (!shown) return WindowFrame::tr("%1: no run").arg(fromText(id));
  if (shown->replayed) return WindowFrame::tr("%1: onboard run").arg(fromText(id));
  if (!shown->finished) return WindowFrame::tr("%1: run not finished").arg(fromText(id));
  int count = 0;
  int number = 0;
  for (const sessions::RunRecord* run : session.runs.findAll(id)) {
    ++count;
    if (run->digest == shown->digest) number = count;
  }
  const QString outcome =
      shown->converged() ? WindowFrame::tr("converged") : WindowFrame::tr("no result");
  return number == 0 ? WindowFrame::tr("%1: new run, %2").arg(fromText(id), outcome)
                     : WindowFrame::tr("%1: run %2 of %3, %4")
                           .arg(fromText(id))
                           .arg(number)
                           .arg(count)
                           .arg(outcome);
}

}  // namespace

WindowFrame::WindowFrame(QMainWindow& window, QMainWindow& body, WindowParts& parts,
                         const WindowDocks& docks, Workspaces& workspaces, SessionFiles& files)
    : QObject(&window),
      window_(window),
      body_(body),
      parts_(parts),
      docks_(docks),
      workspaces_(workspaces),
      files_(files) {
  build();
  connectAll();
}

void WindowFrame::build() {
  cases_ = new CaseStrip(docks_.cases.model());
  verdict_ = new VerdictBar;
  start_ = new StartPage(files_, parts_.document);
  run_bar_ = new RunBar(parts_.state);
  drawers_ = new DrawerBar(workspaces_);
  jobs_ = new JobStrip;
  stack_ = new QStackedWidget;
  body_.setCentralWidget(stack_);
  canvas_column_ = new QWidget;
  stack_->addWidget(start_);
  stack_->addWidget(canvas_column_);
  auto* canvas = withoutMargins(new QVBoxLayout(canvas_column_));
  canvas->addWidget(&docks_.findings);
  canvas->addWidget(&docks_.canvas, 1);
  canvas->addWidget(run_bar_);
  canvas->addWidget(drawers_);
  QWidget* centre = body_.parentWidget();
  window_.setCentralWidget(centre);
  auto* grid = withoutMargins(new QGridLayout(centre));
  grid->addWidget(cases_, 0, 0, 2, 1);
  grid->addWidget(verdict_, 0, 1);
  grid->addWidget(&body_, 1, 1);
  grid->addWidget(jobs_, 2, 0, 1, 2);
  grid->setRowStretch(1, 1);
  grid->setColumnStretch(1, 1);
  window_.statusBar()->hide();  // its messages are the job strip's notes
}

void WindowFrame::connectAll() {
  connect(window_.statusBar(), &QStatusBar::messageChanged, jobs_, &JobStrip::setNote);
  connect(&docks_.image, &ImagePanel::placeText, jobs_, &JobStrip::setPlace);
  connect(&docks_.image, &ImagePanel::allLayersRequested, this, [this] {
    docks_.layers.showAll();
    workspaces_.reveal(QStringLiteral("layers"));
  });
  connect(&docks_.image, &ImagePanel::templateClicked, this, [this] {
    if (workspaces_.current() == Workspace::kDiagnose)
      workspaces_.reveal(QStringLiteral("inspector"));
  });
  connect(cases_, &CaseStrip::caseRequested, this, [this](const QString& id) {
    if (workspaces_.current() == Workspace::kStart) workspaces_.show(Workspace::kRun);
    parts_.cases.chooseCase(id);
  });
  connect(cases_, &CaseStrip::listRequested, this, [this] {
    QDockWidget* list = workspaces_.dock(QStringLiteral("cases"));
    list->setVisible(!list->isVisible());
  });
  const auto show_menu = [this](const QString& id, const QPoint& at) {
    caseMenu(id, parts_, workspaces_, window_)->exec(at);
  };
  connect(cases_, &CaseStrip::menuRequested, this, show_menu);
  connect(&docks_.cases, &CasesPanel::menuRequested, this, show_menu);
  connect(cases_, &CaseStrip::addRequested, &files_, &SessionFiles::askForFiles);
  parts_.state.onChange(ViewChange::kOtherCase, cases_,
                        [this] { cases_->setCurrent(parts_.cases.caseId()); });
  connect(&workspaces_, &Workspaces::changed, this, &WindowFrame::arrange);
  connect(&parts_.onboard, &OnboardController::changed, this, &WindowFrame::arrange);
  parts_.state.onChange(ViewChange::kSnapshot | ViewChange::kCase, this, &WindowFrame::arrange);
  connect(&parts_.document, &Document::changed, this, &WindowFrame::showTitle);
}

void WindowFrame::takeMenus() {
  top_bar_ = new TopBar(*window_.menuBar());
  window_.setMenuWidget(top_bar_);
  auto* pane = toolOf(Icon::kSidePane, "toggleSide", tr("Side pane on and off (Alt+0)"));
  auto* theme = toolOf(Icon::kTheme, "switchTheme", tr("Light or dark colours"));
  auto* help = toolOf(Icon::kHelp, "showKeys", tr("Keys and manual (F1)"));
  for (QToolButton* each : {pane, theme, help}) top_bar_->addTool(each);
  connect(pane, &QToolButton::clicked, this,
          [this] { workspaces_.toggleArea(Qt::RightDockWidgetArea); });
  connect(theme, &QToolButton::clicked, this, &WindowFrame::switchTheme);
  connect(help, &QToolButton::clicked, this, [this] {
    if (auto* keys = window_.findChild<QAction*>(QStringLiteral("keys"))) keys->trigger();
  });
  connect(top_bar_, &TopBar::workspaceRequested, &workspaces_, &Workspaces::show);
  arrange();
}

void WindowFrame::switchTheme() {
  const ThemeName next = themeName() == ThemeName::kDark ? ThemeName::kLight : ThemeName::kDark;
  applyTheme(*qApp, next);
  rememberTheme(next);
}

void WindowFrame::arrange() {
  const Workspace workspace = workspaces_.current();
  const bool narrow = workspaces_.isNarrow();
  const bool start = workspace == Workspace::kStart;
  top_bar_->setCurrent(workspace);
  docks_.layers.setShortList(layersOf(workspace));
  stack_->setCurrentWidget(start ? static_cast<QWidget*>(start_) : canvas_column_);
  if (start) start_->refresh();
  cases_->setNarrow(narrow);
  cases_->setForDecisions(workspace == Workspace::kReview);
  cases_->setVisible(narrow || workspace != Workspace::kReview);  // the queue takes its place
  run_bar_->setVisible(workspace == Workspace::kRun);
  run_bar_->setNarrow(narrow);
  const bool compares = workspace == Workspace::kOnboard && parts_.onboard.review();
  docks_.canvas.setSource(parts_.onboard.showsOnboard() ? CanvasSource::kOnboard
                          : compares                    ? CanvasSource::kGround
                                                        : CanvasSource::kOnly);
  showTitle();
  putOnboardBeside(compares && !narrow && !parts_.onboard.showsOnboard());
}

void WindowFrame::showTitle() {
  docks_.image.setTitle(shownTitle(parts_.document.session(), parts_.state));
}

/// Both runs are in view where there is room; a canvas that the operator closes stays closed until
/// the workspace is entered again.
void WindowFrame::putOnboardBeside(bool wanted) {
  if (wanted == onboard_beside_) return;
  onboard_beside_ = wanted;
  if (wanted)
    docks_.compare.showOnboardRun();
  else
    docks_.image.showBeside(false);
}

}  // namespace boresight::ui
