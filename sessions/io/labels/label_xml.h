// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace boresight::sessions {

/// Whether the text is XML that names a Product_Observational.
bool isXmlLabel(std::string_view text);

/// A PDS4 label reduced to the one array that is read: constants of other arrays do not apply.
struct XmlLabel {
  /// Elements by their names without prefix, those with an attribute `unit` as {"value", "unit"},
  /// repeated ones as arrays.
  std::shared_ptr<const nlohmann::json> tree;
  std::string file_name;  ///< of the array's file area
  std::string text;       ///< XML of the file area alone, for GDAL
  std::string remark;     ///< which of several arrays is read; else empty
};

/// The array is the first Array_2D_Image or Array_3D_Image, without one the first other array.
/// InputError: XML that is damaged or nested too deep, no array, an array without a file.
XmlLabel readXmlLabel(const std::filesystem::path& file, std::string_view text);

}  // namespace boresight::sessions
