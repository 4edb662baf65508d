// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/json_patch.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include <nlohmann/json.hpp>

namespace boresight::sessions {
namespace {

using nlohmann::json;

bool same(const json& a, const json& b);

bool sameMembers(const json& a, const json& b) {
  if (a.size() != b.size()) return false;
  for (auto x = a.begin(), y = b.begin(); x != a.end(); ++x, ++y)
    if (x.key() != y.key() || !same(x.value(), y.value())) return false;
  return true;
}

/// Whether both have the same text.
bool same(const json& a, const json& b) {
  if (a.is_number_float() != b.is_number_float()) return false;
  if (a.is_number_float())
    return std::bit_cast<std::uint64_t>(a.get<double>()) ==
           std::bit_cast<std::uint64_t>(b.get<double>());
  if (a.is_object() && b.is_object()) return sameMembers(a, b);
  if (a.is_array() && b.is_array()) return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
  return a == b;
}

class PatchMaker {
 public:
  void compare(const json& before, const json& after) {
    if (before.is_object() && after.is_object()) {
      compareObjects(before, after);
    } else if (before.is_array() && after.is_array()) {
      compareLists(before, after);
    } else if (!same(before, after)) {
      patch_.push_back(json::array({"set", path_, after}));
    }
  }
  json take() { return std::move(patch_); }

 private:
  template <class Key>
  void compareAt(const Key& key, const json& before, const json& after) {
    path_.push_back(key);
    compare(before, after);
    path_.erase(path_.size() - 1);
  }

  json pathTo(const std::string& key) const {
    json path = path_;
    path.push_back(key);
    return path;
  }

  void compareObjects(const json& before, const json& after) {
    for (const auto& [key, value] : before.items())
      if (!after.contains(key)) patch_.push_back(json::array({"remove", pathTo(key)}));
    for (const auto& [key, value] : after.items()) {
      const auto old = before.find(key);
      if (old == before.end())
        patch_.push_back(json::array({"set", pathTo(key), value}));
      else
        compareAt(key, *old, value);
    }
  }

  /// What is the same at both ends stays; of the rest, elements are compared one by one when there
  /// are as many as before, else they are replaced as a whole.
  void compareLists(const json& before, const json& after) {
    const std::size_t shorter = std::min(before.size(), after.size());
    std::size_t head = 0;
    while (head < shorter && same(before[head], after[head])) ++head;
    std::size_t tail = 0;
    while (tail < shorter - head &&
           same(before[before.size() - 1 - tail], after[after.size() - 1 - tail]))
      ++tail;
    if (before.size() == after.size()) {
      for (std::size_t i = head; i < before.size() - tail; ++i) compareAt(i, before[i], after[i]);
      return;
    }
    json inserted = json::array();
    for (std::size_t i = head; i < after.size() - tail; ++i) inserted.push_back(after[i]);
    patch_.push_back(json::array({"splice", path_, head, before.size() - tail - head, inserted}));
  }

  json path_ = json::array();
  json patch_ = json::array();
};

/// The value at a path but for its last `left` steps; nullptr when there is none.
json* follow(json& value, const json& path, std::size_t left) {
  json* place = &value;
  for (std::size_t i = 0; i + left < path.size(); ++i) {
    const json& step = path[i];
    if (step.is_string() && place->is_object() && place->contains(step.get<std::string>()))
      place = &(*place)[step.get<std::string>()];
    else if (step.is_number_unsigned() && place->is_array() &&
             step.get<std::size_t>() < place->size())
      place = &(*place)[step.get<std::size_t>()];
    else
      return nullptr;
  }
  return place;
}

bool applySet(const json& operation, json& value) {
  const json& path = operation[1];
  if (path.empty()) {
    value = operation[2];
    return true;
  }
  json* parent = follow(value, path, 1);
  if (parent == nullptr) return false;
  const json& last = path.back();
  if (last.is_string() && parent->is_object()) {
    (*parent)[last.get<std::string>()] = operation[2];
    return true;
  }
  if (!last.is_number_unsigned() || !parent->is_array() ||
      last.get<std::size_t>() >= parent->size())
    return false;
  (*parent)[last.get<std::size_t>()] = operation[2];
  return true;
}

bool applyRemove(const json& operation, json& value) {
  const json& path = operation[1];
  json* parent = path.empty() ? nullptr : follow(value, path, 1);
  if (parent == nullptr || !parent->is_object() || !path.back().is_string()) return false;
  return parent->erase(path.back().get<std::string>()) == 1;
}

bool applySplice(const json& operation, json& value) {
  json* list = follow(value, operation[1], 0);
  if (list == nullptr || !list->is_array() || !operation[2].is_number_unsigned() ||
      !operation[3].is_number_unsigned() || !operation[4].is_array())
    return false;
  const auto first = operation[2].get<std::size_t>();
  const auto count = operation[3].get<std::size_t>();
  if (first > list->size() || count > list->size() - first) return false;
  const auto at = list->begin() + static_cast<std::ptrdiff_t>(first);
  const auto rest = list->erase(at, at + static_cast<std::ptrdiff_t>(count));
  list->insert(rest, operation[4].begin(), operation[4].end());
  return true;
}

bool applyOperation(const json& operation, json& value) {
  if (!operation.is_array() || operation.size() < 2 || !operation[0].is_string() ||
      !operation[1].is_array())
    return false;
  const auto name = operation[0].get<std::string>();
  if (name == "set") return operation.size() == 3 && applySet(operation, value);
  if (name == "remove") return operation.size() == 2 && applyRemove(operation, value);
  return name == "splice" && operation.size() == 5 && applySplice(operation, value);
}

}  // namespace

json jsonPatch(const json& before, const json& after) {
  PatchMaker maker;
  maker.compare(before, after);
  return maker.take();
}

bool applyJsonPatch(const json& patch, json& value) {
  return patch.is_array() &&
         std::all_of(patch.begin(), patch.end(),
                     [&value](const json& operation) { return applyOperation(operation, value); });
}

}  // namespace boresight::sessions
