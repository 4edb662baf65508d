// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/json/json_writer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "sessions/io/files/atomic_file.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

using nlohmann::ordered_json;

bool isPlainList(const ordered_json& value) {
  return value.is_array() &&
         std::none_of(value.begin(), value.end(),
                      [](const ordered_json& element) { return element.is_structured(); });
}

std::string scalarText(const ordered_json& value) {
  if (value.is_number_float() && !std::isfinite(value.get<double>()))
    throw std::logic_error("a number for a JSON file is not finite");
  return compactJson(value);
}

void append(const ordered_json& value, const std::string& indent, std::string& text) {
  if (!value.is_structured() || value.empty()) {
    text += scalarText(value);
    return;
  }
  const bool one_line = isPlainList(value);
  const std::string inner = indent + "  ";
  const std::string line_start = one_line ? "" : "\n" + inner;
  std::string separator;
  text += value.is_object() ? "{" : "[";
  for (const auto& item : value.items()) {
    text += separator + line_start;
    separator = one_line ? ", " : ",";
    if (value.is_object()) text += compactJson(item.key()) + ": ";
    append(item.value(), inner, text);
  }
  text += (one_line ? "" : "\n" + indent) + (value.is_object() ? "}" : "]");
}

template <class Matrix>
ordered_json rowsOf(const Matrix& matrix) {
  ordered_json rows = ordered_json::array();
  for (const auto& row : matrix.rowwise())
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  return rows;
}

}  // namespace

std::string compactJson(const ordered_json& value) {
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

bool isUtf8(const std::string& text) {
  try {
    (void)ordered_json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

std::string utf8Text(const std::string& text) {
  if (isUtf8(text)) return text;
  std::string escaped;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    escaped += byte < 0x80 ? std::string(1, c) : formatText("\\x%02X", byte);
  }
  return escaped;
}

std::string prettyJson(const ordered_json& value) {
  std::string text;
  append(value, "", text);
  return text + "\n";
}

void writeJsonFile(const std::filesystem::path& file, const ordered_json& value) {
  writeFileAtomically(file, prettyJson(value));
}

ordered_json toJson(const Eigen::Vector2d& vector) {
  return ordered_json::array({vector.x(), vector.y()});
}

ordered_json toJson(const Eigen::Vector3d& vector) {
  return ordered_json::array({vector.x(), vector.y(), vector.z()});
}

ordered_json toJson(const Pose& a_from_b) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = a_from_b.matrix();
  matrix.topRightCorner<3, 1>() = a_from_b.translation_m;
  return rowsOf(matrix);
}

ordered_json toJson(const Matrix6d& matrix) { return rowsOf(matrix); }
ordered_json toJson(const Eigen::MatrixXd& matrix) { return rowsOf(matrix); }

}  // namespace boresight::sessions
