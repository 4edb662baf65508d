// SPDX-License-Identifier: Apache-2.0
#include "ui/plots/plots.h"

#include <gtest/gtest.h>
#include <QtTest>
#include <QtWidgets>

namespace boresight::ui {
namespace {

QImage axisOf(DoublePlot& plot) {
  const QImage shown = plot.grab().toImage();
  return shown.copy(0, shown.height() - 24, shown.width(), 24);
}

/// A scale keeps its labels by value: the first iteration's must not be that of the time before.
TEST(DoublePlot, NamesOfAScaleThatStaysTheSameAreNew) {
  QString name = QStringLiteral("seed");
  DoublePlot plot({QStringLiteral("a"), false}, {QStringLiteral("b"), false});
  plot.resize(300, 200);
  plot.show();
  plot.setNames([&](int) { return name; });
  plot.setPoints(0, {}, {});
  const QImage before = axisOf(plot);
  name = QStringLiteral("1.1");
  plot.setPoints(1, {}, {});
  EXPECT_NE(axisOf(plot), before);
}

}  // namespace
}  // namespace boresight::ui
