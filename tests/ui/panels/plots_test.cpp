// SPDX-License-Identifier: Apache-2.0
#include "ui/plots/plots.h"

#include <gtest/gtest.h>
#include <QtTest>
#include <QtWidgets>

#include "ui/plots/plot_colors.h"

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

/// Along the axes of a low plot names of quantities are cut.
TEST(DoublePlot, NamesOfTheQuantitiesStandAboveThePlot) {
  DoublePlot plot({QStringLiteral("moved, mm"), true}, {QStringLiteral("turned, deg"), true});
  plot.resize(260, 100);
  plot.show();
  const QImage head = plot.grab().toImage().copy(0, 0, 260, 20);
  const PlotColors colors = plotColors(plot.palette());
  int first = 0;
  int second = 0;
  for (int y = 0; y < head.height(); ++y)
    for (int x = 0; x < head.width(); ++x) {
      first += head.pixelColor(x, y) == colors.first;
      second += head.pixelColor(x, y) == colors.second;
    }
  EXPECT_GT(first, 10);
  EXPECT_GT(second, 10);
}

}  // namespace
}  // namespace boresight::ui
