// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/cahvor_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include "sessions/io/cameras/pose_file.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/text/text_reading.h"

namespace boresight::sessions {
namespace {

constexpr std::size_t kMaxBytes = 1 << 20;

/// The text after each key; a line without a key continues the one before.
class Entries {
 public:
  explicit Entries(const std::filesystem::path& file) : file_(file) {
    const auto bytes = readFileBytes(file, kMaxBytes);
    const std::string_view whole = textOf(file, asText(bytes));
    std::string key;
    for (TextLines lines(whole); lines.next();) {
      const std::string_view text = trimmed(lines.line().substr(0, lines.line().find('#')));
      if (text.empty()) continue;
      const auto equals = text.find('=');
      if (equals == std::string_view::npos && key.empty())
        throw InputError(file, "not a camera file: it begins with '" + shortWord(text) +
                                   "' instead of Model = ...");
      if (equals == std::string_view::npos) {
        values_[key] += " " + std::string(text);
        continue;
      }
      key = trimmedVisible(text.substr(0, equals));
      if (!values_.emplace(key, trimmed(text.substr(equals + 1))).second)
        throw InputError(file, key, "is given twice");
    }
    // The last number of a file that is cut may be one of fewer digits.
    if (!endsItsLine(whole)) throw InputError(file, kOpenEnd);
  }

  bool has(const std::string& key) const { return values_.contains(key); }
  const std::string& text(const std::string& key) const {
    const auto found = values_.find(key);
    if (found == values_.end()) throw InputError(file_, key, "is missing");
    return found->second;
  }
  /// Exactly `count` finite numbers.
  std::vector<double> numbers(const std::string& key, std::size_t count) const {
    std::string_view rest = text(key);
    std::vector<double> found;
    for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
      const auto value = realIn(word);
      if (!value) throw InputError(file_, key, noNumberText(word));
      if (!(std::abs(*value) <= 1e18))
        throw InputError(file_, key, shortWord(word) + " is beyond 1e18");
      found.push_back(*value);
    }
    if (found.size() != count)
      throw InputError(file_, key,
                       std::to_string(count) + " numbers are needed, " +
                           std::to_string(found.size()) + " given");
    return found;
  }
  Eigen::Vector3d vector(const std::string& key) const {
    const std::vector<double> found = numbers(key, 3);
    return {found[0], found[1], found[2]};
  }
  /// A covariance, or nothing.
  Eigen::MatrixXd square(const std::string& key, int size) const {
    if (!has(key)) return {};
    const auto count = static_cast<std::size_t>(size);
    const std::vector<double> found = numbers(key, count * count);
    const Eigen::MatrixXd matrix =
        Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            found.data(), size, size);
    if (!isCovariance(matrix)) throw InputError(file_, key, "is " + std::string(kNoCovariance));
    return matrix;
  }
  const std::filesystem::path& file() const { return file_; }

 private:
  const std::filesystem::path& file_;
  std::map<std::string, std::string> values_;
};

/// "CAHV = ...", "CAHVOR = ...", "CAHVORE1 = ...", "CAHVORE3,0.37 = ..."
void readModel(const Entries& entries, CahvModel& cahv) {
  const std::string& text = entries.text("Model");
  const std::string name(trimmed(std::string_view(text).substr(0, text.find('='))));
  const auto refuse = [&] {
    throw InputError(
        entries.file(), "Model",
        "'" + oneLine(name) + "' is not known (CAHV, CAHVOR, CAHVORE1, CAHVORE2 or CAHVORE3,P)");
  };
  constexpr std::string_view kGeneral = "CAHVORE3,";
  if (name == "CAHV") {
    cahv.model = CameraModel::kCahv;
  } else if (name == "CAHVOR") {
    cahv.model = CameraModel::kCahvor;
  } else if (name == "CAHVORE1" || name == "CAHVORE2") {
    cahv.model = CameraModel::kCahvore;
    cahv.type = name.back() - '0';
  } else if (name.starts_with(kGeneral)) {
    const auto parameter = realIn(trimmed(std::string_view(name).substr(kGeneral.size())));
    if (!parameter || !std::isfinite(*parameter)) refuse();
    cahv.model = CameraModel::kCahvore;
    cahv.type = 3;
    cahv.parameter = *parameter;
  } else {
    refuse();
  }
}

std::string modelText(const CahvModel& cahv) {
  if (cahv.model == CameraModel::kCahv) return "CAHV = perspective, linear";
  if (cahv.model == CameraModel::kCahvor) return "CAHVOR = perspective, distortion";
  if (cahv.type == 1) return "CAHVORE1 = perspective, distortion, pupil";
  if (cahv.type == 2) return "CAHVORE2 = fish-eye";
  return "CAHVORE3," + numberText(cahv.parameter) + " = general";
}

std::string squareText(const char* key, const Eigen::MatrixXd& matrix) {
  if (matrix.size() == 0) return "";
  std::string text = std::string("\n") + key + " =\n";
  for (const auto& row : matrix.rowwise()) text += numbersText(row) + "\n";
  return text;
}

/// Scales, centres and the angle from V' to H' as A sees it: -90 deg when they are square.
std::string internalText(const CahvModel& cahv) {
  const double hc = cahv.a.dot(cahv.h_px);
  const double vc = cahv.a.dot(cahv.v_px);
  const Eigen::Vector3d h = cahv.h_px - hc * cahv.a;
  const Eigen::Vector3d v = cahv.v_px - vc * cahv.a;
  const double theta_rad = std::atan2(cahv.a.dot(v.cross(h)), v.dot(h));
  return "\nHs    = " + numberText(h.norm()) + "\nHc    = " + numberText(hc) +
         "\nVs    = " + numberText(v.norm()) + "\nVc    = " + numberText(vc) +
         "\nTheta = " + numberText(theta_rad) + "\n";
}

}  // namespace

bool isCahvorFile(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  return !extension.empty() && cahvModelOf(extension.substr(1)).has_value();
}

CahvorFile readCahvorFile(const std::filesystem::path& file) {
  const Entries entries(file);
  CahvorFile read;
  CahvModel& cahv = read.cahv;
  readModel(entries, cahv);
  const std::vector<double> size = entries.numbers("Dimensions", 2);
  if (!isImageSide(size[0]) || !isImageSide(size[1]))
    throw InputError(
        file, "Dimensions",
        "width and height must be whole numbers, 1 to " + std::to_string(kMaxImageSide_px));
  read.width = static_cast<int>(size[0]);
  read.height = static_cast<int>(size[1]);
  forVectors(
      cahv, [&entries](const char* key, Eigen::Vector3d& vector) { vector = entries.vector(key); });
  read.covariance = entries.square("S", vectorComponents(cahv.model));
  read.internal_covariance = entries.square("S internal", 5);
  return read;
}

CameraFile readCahvorCamera(const std::filesystem::path& file) {
  const CahvorFile read = readCahvorFile(file);
  std::optional<CameraFile> camera = cameraOfVectors(read.cahv, read.width, read.height);
  if (!camera) throw InputError(file, kVectorsCannotProject);
  if (!read.internal_covariance.isZero(0.0)) {
    const Eigen::VectorXd sigma = read.internal_covariance.diagonal().cwiseSqrt();
    const double focal =
        std::max(sigma(0) / std::abs(camera->camera.fx), sigma(2) / std::abs(camera->camera.fy));
    camera->calibration_sigma =
        StatedCalibration{std::min(focal, kMaxFocalSigma),
                          std::min(std::max(sigma(1), sigma(3)), kMaxPrincipalPointSigma_px)};
  }
  if (!read.covariance.isZero(0.0))
    camera->covariance = inFrame({read.covariance}, camera->reference->camera_from_reference);
  return *camera;
}

void writeCahvorFile(const std::filesystem::path& file, const CahvorFile& cahvor) {
  const CahvModel& cahv = cahvor.cahv;
  std::string text =
      "# camera model: vectors in metres and pixels, the centre of the top-left pixel "
      "is (0, 0)\n\nModel = " +
      modelText(cahv) + "\n\nDimensions = " + std::to_string(cahvor.width) + " " +
      std::to_string(cahvor.height) + "\n\n";
  forVectors(cahv, [&text](const char* key, const Eigen::Vector3d& vector) {
    text += std::string(key) + " = " + numbersText(vector) + "\n";
  });
  text += squareText("S", cahvor.covariance) + internalText(cahv) +
          squareText("S internal", cahvor.internal_covariance);
  writeFileAtomically(file, text);
}

}  // namespace boresight::sessions
