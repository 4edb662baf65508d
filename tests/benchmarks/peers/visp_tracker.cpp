// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/visp_tracker.h"

#include <list>

#include <visp3/core/vpConfig.h>
#include <visp3/core/vpImageConvert.h>
#include <visp3/mbt/vpMbGenericTracker.h>

namespace boresight::peers {

struct VispTracker::Held {
  vpMbGenericTracker tracker;
  vpImage<unsigned char> image;
};

VispTracker::VispTracker(const std::string& model_file, const VispTuning& tuning)
    : held_(std::make_unique<Held>()) {
  vpMe sites;
  sites.setMaskSize(tuning.mask_px);
  sites.setMaskNumber(tuning.mask_count);
  sites.setRange(tuning.range_px);
  sites.setThreshold(tuning.threshold);
  sites.setMu1(tuning.mu1);
  sites.setMu2(tuning.mu2);
  sites.setSampleStep(tuning.sample_px);
  vpMbGenericTracker& tracker = held_->tracker;
  tracker.setTrackerType(vpMbGenericTracker::EDGE_TRACKER);
  tracker.setMovingEdge(sites);
  tracker.setAngleAppear(vpMath::rad(89.0));
  tracker.setAngleDisappear(vpMath::rad(90.0));
  tracker.setNearClippingDistance(0.01);
  tracker.setFarClippingDistance(100.0);
  tracker.setClipping(tracker.vpMbTracker::getClipping() | vpMbtPolygon::FOV_CLIPPING);
  tracker.setGoodMovingEdgesRatioThreshold(tuning.good_share);
  tracker.setProjectionErrorComputation(true);
  tracker.loadModel(model_file);
  tracker.setScanLineVisibilityTest(true);
  tracker.getFaces().getMbScanLineRenderer().setDepthTreshold(tuning.depth_threshold);
  tracker.setUseEdgeTracking(kVispFace, false);
}

VispTracker::VispTracker(VispTracker&&) noexcept = default;
VispTracker::~VispTracker() = default;

std::string VispTracker::version() {
  return std::to_string(VISP_VERSION_MAJOR) + "." + std::to_string(VISP_VERSION_MINOR) + "." +
         std::to_string(VISP_VERSION_PATCH);
}

void VispTracker::look(const cv::Mat& gray, double fx, double fy, double cx, double cy) {
  vpImageConvert::convert(gray, held_->image);
  vpCameraParameters camera;
  camera.initPersProjWithoutDistortion(fx, fy, cx, cy);
  held_->tracker.setCameraParameters(camera);
}

void VispTracker::begin(const PoseRows& camera_from_station, unsigned int seek_px) {
  vpHomogeneousMatrix pose;
  for (unsigned int i = 0; i < 16; ++i) pose[i / 4][i % 4] = camera_from_station[i];
  held_->tracker.initFromPose(held_->image, pose);
  std::list<vpMbtDistanceLine*> lines;
  held_->tracker.getLline(lines);
  for (vpMbtDistanceLine* line : lines) {
    if (!line->isVisible() || !line->isTracked()) continue;
    for (vpMbtMeLine* sites : line->meline) {
      if (sites == nullptr) continue;
      sites->setInitRange(seek_px);
      sites->vpMeTracker::initTracking(held_->image);
    }
  }
}

void VispTracker::track() { held_->tracker.track(held_->image); }

PoseRows VispTracker::pose() const {
  const vpHomogeneousMatrix pose = held_->tracker.vpMbTracker::getPose();
  PoseRows rows{};
  for (unsigned int i = 0; i < 16; ++i) rows[i] = pose[i / 4][i % 4];
  return rows;
}

double VispTracker::share() const {
  const vpColVector weights = held_->tracker.getRobustWeights();
  return weights.size() > 0 ? weights.sum() / weights.size() : 0.0;
}

double VispTracker::projectionError_deg() const { return held_->tracker.getProjectionError(); }

}  // namespace boresight::peers
