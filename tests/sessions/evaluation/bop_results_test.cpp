// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/bop_scene.h"

#include <cmath>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include "sessions/io/errors.h"
#include "tests/support/random_pose.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using sessions::BopResult;

std::vector<BopResult> randomResults(Random& random, int count) {
  std::vector<BopResult> results;
  for (int i = 0; i < count; ++i)
    results.push_back({1 + i / 4, i % 4, 1 + i % 3, random.uniform(0.0, 1.0), randomPose(random),
                       i % 2 == 0 ? -1.0 : 0.25});
  return results;
}

std::vector<std::string> splitAt(const std::string& text, char sign) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, sign);) parts.push_back(part);
  return parts;
}

/// What bop_toolkit's check_results_bop19.py and load_bop_results demand, written down anew.
TEST(BopResults, KeepsTheRulesOfTheFormat) {
  const TemporaryFolder folder;
  Random random = randomFor("BopResults.Rules");
  const auto results = randomResults(random, 40);
  writeBopResults(folder / "boresight_os-test.csv", results);
  std::ifstream stream(folder / "boresight_os-test.csv");
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, "scene_id,im_id,obj_id,score,R,t,time");
  std::size_t i = 0;
  for (; std::getline(stream, line); ++i) {
    const auto fields = splitAt(line, ',');
    ASSERT_EQ(fields.size(), 7u);
    EXPECT_EQ(std::stoi(fields[0]), results[i].scene_id);
    EXPECT_EQ(std::stoi(fields[1]), results[i].image_id);
    EXPECT_EQ(std::stoi(fields[2]), results[i].object_id);
    EXPECT_EQ(std::stod(fields[3]), results[i].score);
    const auto rotation = splitAt(fields[4], ' ');
    const auto translation = splitAt(fields[5], ' ');
    ASSERT_EQ(rotation.size(), 9u);
    ASSERT_EQ(translation.size(), 3u);
    Eigen::Matrix3d matrix;
    for (int k = 0; k < 9; ++k)
      matrix(k / 3, k % 3) = std::stod(rotation[static_cast<std::size_t>(k)]);
    EXPECT_LT((matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    const Eigen::Vector3d point_mm(10.0, -20.0, 30.0);
    const Eigen::Vector3d in_camera_mm =
        matrix * point_mm + Eigen::Vector3d(std::stod(translation[0]), std::stod(translation[1]),
                                            std::stod(translation[2]));
    EXPECT_LT((1e-3 * in_camera_mm - results[i].camera_from_station * (1e-3 * point_mm)).norm(),
              1e-12);
    EXPECT_EQ(std::stod(fields[6]), results[i].seconds);
  }
  EXPECT_EQ(i, results.size());
}

TEST(BopResults, RefusesWhatTheFormatDoesNotAllow) {
  const TemporaryFolder folder;
  Random random = randomFor("BopResults.Refuses");
  const auto refuses = [&folder](std::vector<BopResult> results) {
    EXPECT_THROW(writeBopResults(folder / "r.csv", results), sessions::OutputError);
  };
  std::vector<BopResult> two(2, randomResults(random, 1)[0]);
  two[1].seconds = 0.5;
  refuses(two);
  two[1].seconds = two[0].seconds;
  two[1].image_id = -1;
  refuses(two);
  two[1].image_id = 0;
  two[1].camera_from_station.translation_m.x() = NAN;
  refuses(two);
}

}  // namespace
}  // namespace boresight::test
