// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_files.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/base/digest.h"
#include "sessions/io/camera_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/image_file.h"
#include "sessions/io/labels/label_values.h"
#include "sessions/io/labels/label_xml.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxLabelBytes = 4 * kMegabyte;
constexpr std::size_t kBeginning = 4096;
constexpr std::int64_t kMostVicarLabel = 10 * 1024 * 1024;

/// Without the mark of UTF-8.
std::string_view withoutMark(std::string_view text) {
  return text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text;
}

/// Blanks and comments may stand before a PDS3 label.
std::string_view skipComments(std::string_view text) {
  text = skipBlanks(text);
  while (text.starts_with("/*")) {
    const auto end = text.find("*/", 2);
    if (end == std::string_view::npos) return {};
    text = skipBlanks(text.substr(end + 2));
  }
  return text;
}

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// 1.5D-03 as 1.5E-03, outside of texts: the exponents of FORTRAN, which GDAL leaves out.
void editExponents(std::string_view label, char quote, std::vector<LabelEdit>& edits) {
  bool in_text = false;
  bool in_number = false;
  const auto digitAt = [label](std::size_t i) { return i < label.size() && isDigit(label[i]); };
  for (std::size_t i = 0; i < label.size(); ++i) {
    const char c = label[i];
    if (c == quote) in_text = !in_text;
    const bool sign = i + 1 < label.size() && (label[i + 1] == '-' || label[i + 1] == '+');
    const bool ends = digitAt(sign ? i + 2 : i + 1);
    if (in_number && !in_text && ends && (c == 'D' || c == 'd')) edits.push_back({i, "E"});
    // A number begins after a blank, '=', '(' or ','; letters end it.
    const bool before =
        i == 0 || std::string_view(" \t\r\n=(,+-").find(label[i - 1]) != std::string_view::npos;
    in_number = (isDigit(c) || c == '.') && (in_number || before);
  }
}

void rewrite(LabelFiles& files, const std::vector<LabelEdit>& edits) {
  if (edits.empty()) return;
  files.rewritten = files.parts.front().bytes;
  for (const LabelEdit& edit : edits)
    std::copy(edit.text.begin(), edit.text.end(),
              files.rewritten.begin() + static_cast<std::ptrdiff_t>(edit.at));
}

/// A blank ORG is the default, BSQ, for which GDAL takes a missing one alone.
void editBlankOrganization(std::string_view label, std::vector<LabelEdit>& edits) {
  constexpr std::string_view kBegin = " ORG='";
  const auto at = label.find(kBegin);
  if (at == std::string_view::npos) return;
  const auto end = label.find_first_not_of(' ', at + kBegin.size());
  if (end != std::string_view::npos && label[end] == '\'')
    edits.push_back({at, std::string(end + 1 - at, ' ')});
}

void readVicarLabel(LabelFiles& files) {
  const std::string_view text = asText(files.parts.front().bytes);
  const auto stated = vicarInteger(text.substr(0, 64), "LBLSIZE").value_or(0);
  const auto label = text.substr(0, static_cast<std::size_t>(std::max<std::int64_t>(stated, 0)));
  std::vector<LabelEdit> edits;
  editExponents(label, '\'', edits);
  editBlankOrganization(label, edits);
  rewrite(files, edits);
}

/// The name of the pixels' file; empty: they are in the label's own.
std::string readPds3Label(LabelFiles& files) {
  const std::string_view text = asText(files.parts.front().bytes);
  files.pointer = readPds3Pointer(files.file, text.substr(0, kMaxLabelBytes));
  files.remark = files.pointer.remark;
  std::vector<LabelEdit> edits = std::move(files.pointer.edits);
  editExponents(text.substr(0, files.pointer.label_size), '"', edits);
  rewrite(files, edits);
  return files.pointer.file;
}

std::string readPds4Label(LabelFiles& files) {
  const auto& bytes = files.parts.front().bytes;
  if (bytes.size() > kMaxLabelBytes)
    throw InputError(files.file, "the PDS4 label is larger than 4 MB");
  XmlLabel label = readXmlLabel(files.file, asText(bytes));
  files.elements = std::move(label.tree);
  files.remark = std::move(label.remark);
  files.rewritten.assign(label.array_label.begin(), label.array_label.end());
  return label.file_name;
}

void requireBeside(const fs::path& label_file, const std::string& name) {
  const bool plain = !name.empty() && name != "." && name != ".." && name.size() <= 255 &&
                     std::all_of(name.begin(), name.end(), [](char c) {
                       return static_cast<unsigned char>(c) >= 0x20 && c != '/' && c != '\\';
                     });
  if (!plain)
    throw InputError(label_file, "the label names the file '" + oneLine(name).substr(0, 80) +
                                     "', which is not one beside it: only a name without a folder "
                                     "is followed");
}

/// The file of that name beside the label; upper and lower case may differ, as on the discs that
/// such labels were written for.
fs::path fileBeside(const fs::path& label_file, const std::string& name) {
  const fs::path folder = label_file.has_parent_path() ? label_file.parent_path() : fs::path(".");
  std::error_code error;
  if (fs::exists(folder / name, error)) return folder / name;
  const std::string wanted = lowerCase(name);
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (lowerCase(entry.path().filename().string()) == wanted) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found.empty() ? folder / name : found.front();
}

/// None of a file that cannot be read.
std::vector<std::uint8_t> beginningOf(const fs::path& file, std::size_t count) {
  try {
    return readBeginning(file, count);
  } catch (const InputError&) {
    return {};
  }
}

bool isOtherPicture(std::span<const std::uint8_t> bytes) {
  const std::string_view text = asText(bytes);
  using namespace std::string_view_literals;
  for (const std::string_view begin : {"\x89PNG"sv, "\xff\xd8\xff"sv, "II*\0"sv, "MM\0*"sv})
    if (text.starts_with(begin)) return true;
  return text.empty();
}

/// Whether the label's pixels are those of the file.
bool names(const fs::path& label_file, const fs::path& file) {
  const auto bytes = beginningOf(label_file, kMaxLabelBytes);
  const auto format = labelFormatOf(bytes);
  const std::string wanted = lowerCase(file.filename().string());
  try {
    if (format == LabelFormat::kPds3)
      return lowerCase(readPds3Pointer(label_file, asText(bytes)).file) == wanted;
    if (format == LabelFormat::kPds4)
      return lowerCase(readXmlLabel(label_file, asText(bytes)).file_name) == wanted;
  } catch (const InputError&) {
    // Not a label that says so.
  }
  return false;
}

/// Reads the file of the pixels that the label names.
void readPixelsPart(LabelFiles& files, const std::string& name) {
  requireBeside(files.file, name);
  const fs::path part = fileBeside(files.file, name);
  std::error_code error;
  // A label beside the pixels may name itself.
  if (fs::equivalent(part, files.file, error)) {
    files.parts.push_back({name, files.parts.front().bytes});
    return;
  }
  if (!fs::exists(part, error))
    throw InputError(files.file, "the file of its pixels, '" + name + "', is not beside it");
  files.parts.push_back({name, readFileBytes(part, kMaxImageFileBytes)});
}

}  // namespace

const char* labelFormatName(LabelFormat format) {
  constexpr const char* kNames[] = {"VICAR", "PDS3", "PDS4"};
  return kNames[static_cast<int>(format)];
}

std::optional<LabelFormat> labelFormatOf(std::span<const std::uint8_t> bytes) {
  std::string_view text = asText(bytes);
  if (text.starts_with("LBLSIZE=")) return LabelFormat::kVicar;
  text = withoutMark(text).substr(0, kMaxLabelBytes);
  const std::string_view begin = skipComments(text);
  for (const std::string_view key : {"PDS_VERSION_ID", "ODL_VERSION_ID", "CCSD3ZF"})
    if (begin.starts_with(key)) return LabelFormat::kPds3;
  if (begin.starts_with('<') && isXmlLabel(text)) return LabelFormat::kPds4;
  return std::nullopt;
}

std::optional<std::string_view> vicarWord(std::string_view label, std::string_view key) {
  const std::string wanted = std::string(key) + "=";
  for (auto at = label.find(wanted); at != std::string_view::npos;
       at = label.find(wanted, at + 1)) {
    if (at > 0 && !isBlank(label[at - 1])) continue;
    const std::string_view rest = label.substr(at + wanted.size());
    return rest.substr(0, rest.find_first_of(std::string_view(" \t\r\n\0", 5)));
  }
  return std::nullopt;
}

std::optional<std::int64_t> vicarInteger(std::string_view label, std::string_view key) {
  return numberIn<std::int64_t>(vicarWord(label, key).value_or(""));
}

void requireVicarSizes(const LabelFiles& files) {
  const auto bytes = files.labelBytes();
  const auto size =
      vicarInteger(asText(bytes.first(std::min<std::size_t>(bytes.size(), 64))), "LBLSIZE");
  if (!size || *size < 16 || *size > kMostVicarLabel ||
      *size > static_cast<std::int64_t>(bytes.size()))
    throw InputError(
        files.file, "LBLSIZE",
        "is not the length of a label in this file of " + std::to_string(bytes.size()) + " bytes");
  const std::string_view label = asText(bytes.first(static_cast<std::size_t>(*size)));
  const auto require = [&](const char* key, std::int64_t least, std::int64_t most) {
    const auto word = vicarWord(label, key);
    const auto value = vicarInteger(label, key);
    if (word && (!value || *value < least || *value > most))
      throw InputError(files.file, key,
                       std::string(*word) + " is no whole number from " + std::to_string(least) +
                           " to " + std::to_string(most));
  };
  constexpr std::int64_t kMostPrefix = kMaxImageSide_px * 8;
  constexpr std::int64_t kMostBytesOfSample = 8;
  require("NL", 1, kMaxImageSide_px);
  require("NS", 1, kMaxImageSide_px);
  require("NB", 1, kMostLabelBands);
  require("NBB", 0, kMostPrefix);
  require("NLB", 0, kMaxImageSide_px);
  require("RECSIZE", 1, kMostPrefix + kMaxImageSide_px * kMostBytesOfSample);
}

std::optional<fs::path> labelFileOf(const fs::path& file) {
  auto begin = beginningOf(file, kBeginning);
  // Comments may stand before a label's first word.
  const std::string_view text = skipBlanks(withoutMark(asText(begin)));
  if (text.starts_with('<') || text.starts_with("/*")) begin = beginningOf(file, kMaxLabelBytes);
  if (labelFormatOf(begin)) return file;
  if (isOtherPicture(begin)) return std::nullopt;
  for (const char* ending : {".lbl", ".LBL", ".xml", ".XML"}) {
    fs::path label = file;
    label.replace_extension(ending);
    if (label != file && names(label, file)) return label;
  }
  return std::nullopt;
}

LabelFiles readLabelFiles(const fs::path& label_file) {
  return readLabelFiles(label_file, readFileBytes(label_file, kMaxImageFileBytes));
}

LabelFiles readLabelFiles(const fs::path& label_file, std::vector<std::uint8_t> label_bytes) {
  const auto format = labelFormatOf(label_bytes);
  if (!format) throw InputError(label_file, "not a VICAR, PDS3 or PDS4 label");
  LabelFiles files;
  files.file = label_file;
  files.format = *format;
  files.parts.push_back(
      {*format == LabelFormat::kPds4 ? "label-of-image.xml" : "label-of-image.lbl",
       std::move(label_bytes)});
  std::string pixels;
  if (*format == LabelFormat::kVicar) readVicarLabel(files);
  if (*format == LabelFormat::kPds3) pixels = readPds3Label(files);
  if (*format == LabelFormat::kPds4) pixels = readPds4Label(files);
  if (!pixels.empty() || *format == LabelFormat::kPds4) readPixelsPart(files, pixels);
  Sha256 sha;
  for (const LabelPart& part : files.parts) sha.update(part.bytes);
  files.sha256 = hexText(sha.digest()).data();
  return files;
}

}  // namespace boresight::sessions
