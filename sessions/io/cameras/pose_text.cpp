// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/cameras/pose_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/text/text_reading.h"
#include "sessions/text/units.h"

namespace boresight::sessions {
namespace {

constexpr double kLargest_m = 1e6;

std::string list(std::vector<double> values) {
  for (double& value : values) value += 0.0;  // not "-0"
  return "[" + numbersText(values, ", ") + "]";
}

std::string translationText(const Pose& pose) {
  const Eigen::Vector3d mm = kMillimetres * pose.translation_m;
  return "translation_mm " + list({mm.x(), mm.y(), mm.z()});
}

bool isWordPart(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// The numbers outside words. Words are left out with the digits in them ("camera_0", "p1"), except
/// the e of an exponent.
std::vector<double> numbersIn(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < text.size();) {
    if (isWordPart(text[i])) {
      while (i < text.size() &&
             (isWordPart(text[i]) || std::isdigit(static_cast<unsigned char>(text[i])) != 0))
        ++i;
      continue;
    }
    const std::size_t sign = text[i] == '+' ? 1 : 0;  // from_chars takes no plus
    double value = 0.0;
    const auto [end, error] =
        std::from_chars(text.data() + i + sign, text.data() + text.size(), value);
    if (error == std::errc()) {
      numbers.push_back(value);
      i = static_cast<std::size_t>(end - text.data());
    } else {
      ++i;
    }
  }
  return numbers;
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool isDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool isDigitOrPoint(char c) { return isDigit(c) || c == '.'; }

constexpr auto kBlanks = std::to_array<std::string_view>(
    {" ", "\t", "\n", "\v", "\f", "\r", "\u00a0", "\u2002", "\u2003", "\u2007", "\u2009", "\u200b",
     "\u202f", "\u3000", "\ufeff"});
constexpr auto kOpeningBrackets = std::to_array<std::string_view>({"(", "[", "{", "<"});
/// Also as printed: hyphens, dashes, the minus sign, plus-minus.
constexpr auto kSigns = std::to_array<std::string_view>(
    {"+", "-", "\u00ad", "\u00b1", "\u2010", "\u2011", "\u2012", "\u2013", "\u2014", "\u2015",
     "\u2212", "\u2213", "\ufe58", "\ufe63", "\uff0b", "\uff0d"});

/// Removes one of these parts from the beginning of a text; false when it begins with none.
bool takeOneOf(std::span<const std::string_view> parts, std::string_view& text) {
  const auto part = std::ranges::find_if(
      parts, [text](std::string_view known) { return text.starts_with(known); });
  if (part == parts.end()) return false;
  text.remove_prefix(part->size());
  return true;
}

/// Whether a character beyond ASCII that is no blank, such as a printed minus sign, is in front of
/// a number, which would be read without it.
bool hasForeignSign(std::string_view text) {
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i - 1] >= 0 || !isDigitOrPoint(text[i])) continue;
    const std::string_view before = text.substr(0, i);
    if (std::ranges::none_of(kBlanks,
                             [before](std::string_view known) { return before.ends_with(known); }))
      return true;
  }
  return false;
}

/// Whether blanks, opening brackets or further signs separate a sign from a number, which would be
/// read without it: "- 3", "-[1 2 3]".
bool hasSeparateSign(std::string_view text) {
  bool after_sign = false;
  bool separate = false;
  while (!text.empty()) {
    if (after_sign && separate && isDigitOrPoint(text.front())) return true;
    if (takeOneOf(kSigns, text)) {
      separate = after_sign;
      after_sign = true;
    } else if (takeOneOf(kBlanks, text) || takeOneOf(kOpeningBrackets, text)) {
      separate = true;
    } else {
      after_sign = separate = false;
      text.remove_prefix(1);
    }
  }
  return false;
}

/// Whether the rest of a line behind the mark of a list's item is one: a number, or a list.
bool isListItem(std::string_view item) {
  return item.starts_with('[') || numbersIn(item).size() == 1;
}

/// The text without the marks of a YAML list, whose items have a line each: "- 0.5", "- [1, 0]", or
/// "- - 1" of a list in a list. Unchanged where a dash may be a sign: when a line with numbers is
/// no item, and when the line below "- - 1" does not continue the inner list.
std::string withoutListMarks(std::string_view text) {
  std::string unmarked;
  std::optional<std::size_t> inner;  // where the mark of the next item must be
  int items = 0;
  for (TextLines lines(text); lines.next();) {
    std::string_view line = lines.line();
    const std::string_view whole = line;
    const auto skip_blanks = [&line] {
      line.remove_prefix(std::min(line.find_first_not_of(kTextBlanks), line.size()));
    };
    for (skip_blanks(); line.starts_with("- "); skip_blanks()) line.remove_prefix(2);
    const std::string_view marks = whole.substr(0, whole.size() - line.size());
    if (!numbersIn(line).empty()) {
      const std::size_t first = marks.find('-');
      const std::size_t last = marks.rfind('-');
      if (first == std::string_view::npos || !isListItem(line)) return std::string(text);
      if (inner.value_or(first) != first) return std::string(text);
      inner = last > first ? std::optional(last) : std::nullopt;
      ++items;
    }
    unmarked += std::string(line) + "\n";
  }
  return items < 2 || inner ? std::string(text) : unmarked;
}

/// Whether a comma is or may be a decimal comma: "0,5; 1,25", "0 0 1 0,2 0 0". A decimal point and
/// a list without blanks ("1,2,3") show that the text's commas separate numbers.
bool hasDecimalCommas(std::string_view text) {
  constexpr const char* kPartsOfNumbers = "0123456789,.+-eE";
  bool found = false;
  while (!text.empty()) {
    text.remove_prefix(std::min(text.find_first_of(kPartsOfNumbers), text.size()));
    const std::string_view word = text.substr(0, text.find_first_not_of(kPartsOfNumbers));
    text.remove_prefix(word.size());
    int commas = 0;
    for (std::size_t i = 0; i < word.size(); ++i) {
      const bool after_digit = i > 0 && isDigit(word[i - 1]);
      const bool before_digit = i + 1 < word.size() && isDigit(word[i + 1]);
      if (word[i] == '.' && (after_digit || before_digit)) return false;
      if (word[i] == ',' && after_digit && before_digit) ++commas;
    }
    if (commas > 1) return false;
    found = found || commas == 1;
  }
  return found;
}

ParsedPose refused(PoseForm form, std::string problem) {
  ParsedPose parsed;
  parsed.form = form;
  parsed.problem = std::move(problem);
  return parsed;
}

/// Six digits, whatever the locale.
std::string shortNumber(double value) {
  std::array<char, 40> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::general, 6);
  return {buffer.data(), end.ptr};
}

/// The pose of a rotation and a translation as they were read.
ParsedPose accepted(PoseForm form, const Eigen::Matrix3d& rotation,
                    const Eigen::Vector3d& translation, const PoseReading& reading) {
  const double metres = reading.millimetres ? 1.0 / kMillimetres : 1.0;
  ParsedPose parsed;
  parsed.form = form;
  Pose pose;
  if (!(translation.cwiseAbs().maxCoeff() * metres < kLargest_m))
    return refused(form, "The translation is not a number, or 1000 km or more.");
  if (poseFromMatrix(rotation, translation * metres, pose, parsed.rotation_deviation) !=
      Status::kOk)
    return refused(
        form,
        rotation.determinant() < 0.0
            ? "The matrix mirrors (its determinant is negative); it is not a "
              "rotation."
            : "The matrix is not a rotation: |R'R - I| is " +
                  shortNumber(
                      (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm()) +
                  "; the limit is 1e-4.");
  parsed.valid = true;
  parsed.camera_from_station = reading.station_from_camera ? pose.inverse() : pose;
  return parsed;
}

ParsedPose fromMatrix(const std::vector<double>& numbers, const PoseReading& reading) {
  const auto at = [&](std::size_t row, std::size_t column) {
    const std::size_t rows = numbers.size() / 4;
    return reading.column_major ? numbers[rows * column + row] : numbers[4 * row + column];
  };
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column)
      rotation(static_cast<int>(row), static_cast<int>(column)) = at(row, column);
    translation[static_cast<int>(row)] = at(row, 3);
  }
  if (numbers.size() == 16 &&
      !(at(3, 0) == 0.0 && at(3, 1) == 0.0 && at(3, 2) == 0.0 && at(3, 3) == 1.0))
    return refused(PoseForm::kMatrix, "The matrix's last row is not 0 0 0 1; try the other order.");
  return accepted(PoseForm::kMatrix, rotation, translation, reading);
}

ParsedPose fromQuaternion(const std::vector<double>& numbers, const PoseReading& reading) {
  const Eigen::Vector4d q(numbers[0], numbers[1], numbers[2], numbers[3]);
  if (!(std::abs(q.norm() - 1.0) <= 1e-4))
    return refused(PoseForm::kQuaternion, "The quaternion is not of unit length (it is " +
                                              shortNumber(q.norm()) + "); the limit is 1e-4.");
  const Eigen::Vector4d unit = q.normalized();
  const Eigen::Quaterniond rotation = reading.xyzw
                                          ? Eigen::Quaterniond(unit)
                                          : Eigen::Quaterniond(unit[0], unit[1], unit[2], unit[3]);
  return accepted(PoseForm::kQuaternion, rotation.toRotationMatrix(),
                  {numbers[4], numbers[5], numbers[6]}, reading);
}

}  // namespace

Eigen::Quaterniond shownQuaternion(const Eigen::Quaterniond& rotation) {
  const Eigen::Quaterniond unit = rotation.normalized();
  for (const double part : {unit.w(), unit.x(), unit.y(), unit.z()}) {
    if (part > 0.0) return unit;
    if (part < 0.0) return Eigen::Quaterniond(-unit.coeffs());
  }
  return unit;
}

std::string poseText(const Pose& camera_from_station, PoseForm form) {
  const Pose& pose = camera_from_station;
  switch (form) {
    case PoseForm::kRotationVector: {
      const Eigen::Vector3d deg = rotationLog(pose.rotation) / kDegree_rad;
      return "camera_from_station rotation_vector_deg " + list({deg.x(), deg.y(), deg.z()}) + " " +
             translationText(pose);
    }
    case PoseForm::kQuaternion: {
      const Eigen::Quaterniond q = shownQuaternion(pose.rotation);
      return "camera_from_station quaternion_wxyz " + list({q.w(), q.x(), q.y(), q.z()}) + " " +
             translationText(pose);
    }
    case PoseForm::kMatrix:
      break;
  }
  const Eigen::Matrix3d rotation = pose.matrix();
  std::string text = "[";
  for (int row = 0; row < 3; ++row)
    text += list({rotation(row, 0), rotation(row, 1), rotation(row, 2), pose.translation_m[row]}) +
            ",\n ";
  return text + "[0, 0, 0, 1]]";
}

PoseReading guessReading(std::string_view text) {
  PoseReading guess;
  guess.station_from_camera = contains(text, "station_from_camera");
  guess.xyzw = contains(text, "xyzw");
  guess.millimetres = contains(text, "mm");
  const std::vector<double> n = numbersIn(text);
  if (n.size() != 16) return guess;
  const bool last_column = n[3] == 0.0 && n[7] == 0.0 && n[11] == 0.0;
  const bool last_row = n[12] == 0.0 && n[13] == 0.0 && n[14] == 0.0;
  guess.column_major = last_column && !last_row;
  return guess;
}

ParsedPose parsePose(std::string_view text, const PoseReading& reading) {
  const std::vector<double> numbers = numbersIn(text);
  if (hasForeignSign(text))
    return refused(PoseForm::kMatrix,
                   "A character beyond ASCII is in front of a number: write "
                   "signs and digits in ASCII.");
  if (hasSeparateSign(withoutListMarks(text)))
    return refused(PoseForm::kMatrix,
                   "A sign is separate from its number: write signs directly in front of digits.");
  if (hasDecimalCommas(text))
    return refused(PoseForm::kMatrix,
                   "The numbers have, or may have, decimal commas: write decimal points, and a "
                   "blank behind commas that separate numbers.");
  if (!std::all_of(numbers.begin(), numbers.end(), [](double n) { return isFinite(n); }))
    return refused(PoseForm::kMatrix, "Not every number is finite.");
  switch (numbers.size()) {
    case 16:
    case 12:
      return fromMatrix(numbers, reading);
    case 7:
      return fromQuaternion(numbers, reading);
    case 6: {
      const Eigen::Vector3d deg(numbers[0], numbers[1], numbers[2]);
      return accepted(PoseForm::kRotationVector, rotationExp(kDegree_rad * deg).toRotationMatrix(),
                      {numbers[3], numbers[4], numbers[5]}, reading);
    }
    default:
      return refused(PoseForm::kMatrix,
                     "The text holds " + std::to_string(numbers.size()) +
                         " numbers; a pose has 16 or 12 (matrix), 7 (quaternion, translation) or "
                         "6 (rotation vector, translation).");
  }
}

}  // namespace boresight::sessions
