// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/input_sheet.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <Eigen/Geometry>

#include "core/base/math.h"
#include "sessions/decision/check_limits.h"
#include "sessions/evaluation/pose_error.h"
#include "sessions/io/cameras/camera_field.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/run/image_quality.h"
#include "sessions/run/problem.h"
#include "sessions/session/input_check.h"
#include "sessions/session/named_poses.h"
#include "sessions/session/stated_inputs.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"
#include "sessions/text/units.h"

namespace boresight::sessions {
namespace {

/// A station smaller than this in the image cannot be matched.
constexpr double kSmallestStation_px = 24.0;

/// Angle between the rays of two pixels, deg; not finite where one has no ray.
double angleBetween_deg(const Camera& camera, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  Eigen::Vector3d ray_a, ray_b;
  if (!unproject(camera, a, ray_a) || !unproject(camera, b, ray_b)) return std::nan("");
  return std::acos(std::clamp(ray_a.normalized().dot(ray_b.normalized()), -1.0, 1.0)) / kDegree_rad;
}

void flagCamera(const Camera& camera, CameraSheet& sheet) {
  const double right = camera.width - 1;
  const double bottom = camera.height - 1;
  const double off_centre = std::max(std::abs(camera.cx - 0.5 * right) / camera.width,
                                     std::abs(camera.cy - 0.5 * bottom) / camera.height);
  if (off_centre > 0.1)
    sheet.flags.push_back(
        {"camera_off_centre", "the principal point is " + fixedText(100.0 * off_centre, 0) +
                                  " % of the image off its middle: check whether the camera is for "
                                  "a sub-frame or another image size"});
  const double aspect = camera.fx / std::abs(camera.fy);
  if (aspect > 1.02 || 1.0 / aspect > 1.02)
    sheet.flags.push_back(
        {"camera_aspect",
         "fx and fy differ by " + fixedText(100.0 * std::abs(aspect - 1.0), 1) + " %"});
  constexpr double kWidestLens_deg = 130.0;
  const bool fisheye =
      camera.model == CameraModel::kKannalaBrandt || camera.model == CameraModel::kCahvore;
  if (const double wide_deg = std::max(sheet.field_of_view_x_deg, sheet.field_of_view_y_deg);
      !fisheye && wide_deg > kWidestLens_deg)
    sheet.flags.push_back({"camera_wide", "a field of view of " + fixedText(wide_deg, 0) +
                                              " deg: check that fx and fy are in pixels"});
  Eigen::Vector3d ray;
  for (const double x : {0.0, right})
    for (const double y : {0.0, bottom}) {
      if (unproject(camera, {x, y}, ray)) continue;
      const std::string concern = fieldConcern(camera);
      sheet.flags.push_back(
          {"camera_corners",
           concern.empty() ? "a corner of the image lies outside the valid field of the distortion"
                           : concern});
      return;
    }
}

/// Sums of absolute differences of pixels one and two apart.
struct Differences {
  double next = 0.0;
  double second = 0.0;

  /// Noise alone makes both alike; a margin keeps it from counting.
  bool alternate() const { return next > 1.25 * second && next > 0.0; }
};

void flagSeed(const SessionCase& session_case, const SceneMesh& scene, InputSheet& sheet) {
  const BoundingBox bounds = matchedBounds(scene.view());
  const Pose& seed = session_case.camera_from_station_seed;
  const std::string scale = scaleConcern(bounds, seed);
  if (!scale.empty()) sheet.flags.push_back({"mesh_scale", scale + ": check the mesh's unit"});
  const std::string concern = seedConcern(session_case.camera, scene.view(), seed);
  if (!concern.empty()) {
    const bool behind = concern.find("behind") != std::string::npos;
    sheet.flags.push_back({behind ? "station_behind_camera" : "station_out_of_view", concern});
  }
  const Eigen::Vector3d camera_in_station_m = seed.inverse().translation_m;
  const Eigen::AlignedBox3d box_m(bounds.minimum_m, bounds.maximum_m);
  if (box_m.contains(camera_in_station_m) && isInside(scene.view(), camera_in_station_m))
    sheet.flags.push_back({"camera_in_station",
                           "the seed places the camera inside the station: check the mesh's unit, "
                           "and that the seed is camera_from_station"});
  const double size_px =
      bounds.diagonal() / (seed * bounds.centre()).norm() * session_case.camera.fx;
  if (size_px < kSmallestStation_px)
    sheet.flags.push_back(
        {"station_small", "the station would be only " + fixedText(size_px, 1) +
                              " px large in the image at the seed: check the mesh's unit"});
}

/// Beyond these figures a pose is hardly ever found (resources/evidence/trust.md).
void flagQuality(const std::optional<ImageQuality>& quality, InputSheet& sheet) {
  if (!quality) return;  // seedConcern says why
  const CheckLimits limits;
  const auto flag = [&sheet](const char* code, const std::string& found, const char* remedy) {
    sheet.flags.push_back({code, "at the seed's position of the station " + found + ": " + remedy});
  };
  if (quality->edge_width_px > limits.edge_width_px)
    flag("image_blurred", "edges are " + fixedText(quality->edge_width_px, 1) + " px wide",
         "use a sharper image (motion or focus)");
  if (100.0 * quality->saturated_share > limits.saturated_percent)
    flag("image_overexposed",
         fixedText(100.0 * quality->saturated_share, 0) + " % of the pixels are saturated",
         "use an image with less exposure");
  if (quality->range_gray < limits.range_gray)
    flag("image_flat", "pixels span " + fixedText(quality->range_gray, 0) + " gray levels",
         "use an image with more exposure, or state the bit depth");
}

void describe(const LoadedCase& loaded, const ImageSheet& image_sheet, const CameraSheet& camera,
              const std::optional<ImageQuality>& quality, InputSheet& sheet) {
  const SessionCase& session_case = loaded.source;
  const GrayImage& image = loaded.image;
  const BoundingBox bounds = matchedBounds(loaded.scene.view());
  const Eigen::Vector3d extent_mm = kMillimetres * (bounds.maximum_m - bounds.minimum_m);
  const std::string size = fixedText(extent_mm.x(), 1) + " x " + fixedText(extent_mm.y(), 1) +
                           " x " + fixedText(extent_mm.z(), 1) + " mm";
  const double seed_distance_m = (session_case.camera_from_station_seed * bounds.centre()).norm();
  const double view_width_mm =
      kMillimetres * seed_distance_m * session_case.camera.width / session_case.camera.fx;
  const auto add = [&sheet](const char* label, const std::string& value) {
    sheet.lines.push_back({label, value});
  };
  add("image", image.container + ", " + sizeText(image.width, image.height) + " px, " +
                   std::to_string(image.channels) + " channels, " +
                   std::to_string(image.sample_bits) +
                   " bit; the centre of the top-left pixel is (0, 0)");
  if (image.label)
    for (const SheetLine& line : labelLines(*image.label)) sheet.lines.push_back(line);
  add("to 8 bit", image.rule);
  add("gray", std::to_string(image_sheet.lowest_gray) + " .. " +
                  std::to_string(image_sheet.highest_gray) + ", " +
                  fixedText(100.0 * image_sheet.saturated_share, 2) + " % saturated");
  add("image at the seed", imageQualityText(quality));
  add("camera", std::string(cameraModelName(session_case.camera.model)) + ", " +
                    sizeText(session_case.camera.width, session_case.camera.height) + " px");
  for (const LabelItem& line : frameLines(session_case)) add(line.name.c_str(), line.value);
  add("field of view", fixedText(camera.field_of_view_x_deg, 2) + " x " +
                           fixedText(camera.field_of_view_y_deg, 2) + " deg");
  for (const MeshInfo& info : loaded.scene.infos)
    add("mesh", info.file.filename().string() + ", " + info.format + " in " + info.unit + ", " +
                    fixedText(info.diagonal_m() * 1e3, 1) + " mm across");
  for (const PartSource& part : partsOf(session_case)) add("part", partText(part));
  add("symmetries", symmetriesText(session_case.symmetries));
  const InputSigmas sigmas(session_case);
  add("scale, one sigma", meshScaleText(sigmas));
  add("calibration, one sigma",
      calibrationText(sigmas) + ": of the focal length and of the principal point");
  if (session_case.has_seed) {
    add("station",
        size + "; the view is " + fixedText(view_width_mm, 1) + " mm wide at its distance");
    add("seed", fixedText(seed_distance_m, 4) + " m from the camera to the station's middle");
  } else {
    add("station", size);
    add("seed", "none");
  }
  if (const std::string source = truthSourceText(session_case); !source.empty())
    add("truth", source);
  if (loaded.ignore)
    add("ignored", std::to_string(loaded.ignore->ignored_count) + " px, " +
                       percentText(static_cast<double>(loaded.ignore->ignored_count) /
                                       (static_cast<double>(image.width) * image.height),
                                   2) +
                       " of the image");
}

/// Of a truth that was measured, against the case's own requirement or that of the first preset.
void flagTruth(const SessionCase& session_case, InputSheet& sheet) {
  if (session_case.camera_from_station_truth && judgingTruth(session_case) == nullptr)
    sheet.flags.push_back({"truth_of_run", "the truth is " + truthSourceText(session_case) +
                                               ": it does not judge a result"});
  if (judgingTruth(session_case) == nullptr || !session_case.truth_covariance) return;
  const std::string excess =
      sigmaExcessText(*session_case.truth_covariance, session_case.camera_from_end_effector,
                      session_case.requirement.value_or(checkPresets().front().requirement));
  if (!excess.empty())
    sheet.flags.push_back({"truth_uncertain", "one sigma of the truth is " + excess +
                                                  ": too large to judge a result; annotate more "
                                                  "points, spread over the station"});
}

std::string subframeText(const ImageLabel& label) {
  if (!label.subframe) return "not stated";
  const LabelSubframe& part = *label.subframe;
  const std::string averaged = part.samples_per_pixel == 1.0 && part.lines_per_pixel == 1.0
                                   ? "not down-sampled"
                                   : "each pixel is " + fixedText(part.samples_per_pixel, 2) +
                                         " x " + fixedText(part.lines_per_pixel, 2) +
                                         " of the detector's";
  return "begins at sample " + std::to_string(part.first_sample) + ", line " +
         std::to_string(part.first_line) + " of the detector (from 0), " + averaged;
}

}  // namespace

CameraSheet cameraSheet(const Camera& camera) {
  CameraSheet sheet;
  const double right = camera.width - 1;
  const double bottom = camera.height - 1;
  sheet.field_of_view_x_deg = angleBetween_deg(camera, {0.0, camera.cy}, {right, camera.cy});
  sheet.field_of_view_y_deg = angleBetween_deg(camera, {camera.cx, 0.0}, {camera.cx, bottom});
  const double diagonal_deg = angleBetween_deg(camera, {0.0, 0.0}, {right, bottom});
  sheet.lines = {std::string(cameraModelName(camera.model)) + ", " +
                     sizeText(camera.width, camera.height) + " px, fx " + fixedText(camera.fx, 3) +
                     ", fy " + fixedText(camera.fy, 3) + ", cx " + fixedText(camera.cx, 3) +
                     ", cy " + fixedText(camera.cy, 3),
                 "field of view " + fixedText(sheet.field_of_view_x_deg, 2) + " x " +
                     fixedText(sheet.field_of_view_y_deg, 2) + " deg, diagonal " +
                     (std::isfinite(diagonal_deg) ? fixedText(diagonal_deg, 2) + " deg"
                                                  : "unknown, as a corner sees nothing") +
                     "; 1 px is " + fixedText(1000.0 / camera.fx, 3) + " mm at 1 m"};
  flagCamera(camera, sheet);
  return sheet;
}

bool looksLikeMosaic(const ImageView& image) {
  Differences along_rows, along_columns;
  for (int y = 0; y + 2 < image.height; ++y)
    for (int x = 0; x + 2 < image.width; ++x) {
      const int current = image.at(x, y);
      along_rows.next += std::abs(current - image.at(x + 1, y));
      along_rows.second += std::abs(current - image.at(x + 2, y));
      along_columns.next += std::abs(current - image.at(x, y + 1));
      along_columns.second += std::abs(current - image.at(x, y + 2));
    }
  return along_rows.alternate() && along_columns.alternate();
}

std::vector<SheetLine> labelLines(const ImageLabel& label) {
  std::vector<SheetLine> lines{{"label", label.format}};
  for (const LabelItem& item : label.identifiers) lines.push_back({item.name, item.value});
  lines.push_back(
      {"label's camera", label.camera ? std::string(cameraModelName(label.camera->camera.model)) +
                                            " in " + frameText(label.camera->reference->frame)
                                      : label.camera_remark});
  lines.push_back({"sub-frame", subframeText(label)});
  lines.push_back({"pixel origin",
                   "the centre of the top-left pixel of the image is (0, 0); the "
                   "label counts lines and samples from 1"});
  if (label.bit_depth)
    lines.push_back({"bit depth", std::to_string(*label.bit_depth) + " bits by the label"});
  return lines;
}

ImageSheet imageSheet(const GrayImage& image) {
  ImageSheet sheet;
  const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
  sheet.lowest_gray = *low;
  sheet.highest_gray = *high;
  sheet.saturated_share =
      static_cast<double>(std::count(image.pixels.begin(), image.pixels.end(), 255)) /
      static_cast<double>(image.pixels.size());
  if (sheet.saturated_share > 0.02)
    sheet.flags.push_back(
        {"image_saturated", fixedText(100.0 * sheet.saturated_share, 1) +
                                " % of the image is saturated: edges are lost there; ignore "
                                "those pixels, or expose less"});
  if (*high - *low < 64)
    sheet.flags.push_back(
        {"image_few_grays", "the image uses few gray levels: check its bit depth"});
  for (const std::string& note : image.notes) sheet.flags.push_back({"image_note", note});
  if (image.sample_bits > 8 && !image.bit_depth_stated && !image.bit_depth_of_label)
    sheet.flags.push_back(
        {"image_bit_depth",
         "the samples have 16 bits, but the used bits are not stated: state the bit depth"});
  if (looksLikeMosaic(image.view()))
    sheet.flags.push_back({"image_mosaic",
                           "the pixels look like a Bayer mosaic: state its pattern (whs new "
                           "--bayer), or convert to gray before matching"});
  return sheet;
}

InputSheet inputSheet(const LoadedCase& loaded) {
  InputSheet sheet;
  const SessionCase& session_case = loaded.source;
  const GrayImage& image = loaded.image;
  const ImageSheet image_sheet = imageSheet(image);
  const CameraSheet camera = cameraSheet(session_case.camera);
  std::optional<ImageQuality> quality;
  if (session_case.has_seed)
    quality = measureImageQuality(image.view(), loaded.ignore ? &loaded.ignore_bits : nullptr,
                                  stationRegion(session_case.camera, loaded.scene.view(),
                                                session_case.camera_from_station_seed));
  describe(loaded, image_sheet, camera, quality, sheet);
  sheet.flags = image_sheet.flags;
  flagQuality(quality, sheet);
  if (image.width != session_case.camera.width || image.height != session_case.camera.height)
    sheet.flags.push_back(
        {"camera_size", "the camera is of " +
                            sizeText(session_case.camera.width, session_case.camera.height) +
                            " px, but the image has " + sizeText(image.width, image.height)});
  sheet.flags.insert(sheet.flags.end(), camera.flags.begin(), camera.flags.end());
  for (const std::string& note : fileNotes(loaded.scene)) sheet.flags.push_back({"mesh", note});
  if (session_case.has_seed) flagSeed(session_case, loaded.scene, sheet);
  if (image.label) flagLabel(session_case, *image.label, sheet.flags);
  flagTruth(session_case, sheet);
  return sheet;
}

std::vector<std::string> fileNotes(const LoadedCase& loaded) {
  std::vector<std::string> all;
  const std::string image = loaded.source.image.source.file.filename().string();
  for (const std::string& note : loaded.image.notes) all.push_back(image + ": " + note);
  std::ranges::move(fileNotes(loaded.scene), std::back_inserter(all));
  return all;
}

std::vector<std::string> fileNotes(const SceneMesh& scene) {
  std::vector<std::string> all;
  for (const MeshInfo& info : scene.infos)
    for (const std::string& note : info.notes())
      all.push_back(info.file.filename().string() + ": " + note);
  return all;
}

bool isInside(const MeshView& mesh, const Eigen::Vector3d& point_in_station_m) {
  double winding_rad = 0.0;  // sum of half solid angles (Van Oosterom and Strackee 1983)
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (!mesh.parts[mesh.part_of_face[f]].match) continue;
    Eigen::Vector3d corner[3];
    for (std::size_t i = 0; i < 3; ++i)
      corner[i] = mesh.vertices_in_station_m[static_cast<std::size_t>(mesh.faces[f].vertex[i])]
                      .cast<double>() -
                  point_in_station_m;
    const double a = corner[0].norm(), b = corner[1].norm(), c = corner[2].norm();
    winding_rad += std::atan2(corner[0].dot(corner[1].cross(corner[2])),
                              a * b * c + corner[0].dot(corner[1]) * c +
                                  corner[1].dot(corner[2]) * a + corner[2].dot(corner[0]) * b);
  }
  return std::abs(winding_rad) > kPi;  // 2 pi inside, 0 outside of a closed surface
}

}  // namespace boresight::sessions
