// SPDX-License-Identifier: Apache-2.0
// The matcher that ships, where its model and its package are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "sessions/baselines/matcher_client.h"
#include "tests/support/example_case.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

using sessions::PixelPair;

/// Empty where the model or the package is missing.
std::string loftrCommand() {
  const char* model = std::getenv("BORESIGHT_LOFTR_MODEL");
  if (model == nullptr || !std::filesystem::exists(model)) return "";
  if (std::system("node --version >/dev/null 2>&1") != 0) return "";
  const std::string program = std::string(BORESIGHT_MATCHERS) + "/loftr/loftr.js";
  const std::string probe = "cd '" + std::string(BORESIGHT_MATCHERS) +
                            "/loftr' && node -e \"require('onnxruntime-node')\"";
  if (std::system((probe + " >/dev/null 2>&1").c_str()) != 0) return "";
  return "node '" + program + "' --model '" + model + "'";
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TEST(Loftr, FindsAShift) {
  const std::string command = loftrCommand();
  if (command.empty())
    GTEST_SKIP() << "set BORESIGHT_LOFTR_MODEL to the model's file, and run `npm install` in "
                    "resources/matchers/loftr";
  const ExampleCase example("os");
  const ImageView whole = example.image.view();
  constexpr int kShift = 48;
  const ImageView first{whole.data, whole.width - kShift, whole.height - kShift, whole.stride};
  const ImageView second{whole.row(kShift) + kShift, first.width, first.height, whole.stride};
  sessions::MatcherClient client(command, 120.0, {});
  const std::vector<PixelPair> pairs = client.match(first, second, 400, 120.0, {});
  ASSERT_GT(pairs.size(), 30u);
  std::vector<double> dx, dy;
  for (const PixelPair& pair : pairs) {
    dx.push_back(pair.second_x - pair.first_x);
    dy.push_back(pair.second_y - pair.first_y);
  }
  // A cell is 16 px of 640 x 480.
  EXPECT_NEAR(median(dx), -kShift, 0.5 * 16.0 * first.width / 640.0);
  EXPECT_NEAR(median(dy), -kShift, 0.5 * 16.0 * first.height / 480.0);
}

TEST(Loftr, MissingPackageIsNamedWithWhatToDo) {
  if (std::system("node --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "node is not installed";
  const TemporaryFolder folder;
  std::filesystem::copy(std::filesystem::path(BORESIGHT_MATCHERS) / "loftr/loftr.js",
                        folder / "loftr.js");
  const std::string command =
      "env -u NODE_PATH node '" + (folder / "loftr.js").string() + "' --model model.onnx";
  EXPECT_EQ(
      folder.message([&] { const sessions::MatcherClient client(command, 120.0, {}); }),
      "the matcher (env -u NODE_PATH node 'loftr.js' --model model.onnx) ended with status 1, "
      "saying: the package onnxruntime-node is not installed: run npm install in " +
          std::filesystem::canonical(folder.path()).string());
}

}  // namespace
}  // namespace boresight::test
