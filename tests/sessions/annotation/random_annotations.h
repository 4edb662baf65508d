// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/base/random.h"
#include "sessions/annotation/annotations.h"

namespace boresight::test {

inline sessions::PointPair randomPoint(Random& random, int i) {
  sessions::PointPair point;
  point.id = "p" + std::to_string(i);
  if (i % 4 != 1)
    point.point_in_station_m = Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  if (i % 4 != 2)
    point.pixel = Eigen::Vector2d(random.uniform(-10, 2000), random.uniform(-10, 2000));
  point.sigma_px = random.uniform(0.1, 3.0);
  point.enabled = i % 3 != 0;
  point.locked = i % 5 == 0;
  point.comment = i % 2 == 0 ? "left \"screw\"\n\u00e9" : "";
  return point;
}

inline sessions::LinePair randomLine(Random& random, int i) {
  sessions::LinePair line;
  line.id = "l" + std::to_string(i);
  if (i % 4 != 1)
    line.edge =
        sessions::ModelEdge{Eigen::Vector3d::Constant(random.normal()),
                            Eigen::Vector3d(random.normal(), random.normal(), random.normal())};
  if (i % 4 != 2)
    line.line =
        sessions::ImageLine{Eigen::Vector2d::Constant(random.uniform(0, 2000)),
                            Eigen::Vector2d(random.uniform(0, 2000), random.uniform(0, 2000))};
  line.sigma_px = random.uniform(0.1, 3.0);
  line.enabled = i % 3 != 0;
  line.locked = i % 5 == 0;
  return line;
}

/// Every fourth pair lacks one side.
inline sessions::Annotations randomAnnotations(Random& random, int points, int lines) {
  sessions::Annotations annotations;
  for (int i = 0; i < points; ++i) annotations.points.push_back(randomPoint(random, i));
  for (int i = 0; i < lines; ++i) annotations.lines.push_back(randomLine(random, i));
  return annotations;
}

}  // namespace boresight::test
