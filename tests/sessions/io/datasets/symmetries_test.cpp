// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/datasets/symmetries.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/base/math.h"
#include "sessions/io/files/errors.h"

namespace boresight::sessions {
namespace {

TEST(SymmetriesText, Turns_AreReadAndWritten) {
  for (const char* text : {"none", "z", "z at 0.1 -0.2 0", "y 180", "0.6 0 0.8 120", "z; x 180",
                           "z 180; x 180; y 180", "x 7.2"})
    EXPECT_EQ(symmetriesText(symmetriesIn(text)), text);
  EXPECT_TRUE(symmetriesIn(" ").empty());
  EXPECT_EQ(symmetriesText(symmetriesIn("Z ;; 0 0 2 AT 0.1 0 3;")), "z; z at 0.1 0 3");
  EXPECT_EQ(symmetriesIn("z 90; z 180").discrete.size(), 3u) << "each once";
}

TEST(SymmetriesText, TurnAboutAPoint_LeavesThePoint) {
  const Symmetries quarter = symmetriesIn("z 90 at 0.1 0 0.5");
  ASSERT_EQ(quarter.discrete.size(), 3u);
  const Eigen::Vector3d point_m(0.1, 0.0, -2.0);
  EXPECT_LT((quarter.discrete[0] * point_m - point_m).norm(), 1e-15);
  const Eigen::Vector3d turned_m = quarter.discrete[0] * Eigen::Vector3d(0.3, 0.0, 0.0);
  EXPECT_LT((turned_m - Eigen::Vector3d(0.1, 0.2, 0.0)).norm(), 1e-15);
  const Symmetries again = symmetriesIn(symmetriesText(quarter));
  ASSERT_EQ(again.discrete.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(perturbationBetween(again.discrete[i], quarter.discrete[i]).norm(), 1e-12);
}

TEST(SymmetriesText, TurnsAfterOneAnother_AreSymmetries) {
  const Symmetries square = symmetriesIn("z 90; x 180");
  EXPECT_EQ(square.discrete.size(), 7u);
  for (const Pose& first : square.discrete)
    for (const Pose& second : square.discrete) {
      const Pose both = first * second;
      double least = perturbationBetween(Pose(), both).norm();
      for (const Pose& turn : square.discrete)
        least = std::min(least, perturbationBetween(turn, both).norm());
      EXPECT_LT(least, 1e-9);
    }
  EXPECT_EQ(symmetriesIn("z 90; 1 1 1 120").discrete.size(), 23u) << "of a cube";
  EXPECT_THROW((void)symmetriesIn("z 90; z 90 at 0.1 0 0"), InputError) << "shifts without end";
  EXPECT_THROW((void)symmetriesIn("z 90; 1 0 1 72"), InputError);
}

TEST(SymmetriesText, TurnThatMovesTheStation_IsRefused) {
  const BoundingBox bounds{{-0.1, -0.1, 0.0}, {0.1, 0.1, 0.3}};
  for (const char* text : {"none", "z", "z 90; x 180 at 0 0 0.15", "z at 0.01 -0.01 0"})
    EXPECT_NO_THROW(requireInPlace(symmetriesIn(text), bounds, "case 1")) << text;
  for (const char* text : {"z at 0 100 0", "x 180", "x", "z 180 at 0.2 0 0"})
    EXPECT_THROW(requireInPlace(symmetriesIn(text), bounds, "case 1"), InputError) << text;
}

TEST(SymmetriesText, OtherTransforms_AreCounted) {
  Symmetries symmetries = symmetriesIn("x 180");
  symmetries.discrete.push_back({Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.1}});
  symmetries.discrete.push_back(turnAbout({}, 1.0));
  EXPECT_EQ(symmetriesText(symmetries), "x 180; and 2 other transforms");
}

TEST(SymmetriesText, TextWithoutMeaning_IsRefused) {
  for (const char* text :
       {"w", "z 0", "z 360", "z 100", "z -90", "z nan", "0 0 0 90", "1 2", "z on 1 2 3", "z at 1 2",
        "z at 1 2 3 4", "z 90 x", "z at 1 2 1,5", "x 180; and 2 other transforms"})
    EXPECT_THROW((void)symmetriesIn(text), InputError) << text;
}

}  // namespace
}  // namespace boresight::sessions
