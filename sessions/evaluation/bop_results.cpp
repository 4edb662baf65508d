// SPDX-License-Identifier: Apache-2.0
#include "sessions/evaluation/bop_results.h"

#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include "sessions/io/atomic_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/json_reader.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHeader = "scene_id,im_id,obj_id,score,R,t,time";
constexpr double kMillimetres = 1000.0;
constexpr double kSameTime_s = 0.001;

void requireWritable(const fs::path& file, const BopResult& result,
                     std::map<std::pair<int, int>, double>& times) {
  const std::string image = "image " + std::to_string(result.image_id);
  if (result.scene_id < 0 || result.image_id < 0 || result.object_id < 0)
    throw OutputError(file, image + " has a negative id");
  if (!result.camera_from_station.isFinite() || !std::isfinite(result.score))
    throw OutputError(file, image + " has a pose or score that is not finite");
  const auto [known, is_new] = times.insert({{result.scene_id, result.image_id}, result.seconds});
  if (!is_new && std::abs(known->second - result.seconds) >= kSameTime_s)
    throw OutputError(file, image + " has lines of different times, which is one for the image");
}

std::string lineOf(const BopResult& result) {
  std::string line = std::to_string(result.scene_id) + "," + std::to_string(result.image_id) + "," +
                     std::to_string(result.object_id) + "," + numberText(result.score) + ",";
  const Eigen::Matrix3d rotation = result.camera_from_station.matrix();
  for (int i = 0; i < 9; ++i) line += (i == 0 ? "" : " ") + numberText(rotation(i / 3, i % 3));
  line += ",";
  for (int i = 0; i < 3; ++i)
    line += (i == 0 ? "" : " ") +
            numberText(kMillimetres * result.camera_from_station.translation_m[i]);
  return line + "," + numberText(result.seconds) + "\n";
}

/// A line with its number, for messages.
class LineReader {
 public:
  LineReader(const fs::path& file, std::size_t number, const std::string& line)
      : file_(file), place_("line " + std::to_string(number)) {
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields_.push_back(field);
    if (fields_.size() != 7 || line.back() == ',')
      throw InputError(file_, place_, "has not the seven fields of a BOP19 result");
  }

  int id(std::size_t field) const {
    const double value = numbers(field, 1)[0];
    if (!(value >= 0.0 && value <= 1e9) || value != std::floor(value))
      throw InputError(file_, place_, "an id is not a whole number");
    return static_cast<int>(value);
  }
  std::vector<double> numbers(std::size_t field, std::size_t count) const {
    std::istringstream stream(fields_[field]);
    stream.imbue(std::locale::classic());
    std::vector<double> made;
    for (double value = 0.0; stream >> value;) made.push_back(value);
    if (made.size() != count || !stream.eof())
      throw InputError(
          file_, place_,
          "field " + std::to_string(field + 1) + " is not " + std::to_string(count) + " numbers");
    return made;
  }
  Pose pose() const {
    const std::vector<double> r = numbers(4, 9);
    const std::vector<double> t = numbers(5, 3);
    Eigen::Matrix3d rotation;
    for (int i = 0; i < 9; ++i) rotation(i / 3, i % 3) = r[static_cast<std::size_t>(i)];
    Pose made;
    double deviation = 0.0;
    const Eigen::Vector3d translation_m = Eigen::Vector3d(t[0], t[1], t[2]) / kMillimetres;
    if (poseFromMatrix(rotation, translation_m, made, deviation) != Status::kOk)
      throw InputError(file_, place_, "R is not a rotation");
    return made;
  }

 private:
  const fs::path& file_;
  std::string place_;
  std::vector<std::string> fields_;
};

}  // namespace

void writeBopResults(const fs::path& file, std::span<const BopResult> results) {
  std::map<std::pair<int, int>, double> times;
  std::string text = std::string(kHeader) + "\n";
  for (const BopResult& result : results) {
    requireWritable(file, result, times);
    text += lineOf(result);
  }
  writeFileAtomically(file, text);
}

std::vector<BopResult> readBopResults(const fs::path& file) {
  const auto bytes = readFileBytes(file, 1024 * kMegabyte);
  std::istringstream stream{std::string(asText(bytes))};
  std::vector<BopResult> made;
  std::size_t number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || (number == 1 && line == kHeader)) continue;
    const LineReader reader(file, number, line);
    made.push_back({reader.id(0), reader.id(1), reader.id(2), reader.numbers(3, 1)[0],
                    reader.pose(), reader.numbers(6, 1)[0]});
  }
  return made;
}

}  // namespace boresight::sessions
