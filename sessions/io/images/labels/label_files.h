// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace boresight::sessions {

enum class LabelFormat { kVicar, kPds3, kPds4 };

const char* labelFormatName(LabelFormat format);  ///< "VICAR", "PDS3", "PDS4"

/// The label that the bytes begin with, if any.
std::optional<LabelFormat> labelFormatOf(std::span<const std::uint8_t> bytes);

/// The whole number after KEY = in the text of a VICAR or PDS3 label, e.g. 1024 for NL=1024; empty
/// where the label states none.
std::optional<std::int64_t> statedInteger(std::string_view label, std::string_view key);

/// Byte of the file at which the rest of a VICAR label begins, behind the pixels; empty where the
/// label is at the beginning alone.
std::optional<std::int64_t> vicarEndLabel(std::string_view label);

/// A file that an image with a label consists of, read once.
struct LabelPart {
  std::string name;  ///< as in the label; the label itself has an internal name
  std::vector<std::uint8_t> bytes;
};

/// The label's file and, where the pixels lie in another file, that file; other files named in the
/// label are not read.
struct LabelFiles {
  std::filesystem::path file;  ///< the label
  LabelFormat format = LabelFormat::kVicar;
  std::vector<LabelPart> parts;  ///< unchanged, the label first
  std::string sha256;            ///< of all parts, one after the other
  /// The label as GDAL needs it, where that differs from the first part; else empty.
  std::vector<std::uint8_t> rewritten;
  /// Of PDS4: elements by their names without prefix, those with an attribute `unit` as {"value",
  /// "unit"}, repeated ones as arrays.
  std::shared_ptr<const nlohmann::json> elements;
  std::string remark;  ///< which of several PDS4 arrays is read; else empty

  /// The first part as passed to GDAL: exponents D become E; a PDS4 label keeps only the array that
  /// is read.
  std::span<const std::uint8_t> labelBytes() const {
    return rewritten.empty() ? parts.front().bytes : rewritten;
  }
};

/// Whether the text is XML that names a Product_Observational.
bool isXmlLabel(std::string_view text);

/// Reduces a PDS4 label, the first part, to the one array that is read, as constants of other
/// arrays do not apply: the first Array_2D_Image or Array_3D_Image, without one the first other
/// array. Sets `elements`, `rewritten` (the file area alone) and `remark`, and returns the name of
/// the file of the pixels. InputError: XML that is damaged or nested too deep, no array, an array
/// without a file.
std::string readXmlLabel(LabelFiles& files);

inline constexpr int kMostLabelBands = 64;

/// The file that holds the label of this image: the file itself, or a label next to it that names
/// it (same name, ending .lbl or .xml). Empty when there is no label or it cannot be read.
std::optional<std::filesystem::path> labelFileOf(const std::filesystem::path& file);

/// Reads the label and the file of its pixels, which must be in the same folder. InputError:
/// unreadable, no label, pixels that are missing or in another folder, impossible sizes.
LabelFiles readLabelFiles(const std::filesystem::path& label_file);

}  // namespace boresight::sessions
