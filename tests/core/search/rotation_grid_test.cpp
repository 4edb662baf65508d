// SPDX-License-Identifier: Apache-2.0
#include "core/search/rotation_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/geometry/pose.h"
#include "tests/support/random_pose.h"

namespace boresight {
namespace {

std::vector<Eigen::Quaterniond> samplesOf(const RotationGrid::Range& range) {
  std::vector<Eigen::Quaterniond> samples;
  RotationGrid grid(range);
  while (grid.next())
    for (int k = 0; k < grid.count(); ++k)
      if ((grid.turns() >> k & 1U) != 0)
        samples.push_back(rotationExp({0.0, 0.0, k * grid.spacing_rad()}) *
                          rotationExp(grid.tilt_rad()));
  return samples;
}

double angleBetween(const Eigen::Quaterniond& first, const Eigen::Quaterniond& second) {
  return 2.0 * std::acos(std::min(1.0, std::abs(first.dot(second))));
}

Eigen::Vector3d inBox(const Eigen::Vector3d& half, Random& random) {
  return half.cwiseProduct(test::randomVector(random, 1.0));
}

RotationGrid::Range rangeOf(const Eigen::Vector3d& box_deg, Random& random) {
  RotationGrid::Range range;
  range.box_rad = box_deg * kDegree_rad;
  range.view_from_camera = rotationExp(inBox({0.3, 0.3, 0.0}, random));
  range.aside_rad = {random.uniform(0.0, 0.1), random.uniform(0.0, 0.1)};
  return range;
}

const Eigen::Vector3d kBoxes_deg[] = {{2, 2, 2},      {8, 8, 8},     {10, 3, 30},  {13, 180, 13},
                                      {180, 13, 13},  {13, 13, 180}, {21, 21, 21}, {29, 29, 29},
                                      {37, 37, 37},   {45, 45, 45},  {90, 10, 90}, {180, 180, 8},
                                      {180, 180, 180}};

TEST(RotationGrid, RotationsOfTheBox_HaveASampleWithinTheSpacing) {
  Random random(1);
  for (const Eigen::Vector3d& box_deg : kBoxes_deg) {
    SCOPED_TRACE(box_deg.transpose());
    const RotationGrid::Range range = rangeOf(box_deg, random);
    const std::vector<Eigen::Quaterniond> samples = samplesOf(range);
    for (int i = 0; i < 400; ++i) {
      const Eigen::Quaterniond turned = rotationExp(inBox(range.box_rad, random));
      const Eigen::Quaterniond aside =
          rotationExp(inBox({range.aside_rad.x(), range.aside_rad.y(), 0.0}, random));
      const Eigen::Quaterniond in_view =
          aside * (range.view_from_camera * turned * range.view_from_camera.conjugate());
      double nearest = 10.0;
      for (const Eigen::Quaterniond& sample : samples)
        nearest = std::min(nearest, angleBetween(sample, in_view));
      EXPECT_LT(nearest, RotationGrid(range).spacing_rad());
    }
  }
}

TEST(RotationGrid, LargerBox_HasNoFewSamples) {
  Random random(3);
  std::size_t most = 0;
  for (double side_deg = 8.0; side_deg <= 60.0; side_deg += 0.5) {
    RotationGrid::Range range = rangeOf(Eigen::Vector3d::Constant(side_deg), random);
    range.view_from_camera = Eigen::Quaterniond::Identity();
    range.aside_rad.setZero();
    const std::size_t samples = samplesOf(range).size();
    EXPECT_GT(samples, 0.7 * static_cast<double>(most)) << side_deg;
    most = std::max(most, samples);
  }
}

TEST(RotationGrid, Samples_AreApart) {
  Random random(2);
  const RotationGrid::Range range = rangeOf({180, 180, 180}, random);
  const std::vector<Eigen::Quaterniond> samples = samplesOf(range);
  EXPECT_EQ(samples.size(), 188u * 24u);
  double nearest = 10.0;
  for (std::size_t i = 0; i < samples.size(); i += 7)
    for (std::size_t j = 0; j < samples.size(); ++j)
      if (i != j) nearest = std::min(nearest, angleBetween(samples[i], samples[j]));
  EXPECT_GT(nearest, 0.85 * RotationGrid(range).spacing_rad());
}

TEST(RotationGrid, SmallBoxes_HaveFewSamples) {
  RotationGrid::Range range;
  EXPECT_EQ(samplesOf(range).size(), 1u);
  range.box_rad = Eigen::Vector3d::Constant(8.0 * kDegree_rad);
  EXPECT_LE(samplesOf(range).size(), 250u);
  range.box_rad = {8.0 * kDegree_rad, kPi, 8.0 * kDegree_rad};
  EXPECT_LE(samplesOf(range).size(), 400u);
}

/// Every rotation that a small turn brings into the box is near the box; the turns are tried.
TEST(RotationGrid, RotationsWithinASmallTurnOfTheBox_AreNear) {
  Random random(3);
  const Eigen::Vector3d slack_rad(0.02, 0.01, 0.03);
  for (const Eigen::Vector3d& box_deg : kBoxes_deg) {
    const Eigen::Vector3d box_rad = box_deg * kDegree_rad;
    for (int i = 0; i < 500; ++i) {
      const Eigen::Quaterniond turned =
          rotationExp(inBox(slack_rad, random)) * rotationExp(inBox(box_rad, random));
      // To first order: a tenth more.
      EXPECT_TRUE(isNearBox(rotationLog(turned), box_rad, 1.1 * slack_rad)) << box_deg.transpose();
    }
  }
}

/// The first-order reach of a slack, by the formula alone.
Eigen::Vector3d reachOf(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& box_rad,
                        const Eigen::Vector3d& slack_rad) {
  const double angle2 = rotation_rad.squaredNorm();
  const double half = 0.5 * std::sqrt(angle2);
  Eigen::Matrix3d cross;
  for (int k = 0; k < 3; ++k) cross.col(k) = rotation_rad.cross(Eigen::Vector3d::Unit(k));
  const Eigen::Matrix3d slope = Eigen::Matrix3d::Identity() - 0.5 * cross +
                                (1.0 - half / std::tan(half)) / angle2 * (cross * cross);
  return box_rad + slope.cwiseAbs() * slack_rad;
}

/// Random rotations of all lengths up to more than half a turn.
TEST(RotationGrid, NearRotations_AreThoseOfTheFormula) {
  Random random(5);
  int near = 0;
  for (int i = 0; i < 200000; ++i) {
    const Eigen::Vector3d box_rad = inBox(Eigen::Vector3d::Constant(1.5), random).cwiseAbs();
    const Eigen::Vector3d slack_rad = inBox(Eigen::Vector3d::Constant(0.5), random).cwiseAbs();
    const Eigen::Vector3d rotation_rad = inBox(Eigen::Vector3d::Constant(2.2), random);
    const Eigen::Vector3d reach = reachOf(rotation_rad, box_rad, slack_rad);
    const double excess = (rotation_rad.cwiseAbs() - reach).maxCoeff();
    if (std::abs(excess) < 1e-9) continue;  // a matter of rounding
    EXPECT_EQ(isNearBox(rotation_rad, box_rad, slack_rad), excess < 0.0);
    near += excess < 0.0 ? 1 : 0;
  }
  EXPECT_GT(near, 10000);
}

}  // namespace
}  // namespace boresight
