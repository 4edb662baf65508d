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

#include "sessions/io/labels/label_odl.h"

namespace boresight::sessions {

enum class LabelFormat { kVicar, kPds3, kPds4 };

const char* labelFormatName(LabelFormat format);  ///< "VICAR", "PDS3", "PDS4"

/// The label that the bytes begin with, if any.
std::optional<LabelFormat> labelFormatOf(std::span<const std::uint8_t> bytes);

/// What a VICAR label of this text sets `key` to, up to the next blank; nothing where it does not.
std::optional<std::string_view> vicarWord(std::string_view label, std::string_view key);
/// The same as an integer, e.g. 1024 of NL=1024; nothing where it is none.
std::optional<std::int64_t> vicarInteger(std::string_view label, std::string_view key);

/// A file that an image with a label consists of, read once.
struct LabelPart {
  std::string name;  ///< as the label calls it; of the label itself, one of our own
  std::vector<std::uint8_t> bytes;
};

/// The label's file and, where the pixels lie in another file, that file: no other that the label
/// may name.
struct LabelFiles {
  std::filesystem::path file;  ///< the label
  LabelFormat format = LabelFormat::kVicar;
  std::vector<LabelPart> parts;  ///< as they were, the label first
  std::string sha256;            ///< of all parts, one after the other
  /// Where the label must be written otherwise for GDAL, the first part so; else empty.
  std::vector<std::uint8_t> rewritten;
  Pds3Pointer pointer;                             ///< of PDS3
  std::shared_ptr<const nlohmann::json> elements;  ///< of PDS4, readXmlLabel's tree
  std::string remark;  ///< of several images in the label, which one is read; else empty

  /// The first part as GDAL gets it: exponents D written E, of VICAR without a blank ORG, of PDS4
  /// the one array that is read.
  std::span<const std::uint8_t> labelBytes() const {
    return rewritten.empty() ? parts.front().bytes : rewritten;
  }
};

inline constexpr int kMostLabelBands = 64;

/// InputError where a VICAR label states sizes that no image has, before tables of them are made.
void requireVicarSizes(const LabelFiles& files);

/// Where the label of this file is: the file itself, or the label beside it that names it (same
/// name, ending .lbl or .xml) when the file has none and is no picture of another kind. Nothing
/// when there is no label; false answers of files that cannot be read, too.
std::optional<std::filesystem::path> labelFileOf(const std::filesystem::path& file);

/// Reads the label and the file of its pixels, which may only be one in its own folder. InputError:
/// unreadable, no label, pixels that are missing or elsewhere.
LabelFiles readLabelFiles(const std::filesystem::path& label_file);
/// The same of bytes that are already read.
LabelFiles readLabelFiles(const std::filesystem::path& label_file,
                          std::vector<std::uint8_t> label_bytes);

/// Of the camera model of a VICAR or PDS3 label: what its text states twice, of which GDAL hands on
/// the last alone. One sentence, or nothing.
std::string repeatedInCameraModel(const LabelFiles& files);

}  // namespace boresight::sessions
