// SPDX-License-Identifier: Apache-2.0
#include "sessions/exchange/colmap_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_reader.h"

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
  Line(const std::filesystem::path& file, int number, const std::string& text)
      : file_(file), number_(number), words_(text) {}

  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(file_, "line " + std::to_string(number_), reason);
  }

  std::string word(const char* what) {
    std::string text;
    if (!(words_ >> text)) fail(std::string(what) + " is missing");
    return text;
  }

  double number(const char* what) {
    const std::string text = word(what);
    const auto value = numberIn<double>(text);
    if (!value || !std::isfinite(*value))
      fail(std::string(what) + ": '" + text + "' is not a number");
    return *value;
  }

  int integer(const char* what, int minimum, int maximum) {
    const double value = number(what);
    if (value != std::floor(value) || value < minimum || value > maximum)
      fail(std::string(what) + " must be a whole number, " + std::to_string(minimum) + " .. " +
           std::to_string(maximum));
    return static_cast<int>(value);
  }

  std::string rest(const char* what) {
    std::string text;
    std::getline(words_ >> std::ws, text);
    while (!text.empty() && (text.back() == '\r' || text.back() == ' ')) text.pop_back();
    if (text.empty()) fail(std::string(what) + " is missing");
    return text;
  }

  void end() {
    std::string more;
    if (words_ >> more) fail("has extra values: '" + more + "'");
  }

 private:
  const std::filesystem::path& file_;
  int number_;
  std::istringstream words_;
};

std::vector<std::string> linesOf(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error) &&
      std::filesystem::exists(std::filesystem::path(file).replace_extension(".bin"), error))
    throw InputError(file,
                     "no such file, but the binary one: convert the model to text with colmap "
                     "model_converter --output_type TXT");
  const std::vector<std::uint8_t> bytes = readFileBytes(file, kMaxBytes);
  std::istringstream stream{std::string(unmarkedText(file, bytes))};
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

bool isCommentOrBlank(const std::string& line) {
  return line.starts_with('#') || line.find_first_not_of(" \t\r") == std::string::npos;
}

/// InputError when COLMAP's comment, such as "# Number of images: 6, ...", states another number.
void requireStated(const std::filesystem::path& file, const std::vector<std::string>& lines,
                   const std::string& item, std::size_t found) {
  const std::string begin = "# Number of " + item + "s: ";
  for (const std::string& line : lines) {
    if (!line.starts_with(begin)) continue;
    const std::string text =
        line.substr(begin.size(), line.find_first_of(", \r", begin.size()) - begin.size());
    const auto stated = numberIn<std::size_t>(text);
    if (stated && *stated != found)
      throw InputError(file, "states " + countText(static_cast<std::int64_t>(*stated), item) +
                                 ", but has " + std::to_string(found) +
                                 ": it may be truncated, or its comment is outdated");
  }
}

/// Refuses a line behind an image's that is not its points: the next image in it would be lost.
void requirePoints(const std::filesystem::path& file, int number, const std::string& text) {
  std::istringstream words(text);
  std::string x;
  std::string y;
  std::string point;
  while (words >> x) {
    const bool whole = words >> y >> point && numberIn<double>(x) && numberIn<double>(y) &&
                       numberIn<std::int64_t>(point);
    if (!whole)
      throw InputError(file, "line " + std::to_string(number),
                       "is not a list of points (x y id): write an empty line after each image "
                       "without points");
  }
}

Camera readCameraLine(Line& line) {
  const std::string name = line.word("the camera's model");
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
  const std::vector<std::string> lines = linesOf(file);
  int number = 0;
  for (const std::string& text : lines) {
    ++number;
    if (isCommentOrBlank(text)) continue;
    Line line(file, number, text);
    const int id = line.integer("the camera's id", 0, 1 << 30);
    if (!cameras.emplace(id, readCameraLine(line)).second)
      line.fail("camera " + std::to_string(id) + " is given twice");
  }
  requireStated(file, lines, "camera", cameras.size());
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
  const std::vector<std::string> lines = linesOf(file);
  std::vector<PosedImage> images;
  std::set<int> ids;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (isCommentOrBlank(lines[i])) continue;
    Line line(file, static_cast<int>(i) + 1, lines[i]);
    images.push_back(readImageLine(line, cameras));
    if (!ids.insert(images.back().id).second)
      line.fail("image " + std::to_string(images.back().id) + " is given twice");
    if (++i < lines.size()) requirePoints(file, static_cast<int>(i) + 1, lines[i]);
  }
  requireStated(file, lines, "image", images.size());
  return images;
}

}  // namespace boresight::sessions
