// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/peers/visp_tracker.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <list>
#include <stdexcept>

#include <visp3/core/vpConfig.h>
#include <visp3/core/vpImageConvert.h>
#include <visp3/mbt/vpMbGenericTracker.h>

namespace boresight::peers {

namespace {

/// Lines and faces can be given one by one as well as by a file. A file takes minutes for ten
/// thousand of them: ViSP compares each with all before it, and follows all sides of faces.
class ModelTracker : public vpMbGenericTracker {
 public:
  void begin(const std::array<VispPoint, 2>& first_line);
  void addLine(const std::array<VispPoint, 2>& line, bool scan_lines);
  void addFace(const std::array<VispPoint, 3>& face);

 private:
  /// As vpMbTracker::addPolygon does. The index of the new one.
  template <std::size_t kCorners>
  int addPolygon(const std::array<VispPoint, kCorners>& corners);
  void clip(vpPolygon3D& polygon) const;

  vpUniRand random_;
};

/// Names what vpMbEdgeTracker shows to classes that derive from it.
struct EdgeTrackerMembers : vpMbEdgeTracker {
  static std::list<vpMbtDistanceLine*>& linesOf(vpMbEdgeTracker& tracker) {
    return (tracker.*(&EdgeTrackerMembers::lines)).front();
  }
  static vpMe& movingEdgeOf(vpMbEdgeTracker& tracker) { return tracker.*(&EdgeTrackerMembers::me); }
};

vpPoint pointOf(const VispPoint& point) { return {point[0], point[1], point[2]}; }

void ModelTracker::begin(const std::array<VispPoint, 2>& first_line) {
  std::string folder = (std::filesystem::temp_directory_path() / "peers-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no temporary folder");
  const std::string file = folder + "/model.cao";
  std::ofstream stream(file);
  stream.precision(12);
  stream << "V1\n2\n";
  for (const VispPoint& point : first_line)
    stream << point[0] << " " << point[1] << " " << point[2] << "\n";
  stream << "1\n0 1\n0\n0\n0\n0\n";
  stream.close();
  loadModel(file);
  std::filesystem::remove_all(folder);
}

void ModelTracker::clip(vpPolygon3D& polygon) const {
  polygon.setClipping(vpMbTracker::getClipping());
  polygon.setNearClippingDistance(getNearClippingDistance());
  polygon.setFarClippingDistance(getFarClippingDistance());
}

template <std::size_t kCorners>
int ModelTracker::addPolygon(const std::array<VispPoint, kCorners>& corners) {
  vpMbHiddenFaces<vpMbtPolygon>& held = getFaces();
  vpMbtPolygon polygon;
  polygon.setNbPoint(kCorners);
  polygon.setIndex(static_cast<int>(held.size()));
  for (std::size_t i = 0; i < kCorners; ++i)
    polygon.addPoint(static_cast<unsigned int>(i), pointOf(corners[i]));
  held.addPolygon(&polygon);
  clip(*held.getPolygon().back());
  return polygon.getIndex();
}

/// As vpMbEdgeTracker::addLine does for a line that is new.
void ModelTracker::addLine(const std::array<VispPoint, 2>& line, bool scan_lines) {
  vpMbEdgeTracker& tracker = *m_mapOfTrackers.begin()->second;
  auto* added = new vpMbtDistanceLine;
  vpPoint first = pointOf(line[0]);
  vpPoint second = pointOf(line[1]);
  added->setCameraParameters(m_cam);
  added->buildFrom(first, second, random_);
  added->addPolygon(addPolygon(line));
  added->setMovingEdge(&EdgeTrackerMembers::movingEdgeOf(tracker));
  added->hiddenface = &getFaces();
  added->useScanLine = scan_lines;
  clip(added->getPolygon());
  std::list<vpMbtDistanceLine*>& lines = EdgeTrackerMembers::linesOf(tracker);
  added->setIndex(static_cast<unsigned int>(lines.size()));
  lines.push_back(added);
}

void ModelTracker::addFace(const std::array<VispPoint, 3>& face) { addPolygon(face); }

}  // namespace

struct VispTracker::Held {
  ModelTracker tracker;
  vpImage<unsigned char> image;
};

VispTracker::VispTracker(const VispModel& model, const VispTuning& tuning)
    : held_(std::make_unique<Held>()) {
  if (model.lines.empty()) throw std::runtime_error("no line is seen from the seed");
  vpMe sites;
  sites.setMaskSize(tuning.mask_px);
  sites.setMaskNumber(tuning.mask_count);
  sites.setRange(tuning.range_px);
  sites.setThreshold(tuning.threshold);
  sites.setMu1(tuning.mu1);
  sites.setMu2(tuning.mu2);
  sites.setSampleStep(tuning.sample_px);
  ModelTracker& tracker = held_->tracker;
  tracker.setTrackerType(vpMbGenericTracker::EDGE_TRACKER);
  tracker.setMovingEdge(sites);
  tracker.setAngleAppear(vpMath::rad(89.0));
  tracker.setAngleDisappear(vpMath::rad(90.0));
  tracker.setNearClippingDistance(0.01);
  tracker.setFarClippingDistance(100.0);
  tracker.setClipping(tracker.vpMbTracker::getClipping() | vpMbtPolygon::FOV_CLIPPING);
  tracker.setGoodMovingEdgesRatioThreshold(tuning.good_share);
  tracker.setProjectionErrorComputation(true);
  tracker.begin(model.lines.front());
  tracker.setScanLineVisibilityTest(tuning.scan_lines);
  tracker.getFaces().getMbScanLineRenderer().setDepthTreshold(tuning.depth_threshold);
  for (std::size_t i = 1; i < model.lines.size(); ++i)
    tracker.addLine(model.lines[i], tuning.scan_lines);
  for (const auto& face : model.faces) tracker.addFace(face);
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
