// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace boresight::sessions {

/// Whether the text is XML whose first element is a Product_Observational, whatever its prefix and
/// whatever comments stand before it.
bool isXmlLabel(std::string_view text);

/// A PDS4 label and the one array of it that is read.
struct XmlLabel {
  /// Elements by their names without prefix, those with an attribute `unit` as {"value", "unit"},
  /// repeated ones as arrays. Of the areas of files only that of the array, with it alone: what the
  /// label says of other arrays cannot be taken for its own.
  std::shared_ptr<const nlohmann::json> tree;
  std::string file_name;  ///< of the array's area, without blanks around it
  /// A label of that array alone, which names its file kXmlPixelsName.
  std::string array_label;
  std::string remark;  ///< of several arrays, which one is read; else empty
};

inline constexpr const char* kXmlPixelsName = "pixels-of-label";

/// The array is the first Array_2D_Image or Array_3D_Image, without one the first other array.
/// InputError: XML that is damaged or nested too deep, no array, an array without a file.
XmlLabel readXmlLabel(const std::filesystem::path& file, std::string_view text);

}  // namespace boresight::sessions
