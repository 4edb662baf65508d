// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/datasets/symmetries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/math.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_reading.h"

namespace boresight::sessions {
namespace {

constexpr const char* kNone = "none";
constexpr double kWhole_deg = 360.0;
constexpr double kSame = 1e-9;  ///< rad, m, or parts of a turn
constexpr double kMostTurns = 360.0;
constexpr double kBesideBounds = 0.1;  ///< of the diagonal

[[noreturn]] void refuse(std::string_view item, const std::string& reason) {
  throw InputError("symmetries", "'" + std::string(trimmed(item)) + "'", reason);
}

/// One item of the text: a line, and the step of its turns; any turn without a step.
struct Turns {
  AxisSymmetry line;
  std::optional<double> step_deg;
};

std::vector<std::string> wordsOf(std::string_view text) {
  std::vector<std::string> words;
  for (auto word = takeWord(text); !word.empty(); word = takeWord(text)) words.emplace_back(word);
  return words;
}

Eigen::Vector3d vectorIn(std::string_view item, const std::vector<std::string>& words,
                         std::size_t first) {
  Eigen::Vector3d vector;
  for (std::size_t i = 0; i < 3; ++i) {
    if (first + i >= words.size()) refuse(item, "needs three numbers");
    const auto number = realIn(words[first + i]);
    if (!number || !std::isfinite(*number)) refuse(item, noNumberText(words[first + i]));
    vector[static_cast<Eigen::Index>(i)] = *number;
  }
  return vector;
}

/// AXIS [DEG] [at X Y Z].
Turns turnsIn(std::string_view item) {
  const std::vector<std::string> words = wordsOf(item);
  Turns turns;
  std::size_t next = 1;
  const std::string axis = lowerCase(words.front());
  if (axis == "x" || axis == "y" || axis == "z") {
    turns.line.axis = Eigen::Vector3d::Unit(axis[0] - 'x');
  } else {
    const Eigen::Vector3d direction = vectorIn(item, words, 0);
    if (!(direction.norm() > kSame)) refuse(item, "the axis has no direction");
    turns.line.axis = direction.normalized();
    next = 3;
  }
  if (next < words.size() && lowerCase(words[next]) != "at") {
    const auto step_deg = realIn(words[next]);
    const double turns_of_whole = kWhole_deg / step_deg.value_or(0.0);
    if (!(turns_of_whole > 2.0 - kSame && turns_of_whole < kMostTurns + kSame) ||
        std::abs(turns_of_whole - std::round(turns_of_whole)) > kSame * turns_of_whole)
      refuse(item, "the angle is not a part of a whole turn, such as 180, 120 or 90 deg");
    turns.step_deg = step_deg;
    ++next;
  }
  if (next < words.size()) {
    if (lowerCase(words[next]) != "at") refuse(item, "expects 'at' before the point");
    turns.line.point_m = vectorIn(item, words, next + 1);
    if (words.size() > next + 4) refuse(item, "has words after its point");
  }
  return turns;
}

bool isSame(const Pose& a, const Pose& b) {
  return perturbationBetween(a, b).cwiseAbs().maxCoeff() < kSame;
}

const Pose* findSame(const std::vector<Pose>& poses, const Pose& pose) {
  const auto found =
      std::ranges::find_if(poses, [&](const Pose& other) { return isSame(other, pose); });
  return found == poses.end() ? nullptr : &*found;
}

void add(const Turns& turns, Symmetries& symmetries) {
  if (!turns.step_deg) {
    symmetries.continuous.push_back(turns.line);
    return;
  }
  const auto count = static_cast<int>(std::lround(kWhole_deg / *turns.step_deg));
  for (int i = 1; i < count; ++i) {
    const Pose turn = turnAbout(turns.line, 2.0 * kPi * i / count);
    if (findSame(symmetries.discrete, turn) == nullptr) symmetries.discrete.push_back(turn);
  }
}

/// Adds what turns after one another lead to: each followed by each of the steps.
void close(const std::vector<Pose>& steps, std::vector<Pose>& turns) {
  for (std::size_t i = 0; i < turns.size(); ++i)
    for (const Pose& step : steps) {
      const Pose both = step * turns[i];
      if (isSame(both, Pose()) || findSame(turns, both) != nullptr) continue;
      if (turns.size() >= static_cast<std::size_t>(kMostTurns))
        throw InputError("symmetries", "",
                         "their turns after one another are more than 360: check the axes, "
                         "which may need more digits, and the points on them");
      turns.push_back(both);
    }
}

/// The turns that a transform is one step of; nothing for another motion or angle.
std::optional<Turns> turnsOf(const Pose& transform) {
  Eigen::Vector3d turn_rad = rotationLog(transform.rotation);
  const double angle_rad = turn_rad.norm();
  const double parts = 2.0 * kPi / angle_rad;
  if (!(angle_rad > kSame) || std::abs(parts - std::round(parts)) > kSame * parts)
    return std::nullopt;
  Turns turns;
  turns.line.axis = turn_rad / angle_rad;
  const Eigen::Vector3d& t_m = transform.translation_m;
  if (std::abs(turns.line.axis.dot(t_m)) > kSame) return std::nullopt;
  turns.line.point_m = 0.5 * (t_m + std::cos(0.5 * angle_rad) / std::sin(0.5 * angle_rad) *
                                        turns.line.axis.cross(t_m));
  turns.step_deg = kWhole_deg / std::round(parts);
  Eigen::Index largest = 0;
  turns.line.axis.cwiseAbs().maxCoeff(&largest);
  if (turns.line.axis[largest] < 0.0) turns.line.axis *= -1.0;
  return turns;
}

std::string numbersText(const Eigen::Vector3d& vector) {
  std::string text;
  for (const double number : vector)
    text += (text.empty() ? "" : " ") + numberText(std::abs(number) < kSame ? 0.0 : number);
  return text;
}

std::string itemText(const Turns& turns) {
  std::string text = numbersText(turns.line.axis);
  for (int axis = 0; axis < 3; ++axis)
    if ((turns.line.axis - Eigen::Vector3d::Unit(axis)).norm() < kSame)
      text = std::string(1, static_cast<char>('x' + axis));
  if (turns.step_deg) text += " " + numberText(*turns.step_deg);
  if (turns.line.point_m.norm() > kSame) text += " at " + numbersText(turns.line.point_m);
  return text;
}

/// Takes the turns out of `transforms` if all of them are in it.
bool takeAll(const Turns& turns, std::vector<Pose>& transforms) {
  Symmetries all;
  add(turns, all);
  const auto has = [&](const Pose& turn) { return findSame(transforms, turn) != nullptr; };
  if (!std::ranges::all_of(all.discrete, has)) return false;
  std::erase_if(transforms,
                [&](const Pose& pose) { return findSame(all.discrete, pose) != nullptr; });
  return true;
}

}  // namespace

Pose turnAbout(const AxisSymmetry& symmetry, double angle_rad) {
  Pose turn;
  turn.rotation = rotationExp(angle_rad * symmetry.axis);
  turn.translation_m = symmetry.point_m - turn.rotation * symmetry.point_m;
  return turn;
}

Symmetries symmetriesIn(std::string_view text) {
  Symmetries symmetries;
  std::vector<Pose> steps;
  if (lowerCase(trimmed(text)) == kNone) return symmetries;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(';'), text.size());
    const std::string_view item = text.substr(0, end);
    if (!trimmed(item).empty()) {
      const Turns turns = turnsIn(item);
      add(turns, symmetries);
      if (turns.step_deg) steps.push_back(turnAbout(turns.line, *turns.step_deg * kDegree_rad));
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  close(steps, symmetries.discrete);
  return symmetries;
}

void requireInPlace(const Symmetries& symmetries, const BoundingBox& bounds_in_station,
                    const std::string& location) {
  std::vector<Pose> turns = symmetries.discrete;
  for (const AxisSymmetry& line : symmetries.continuous) turns.push_back(turnAbout(line, kPi));
  const double beside_m = kBesideBounds * bounds_in_station.diagonal();
  const Eigen::Vector3d middle_m = bounds_in_station.centre();
  for (const Pose& turn : turns) {
    const Eigen::Vector3d turned_m = turn * middle_m;
    const Eigen::Vector3d outside_m =
        (bounds_in_station.minimum_m - turned_m).cwiseMax(turned_m - bounds_in_station.maximum_m);
    if (outside_m.maxCoeff() > beside_m)
      throw InputError(location, "symmetries",
                       "a turn moves the middle of the mesh by " +
                           numberText((turned_m - middle_m).norm()) +
                           " m, out of the mesh: state a point on the axis, in m");
  }
}

std::string symmetriesText(const Symmetries& symmetries) {
  if (symmetries.empty()) return kNone;
  std::string text;
  const auto append = [&text](const std::string& item) {
    text += (text.empty() ? "" : "; ") + item;
  };
  for (const AxisSymmetry& line : symmetries.continuous) append(itemText({line, std::nullopt}));
  std::vector<Turns> turns;
  for (const Pose& transform : symmetries.discrete)
    if (const auto found = turnsOf(transform)) turns.push_back(*found);
  // The smallest step first: its multiples include larger ones.
  std::ranges::stable_sort(turns, {}, [](const Turns& each) { return *each.step_deg; });
  std::vector<Pose> rest = symmetries.discrete;
  for (const Turns& each : turns)
    if (findSame(rest, turnAbout(each.line, *each.step_deg * kDegree_rad)) != nullptr &&
        takeAll(each, rest))
      append(itemText(each));
  if (!rest.empty())
    append("and " + countText(static_cast<std::int64_t>(rest.size()), "other transform"));
  return text;
}

}  // namespace boresight::sessions
