// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "core/geometry/pose.h"

namespace boresight::sessions {

/// Readable JSON: one member per line, but lists of plain values (a matrix row) on one line.
/// Numbers are the shortest text that reads back as the same double.
std::string prettyJson(const nlohmann::ordered_json& value);

/// JSON on one line, where strings may be names of files: U+FFFD in place of bytes that are not
/// UTF-8.
std::string compactJson(const nlohmann::ordered_json& value);

bool isUtf8(const std::string& text);
/// The text, or, where it is not UTF-8, with its bytes from 0x80 on as \x80 .. \xFF: two names stay
/// two.
std::string utf8Text(const std::string& text);

/// Writes `value` atomically; OutputError. A number that is not finite is a program error: it
/// throws std::logic_error and is not written as null.
void writeJsonFile(const std::filesystem::path& file, const nlohmann::ordered_json& value);

nlohmann::ordered_json toJson(const Eigen::Vector2d& vector);
nlohmann::ordered_json toJson(const Eigen::Vector3d& vector);
/// Row-major 4x4.
nlohmann::ordered_json toJson(const Pose& a_from_b);
/// Rows of numbers.
nlohmann::ordered_json toJson(const Matrix6d& matrix);
nlohmann::ordered_json toJson(const Eigen::MatrixXd& matrix);

}  // namespace boresight::sessions
