// SPDX-License-Identifier: Apache-2.0
#include "ui/workspaces/top_bar.h"

#include <QtWidgets>

#include "ui/style/tokens.h"
#include "ui/widgets/widgets.h"

namespace boresight::ui {

TopBar::TopBar(QMenuBar& menus, QWidget* parent)
    : QWidget(parent), tabs_(named(new QTabBar, "workspaceTabs")), tools_(new QHBoxLayout) {
  setObjectName(QStringLiteral("topBar"));
  setAttribute(Qt::WA_StyledBackground);
  setFixedHeight(kTopBarHeight);
  menus.setSizePolicy(QSizePolicy::Maximum, QSizePolicy::Preferred);
  auto* line = named(new QFrame, "topBarLine");
  line->setFixedWidth(1);
  tabs_->setDrawBase(false);
  tabs_->setExpanding(false);
  tabs_->setFocusPolicy(Qt::TabFocus);
  tabs_->setAccessibleName(tr("Workspaces"));
  for (int i = 0; i < kWorkspaceCount; ++i) {
    const auto workspace = static_cast<Workspace>(i);
    tabs_->addTab(workspaceTitle(workspace));
    tabs_->setTabToolTip(i, tr("%1 (Ctrl+%2)").arg(workspaceHelp(workspace)).arg(i + 1));
  }
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 0, 8, 0);
  row->setSpacing(8);
  row->addWidget(&menus, 0, Qt::AlignVCenter);
  row->addWidget(line);
  row->addWidget(tabs_, 0, Qt::AlignBottom);
  row->addStretch(1);
  row->addLayout(tools_);
  connect(tabs_, &QTabBar::currentChanged, this,
          [this](int index) { Q_EMIT workspaceRequested(static_cast<Workspace>(index)); });
}

void TopBar::setCurrent(Workspace workspace) {
  const QSignalBlocker blocked(tabs_);
  tabs_->setCurrentIndex(static_cast<int>(workspace));
}

void TopBar::addTool(QWidget* tool) { tools_->addWidget(tool); }

}  // namespace boresight::ui
