// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sessions/io/labels/label_files.h"

namespace boresight::sessions {

/// Groups of a VICAR label (its properties) or a PDS3 label (groups and objects) by name; a name
/// may come twice. Nothing for PDS4.
std::vector<std::pair<std::string, const nlohmann::json*>> labelGroups(LabelFormat format,
                                                                       const nlohmann::json& label);
/// The first group of one of these names, or null.
const nlohmann::json* labelGroup(LabelFormat format, const nlohmann::json& label,
                                 std::initializer_list<std::string_view> names);
/// A value of one of these groups, or, without groups, of the label itself.
const nlohmann::json* labelItem(LabelFormat format, const nlohmann::json& label,
                                std::initializer_list<std::string_view> groups,
                                std::string_view key);

/// Elements of this name anywhere in a PDS4 label but under `except`, in order; at most 1000.
std::vector<const nlohmann::json*> elementsNamed(const nlohmann::json& label, std::string_view name,
                                                 std::string_view except = {});

}  // namespace boresight::sessions
