// SPDX-License-Identifier: Apache-2.0
#include "sessions/exchange/colmap_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/text/text_reading.h"

namespace boresight::sessions {
namespace {

constexpr double kPixelOrigin = 0.5;  ///< where COLMAP has the centre of the top-left pixel
constexpr std::size_t kMaxBytes = 256 * kMegabyte;

/// A coefficient that ours has no place for: it must be 0.
constexpr std::size_t kNone = 99;

/// A COLMAP model: how many focal lengths it has, and which of ours its further numbers are.
struct ColmapModel {
  const char* name;
  int focal_lengths;
  CameraModel model;
  std::vector<std::size_t> distortion;
};

const std::vector<ColmapModel>& colmapModels() {
  static const std::vector<ColmapModel> models = {
      {"PINHOLE", 2, CameraModel::kPinhole, {}},
      {"OPENCV", 2, CameraModel::kBrownConrady, {0, 1, 2, 3}},
      {"FULL_OPENCV", 2, CameraModel::kBrownConrady, {0, 1, 2, 3, 4, 5, 6, 7}},
      {"OPENCV_FISHEYE", 2, CameraModel::kKannalaBrandt, {0, 1, 2, 3}},
      {"SIMPLE_PINHOLE", 1, CameraModel::kPinhole, {}},
      {"SIMPLE_RADIAL", 1, CameraModel::kBrownConrady, {0}},
      {"RADIAL", 1, CameraModel::kBrownConrady, {0, 1}},
      {"SIMPLE_FISHEYE", 1, CameraModel::kKannalaBrandt, {}},
      {"FISHEYE", 2, CameraModel::kKannalaBrandt, {}},
      {"SIMPLE_RADIAL_FISHEYE", 1, CameraModel::kKannalaBrandt, {0}},
      {"RADIAL_FISHEYE", 1, CameraModel::kKannalaBrandt, {0, 1}},
      {"THIN_PRISM_FISHEYE",
       2,
       CameraModel::kKannalaBrandt,
       {0, 1, kNone, kNone, 2, 3, kNone, kNone}}};
  return models;
}

constexpr const char* kWhatToDo =
    "; undistort the images with COLMAP's image_undistorter and read its model";

/// The camera's model must satisfy `hasColmapModel`.
const ColmapModel& modelFor(const Camera& camera) {
  if (camera.model == CameraModel::kPinhole) return colmapModels()[0];
  if (camera.model == CameraModel::kKannalaBrandt) return colmapModels()[3];
  const bool short_form = std::all_of(camera.distortion.begin() + 4, camera.distortion.end(),
                                      [](double value) { return value == 0.0; });
  return colmapModels()[short_form ? 1 : 2];
}

std::string cameraLine(int id, const Camera& camera) {
  const ColmapModel& model = modelFor(camera);
  std::string line =
      std::to_string(id) + " " + model.name + " " + std::to_string(camera.width) + " " +
      std::to_string(camera.height) + " " +
      numbersText({camera.fx, camera.fy, camera.cx + kPixelOrigin, camera.cy + kPixelOrigin});
  for (const std::size_t i : model.distortion) line += " " + numberText(camera.distortion[i]);
  return line + "\n";
}

/// The points of all images, numbered from 1 in the order in which they are met.
class ColmapPoints {
 public:
  /// The second line of an image: pixel and number of each of its points.
  std::string lineOf(const PosedImage& image) {
    std::string line;
    for (std::size_t i = 0; i < image.points.size(); ++i) {
      const SeenPoint& seen = image.points[i];
      line += (i > 0 ? " " : "") +
              numbersText({seen.pixel.x() + kPixelOrigin, seen.pixel.y() + kPixelOrigin}) + " " +
              std::to_string(note(image, seen, i));
    }
    return line + "\n";
  }

  /// points3D.txt: place, gray, mean distance from where the poses have the point (px), images.
  std::string text() const {
    std::string text = "# POINT3D_ID X Y Z R G B ERROR, then IMAGE_ID POINT2D_IDX of its images\n";
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Point& point = points_[i];
      text += std::to_string(i + 1) + " " + numbersText(point.place_m) + " 128 128 128 " +
              numberText(point.distances_px / point.images) + point.track + "\n";
    }
    return text;
  }

 private:
  struct Point {
    std::array<double, 3> place_m;
    double distances_px = 0.0;  ///< sum over the images
    int images = 0;
    std::string track;
  };

  std::size_t note(const PosedImage& image, const SeenPoint& seen, std::size_t index) {
    const std::array<double, 3> place = {seen.point_in_station_m.x(), seen.point_in_station_m.y(),
                                         seen.point_in_station_m.z()};
    const auto [found, is_new] = numbers_.emplace(place, points_.size() + 1);
    if (is_new) points_.push_back({place, 0.0, 0, ""});
    Point& point = points_[found->second - 1];
    Eigen::Vector2d projected;
    if (project(image.camera, image.camera_from_station * seen.point_in_station_m, projected))
      point.distances_px += (projected - seen.pixel).norm();
    ++point.images;
    point.track += " " + std::to_string(image.id) + " " + std::to_string(index);
    return found->second;
  }

  std::map<std::array<double, 3>, std::size_t> numbers_;
  std::vector<Point> points_;
};

std::string imageLine(const PosedImage& image, int camera_id) {
  const Eigen::Quaterniond& q = image.camera_from_station.rotation;
  const Eigen::Vector3d& t = image.camera_from_station.translation_m;
  return std::to_string(image.id) + " " +
         numbersText({q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()}) + " " +
         std::to_string(camera_id) + " " + image.name + "\n";
}

/// Reads the words of a line; errors name its number.
class Line {
 public:
  Line(const std::filesystem::path& file, const TextLines& lines)
      : file_(file), number_(lines.number()), rest_(lines.line()) {}

  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(file_, "line " + std::to_string(number_), reason);
  }

  bool atEnd() const { return rest_.find_first_not_of(kTextBlanks) == std::string_view::npos; }

  std::string_view word(const std::string& what) {
    const std::string_view text = takeWord(rest_);
    if (text.empty()) fail(what + " is missing");
    return text;
  }

  double number(const std::string& what) {
    const std::string_view text = word(what);
    const auto value = realIn(text);
    if (!value) fail(what + ": " + noNumberText(text));
    if (!std::isfinite(*value)) fail(what + ": " + shortWord(text) + " is too large");
    return *value;
  }

  int integer(const std::string& what, int minimum, int maximum) {
    const double value = number(what);
    if (value != std::floor(value) || value < minimum || value > maximum)
      fail(what + " must be a whole number, " + std::to_string(minimum) + " .. " +
           std::to_string(maximum));
    return static_cast<int>(value);
  }

  std::string rest(const char* what) {
    const std::string_view text = trimmed(rest_);
    if (text.empty()) fail(std::string(what) + " is missing");
    return std::string(text);
  }

  void end() {
    if (const std::string_view more = takeWord(rest_); !more.empty())
      fail("has extra values: '" + shortWord(more) + "'");
  }

 private:
  const std::filesystem::path& file_;
  std::int64_t number_;
  std::string_view rest_;
};

/// A file of the model. InputError when its last line has no end, as COLMAP writes one: the last
/// number or name may be cut.
class ModelText {
 public:
  explicit ModelText(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::exists(file, error) &&
        std::filesystem::exists(std::filesystem::path(file).replace_extension(".bin"), error))
      throw InputError(file,
                       "no such file, but the binary one: convert the model to text with colmap "
                       "model_converter --output_type TXT");
    bytes_ = readFileBytes(file, kMaxBytes);
    text_ = textOf(file, asText(bytes_));
    if (!endsItsLine(text_)) throw InputError(file, kOpenEnd);
  }
  TextLines lines() const { return TextLines(text_); }

 private:
  std::vector<std::uint8_t> bytes_;
  std::string_view text_;
};

bool isCommentOrBlank(std::string_view line) {
  return line.starts_with('#') || trimmed(line).empty();
}

/// InputError when COLMAP's comment, such as "# Number of images: 6, ...", states another number.
void requireStated(const std::filesystem::path& file, const ModelText& model,
                   const std::string& item, std::size_t found) {
  const std::string begin = "# Number of " + item + "s: ";
  for (TextLines lines = model.lines(); lines.next();) {
    if (!lines.line().starts_with(begin)) continue;
    const std::string_view text = lines.line().substr(begin.size());
    const auto stated = numberIn<std::size_t>(trimmed(text.substr(0, text.find(','))));
    if (stated && *stated != found)
      throw InputError(file, "states " + countText(static_cast<std::int64_t>(*stated), item) +
                                 ", but has " + std::to_string(found) +
                                 ": it may be truncated, or its comment is outdated");
  }
}

/// Whether the line is one of an image: behind its id is a quaternion.
bool isImageLine(std::string_view line) {
  if (!wholeIn<std::int64_t>(takeWord(line))) return false;
  Eigen::Vector4d rotation;
  for (double& part : rotation) {
    const auto value = realIn(takeWord(line));
    if (!value) return false;
    part = *value;
  }
  return std::abs(rotation.norm() - 1.0) < 1e-3 && !trimmed(line).empty();
}

/// Refuses a line behind an image's that is not its points: the next image in it would be lost.
void requirePoints(const std::filesystem::path& file, const TextLines& lines) {
  Line line(file, lines);
  if (lines.line().starts_with('#') || isImageLine(lines.line()))
    line.fail(
        "is no list of points (x y id), which follows each image: write an empty line for an "
        "image without points");
  for (int point = 1; !line.atEnd(); ++point) {
    const std::string of_point = " of point " + std::to_string(point);
    (void)line.number("x" + of_point);
    (void)line.number("y" + of_point);
    const std::string_view id = line.word("the id" + of_point);
    if (!wholeIn<std::int64_t>(id))
      line.fail("the id" + of_point + ": '" + shortWord(id) + "' is not a whole number");
  }
}

Camera readCameraLine(Line& line) {
  const std::string name(line.word("the camera's model"));
  const auto model = std::ranges::find(colmapModels(), name, &ColmapModel::name);
  if (model == colmapModels().end()) line.fail("no camera model matches " + name + kWhatToDo);
  Camera camera;
  camera.model = model->model;
  camera.width = line.integer("the width", 1, kMaxImageSide_px);
  camera.height = line.integer("the height", 1, kMaxImageSide_px);
  camera.fx = line.number("the focal length");
  camera.fy = model->focal_lengths == 2 ? line.number("the second focal length") : camera.fx;
  camera.cx = line.number("cx") - kPixelOrigin;
  camera.cy = line.number("cy") - kPixelOrigin;
  for (const std::size_t i : model->distortion) {
    const double value = line.number("a coefficient");
    if (i == kNone && value != 0.0)
      line.fail("no camera model matches " + name + " with tangential or thin-prism terms" +
                kWhatToDo);
    if (i != kNone) camera.distortion[i] = value;
  }
  line.end();
  if (prepareCamera(camera) != Status::kOk) line.fail("the parameters are not those of a camera");
  return camera;
}

std::map<int, Camera> readCameras(const std::filesystem::path& file) {
  std::map<int, Camera> cameras;
  const ModelText model(file);
  for (TextLines lines = model.lines(); lines.next();) {
    if (isCommentOrBlank(lines.line())) continue;
    Line line(file, lines);
    const int id = line.integer("the camera's id", 0, 1 << 30);
    if (!cameras.emplace(id, readCameraLine(line)).second)
      line.fail("camera " + std::to_string(id) + " is given twice");
  }
  requireStated(file, model, "camera", cameras.size());
  return cameras;
}

PosedImage readImageLine(Line& line, const std::map<int, Camera>& cameras) {
  PosedImage image;
  image.id = line.integer("the image's id", 0, 1 << 30);
  Eigen::Quaterniond& q = image.camera_from_station.rotation;
  q.w() = line.number("QW");
  q.x() = line.number("QX");
  q.y() = line.number("QY");
  q.z() = line.number("QZ");
  if (std::abs(q.norm() - 1.0) > 1e-4) line.fail("the quaternion has not the length 1");
  // One that has it to the last bits stays what it is.
  if (std::abs(q.norm() - 1.0) > 1e-12) q.normalize();
  for (int i = 0; i < 3; ++i)
    image.camera_from_station.translation_m[i] = line.number("the translation");
  const int camera = line.integer("the camera's id", 0, 1 << 30);
  const auto found = cameras.find(camera);
  if (found == cameras.end()) line.fail("there is no camera " + std::to_string(camera));
  image.camera = found->second;
  image.name = line.rest("the image's name");
  return image;
}

}  // namespace

bool hasColmapModel(CameraModel model) {
  return std::ranges::find(colmapModels(), model, &ColmapModel::model) != colmapModels().end();
}

void writeColmapText(const std::filesystem::path& folder, std::span<const PosedImage> images) {
  std::vector<Camera> cameras;
  std::set<int> ids;
  ColmapPoints points;
  std::string image_text = "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then its points\n";
  for (const PosedImage& image : images)
    if (!image.remark.empty())
      image_text += "# " + oneLine(image.name + ": " + image.remark) + "\n";
  for (const PosedImage& image : images) {
    const bool named = !image.name.empty() && image.name.find_first_of("\r\n") == std::string::npos;
    if (image.id < 1 || !ids.insert(image.id).second || !named)
      throw OutputError(folder / "images.txt", "image " + std::to_string(image.id) + " '" +
                                                   image.name +
                                                   "' needs a unique id and a unique name");
    if (!hasColmapModel(image.camera.model))
      throw OutputError(folder / "cameras.txt",
                        "image " + std::to_string(image.id) + " '" + image.name + "' has a " +
                            cameraModelName(image.camera.model) +
                            " camera, which the format does not know; undistort the image, the "
                            "pose stays");
    auto at = std::find(cameras.begin(), cameras.end(), image.camera);
    if (at == cameras.end()) at = cameras.insert(cameras.end(), image.camera);
    image_text += imageLine(image, static_cast<int>(at - cameras.begin()) + 1);
    image_text += points.lineOf(image);
  }
  std::string camera_text = "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS\n";
  for (std::size_t i = 0; i < cameras.size(); ++i)
    camera_text += cameraLine(static_cast<int>(i) + 1, cameras[i]);
  writeFileAtomically(folder / "cameras.txt", camera_text);
  writeFileAtomically(folder / "images.txt", image_text);
  writeFileAtomically(folder / "points3D.txt", points.text());
}

std::vector<PosedImage> readColmapText(const std::filesystem::path& folder) {
  const std::map<int, Camera> cameras = readCameras(folder / "cameras.txt");
  const std::filesystem::path file = folder / "images.txt";
  const ModelText model(file);
  std::vector<PosedImage> images;
  std::set<int> ids;
  for (TextLines lines = model.lines(); lines.next();) {
    if (isCommentOrBlank(lines.line())) continue;
    Line line(file, lines);
    images.push_back(readImageLine(line, cameras));
    if (!ids.insert(images.back().id).second)
      line.fail("image " + std::to_string(images.back().id) + " is given twice");
    if (lines.next()) requirePoints(file, lines);
  }
  requireStated(file, model, "image", images.size());
  return images;
}

}  // namespace boresight::sessions
