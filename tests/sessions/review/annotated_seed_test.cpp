// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/annotated_seed.h"

#include <gtest/gtest.h>

#include "core/base/math.h"
#include "tests/sessions/checks/drawn_box.h"

namespace boresight::test {
namespace {

using sessions::SessionCase;
using sessions::withMeasuredSeed;

class AnnotatedSeedTest : public testing::Test {
 protected:
  SessionCase seeded(const Matrix6d& covariance) const {
    const auto loaded = box_.subject(box_.camera_from_station_).loaded;
    SessionCase before = loaded->source;
    before.has_seed = false;
    before.mesh_scale_sigma = 0.0;
    before.calibration_sigma = sessions::StatedCalibration{0.0, 0.0};
    before.uncertainty.translation_m.setConstant(0.03);
    return withMeasuredSeed(before, loaded->scene.view(), box_.camera_from_station_, covariance);
  }
  const DrawnBox box_;
};

/// The pose turned and moved at random by the covariance: where the station's centre goes.
TEST_F(AnnotatedSeedTest, Uncertainty_IsThreeSigmaOfTheStationsCentre) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << 4e-4, 1e-4, 9e-4, 4e-6, 9e-6, 1e-6;
  const SessionCase seed = seeded(covariance);
  EXPECT_TRUE(seed.has_seed);
  EXPECT_EQ(seed.camera_from_station_seed, box_.camera_from_station_);
  EXPECT_EQ(seed.uncertainty.pivot, sessions::UncertaintyPivot::kStation);
  const auto scene = box_.subject(box_.camera_from_station_).loaded->scene;
  const Eigen::Vector3d centre_m = box_.camera_from_station_ * matchedBounds(scene.view()).centre();
  const Eigen::Vector3d var_r = covariance.diagonal().head<3>();
  const Eigen::Vector3d var_t = covariance.diagonal().tail<3>();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const double sigma_m = std::sqrt(var_t[i] + var_r[j] * centre_m[k] * centre_m[k] +
                                     var_r[k] * centre_m[j] * centre_m[j]);
    EXPECT_NEAR(seed.uncertainty.translation_m[i], 3.0 * sigma_m, 1e-9) << i;
    EXPECT_NEAR(seed.uncertainty.rotation_deg[i], 3.0 * std::sqrt(var_r[i]) / kDegree_rad, 1e-9);
  }
}

TEST_F(AnnotatedSeedTest, VeryGoodPose_KeepsALeastBoxAndAnUnknownCovarianceTheStatedOne) {
  const auto uncertainty = seeded(1e-12 * Matrix6d::Identity()).uncertainty;
  EXPECT_TRUE(uncertainty.translation_m.isApprox(Eigen::Vector3d::Constant(0.001)));
  EXPECT_TRUE(uncertainty.rotation_deg.isApprox(Eigen::Vector3d::Constant(0.2)));
  EXPECT_EQ(seeded(Matrix6d::Zero()).uncertainty.translation_m.x(), 0.03);
}

}  // namespace
}  // namespace boresight::test
