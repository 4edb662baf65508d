// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/label_files.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>

#include "core/base/digest.h"
#include "sessions/io/camera_file.h"
#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/image_file.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxLabelBytes = 4 * kMegabyte;
constexpr std::size_t kBeginning = 4096;
constexpr std::int64_t kMostVicarLabel = 10 * 1024 * 1024;
/// More files than an image product has.
constexpr std::size_t kMostParts = 16;

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::string_view skipBlanks(std::string_view text) {
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  return text;
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

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  });
  return lower;
}

/// The text of a PDS3 label: up to the line END.
std::string_view pds3Text(std::span<const std::uint8_t> bytes) {
  const std::string_view text = asText(bytes.first(std::min(bytes.size(), kMaxLabelBytes)));
  for (auto at = text.find("\nEND"); at != std::string_view::npos; at = text.find("\nEND", at + 4))
    if (at + 4 >= text.size() || isBlank(text[at + 4])) return text.substr(0, at);
  return text;
}

/// The file names of pointers to pixels: ^IMAGE = "X.IMG", ^IMAGE = ("X.IMG", 12 <BYTES>).
std::vector<std::string> pds3Names(std::string_view label) {
  std::vector<std::string> names;
  for (auto at = label.find('^'); at != std::string_view::npos; at = label.find('^', at + 1)) {
    std::string_view rest = label.substr(at + 1);
    const auto equals = rest.find('=');
    if (equals == std::string_view::npos) break;
    const std::string_view key = rest.substr(0, equals);
    if (key.find('\n') != std::string_view::npos ||
        (!skipBlanks(key).starts_with("IMAGE") && key.find("_IMAGE") == std::string_view::npos) ||
        key.find("HEADER") != std::string_view::npos)
      continue;
    rest = skipBlanks(rest.substr(equals + 1));
    if (rest.starts_with('(')) rest = skipBlanks(rest.substr(1));
    if (!rest.starts_with('"')) continue;
    const auto end = rest.find('"', 1);
    if (end != std::string_view::npos) names.emplace_back(rest.substr(1, end - 1));
  }
  return names;
}

/// What stands in every <file_name>.
std::vector<std::string> pds4Names(std::string_view label) {
  constexpr std::string_view kOpen = "<file_name>";
  std::vector<std::string> names;
  for (auto at = label.find(kOpen); at != std::string_view::npos; at = label.find(kOpen, at + 1)) {
    const auto begin = at + kOpen.size();
    const auto end = label.find('<', begin);
    if (end == std::string_view::npos) break;
    std::string_view name = skipBlanks(label.substr(begin, end - begin));
    while (!name.empty() && isBlank(name.back())) name.remove_suffix(1);
    names.emplace_back(name);
  }
  return names;
}

bool isDigit(std::uint8_t c) { return c >= '0' && c <= '9'; }

/// 1.5D-03 as 1.5E-03, outside of texts: the exponents of FORTRAN, which GDAL leaves out.
void writeExponents(std::span<std::uint8_t> label, char quote) {
  bool in_text = false;
  bool in_number = false;
  for (std::size_t i = 0; i < label.size(); ++i) {
    const std::uint8_t c = label[i];
    if (c == static_cast<std::uint8_t>(quote)) in_text = !in_text;
    const bool ends = i + 1 < label.size() &&
                      (isDigit(label[i + 1]) || ((label[i + 1] == '-' || label[i + 1] == '+') &&
                                                 i + 2 < label.size() && isDigit(label[i + 2])));
    if (in_number && !in_text && ends && (c == 'D' || c == 'd')) label[i] = 'E';
    // A number begins after a blank, '=', '(' or ','; letters end it.
    const bool before =
        i == 0 || std::string_view(" \t\r\n=(,+-").find(static_cast<char>(label[i - 1])) !=
                      std::string_view::npos;
    in_number = (isDigit(c) && (in_number || before)) || (c == '.' && (in_number || before));
  }
}

void prepareLabel(LabelFormat format, std::vector<std::uint8_t>& bytes) {
  if (format == LabelFormat::kPds4) return;
  std::size_t size = pds3Text(bytes).size();
  if (format == LabelFormat::kVicar) {
    const auto stated = vicarInteger(asText(bytes).substr(0, 64), "LBLSIZE").value_or(0);
    size = static_cast<std::size_t>(
        std::clamp<std::int64_t>(stated, 0, static_cast<std::int64_t>(bytes.size())));
  }
  writeExponents(std::span(bytes).first(size), format == LabelFormat::kVicar ? '\'' : '"');
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

std::vector<std::string> namesIn(LabelFormat format, std::span<const std::uint8_t> bytes) {
  std::vector<std::string> names;
  if (format == LabelFormat::kPds3) names = pds3Names(pds3Text(bytes));
  if (format == LabelFormat::kPds4) names = pds4Names(asText(bytes));
  std::vector<std::string> once;
  for (std::string& name : names)
    if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(std::move(name));
  return once;
}

std::vector<std::uint8_t> beginningOf(const fs::path& file, std::size_t count) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  std::ifstream stream(file, std::ios::binary);
  std::vector<std::uint8_t> bytes(count);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream.gcount(), 0)));
  return bytes;
}

bool isOtherPicture(std::span<const std::uint8_t> bytes) {
  const std::string_view text = asText(bytes);
  using namespace std::string_view_literals;
  for (const std::string_view begin : {"\x89PNG"sv, "\xff\xd8\xff"sv, "II*\0"sv, "MM\0*"sv})
    if (text.starts_with(begin)) return true;
  return text.empty();
}

bool names(const fs::path& label_file, const fs::path& file) {
  const auto bytes = beginningOf(label_file, kMaxLabelBytes);
  const auto format = labelFormatOf(bytes);
  if (!format) return false;
  const std::string wanted = lowerCase(file.filename().string());
  const auto listed = namesIn(*format, bytes);
  return std::any_of(listed.begin(), listed.end(),
                     [&wanted](const std::string& name) { return lowerCase(name) == wanted; });
}

}  // namespace

const char* labelFormatName(LabelFormat format) {
  switch (format) {
    case LabelFormat::kVicar:
      return "VICAR";
    case LabelFormat::kPds3:
      return "PDS3";
    case LabelFormat::kPds4:
      return "PDS4";
  }
  return "unknown";
}

std::optional<LabelFormat> labelFormatOf(std::span<const std::uint8_t> bytes) {
  std::string_view text = asText(bytes);
  if (text.starts_with("LBLSIZE=")) return LabelFormat::kVicar;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  text = text.substr(0, 4 * kBeginning);
  const std::string_view begin = skipComments(text);
  for (const std::string_view key : {"PDS_VERSION_ID", "ODL_VERSION_ID", "CCSD3ZF"})
    if (begin.starts_with(key)) return LabelFormat::kPds3;
  if (skipBlanks(text).starts_with('<') &&
      text.find("Product_Observational") != std::string_view::npos)
    return LabelFormat::kPds4;
  return std::nullopt;
}

std::optional<std::int64_t> vicarInteger(std::string_view label, std::string_view key) {
  const std::string wanted = std::string(key) + "=";
  for (auto at = label.find(wanted); at != std::string_view::npos;
       at = label.find(wanted, at + 1)) {
    if (at > 0 && !isBlank(label[at - 1])) continue;
    std::string_view rest = label.substr(at + wanted.size());
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error == std::errc()) return value;
    return std::nullopt;
  }
  return std::nullopt;
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
    const auto value = vicarInteger(label, key);
    if (value && (*value < least || *value > most))
      throw InputError(files.file, key,
                       std::to_string(*value) + " is outside of " + std::to_string(least) + " .. " +
                           std::to_string(most));
  };
  require("NL", 1, kMaxImageSide_px);
  require("NS", 1, kMaxImageSide_px);
  require("NB", 1, kMostLabelBands);
  require("NBB", 0, kMaxImageSide_px * 8);
  require("NLB", 0, kMaxImageSide_px);
  // A record is then one pixel, and each would have a prefix: nobody reads that right.
  if (label.find("ORG='BIP'") != std::string_view::npos &&
      vicarInteger(label, "NBB").value_or(0) > 0)
    throw InputError(files.file, "NBB", "a prefix of every pixel (ORG='BIP') is not read");
}

std::optional<fs::path> labelFileOf(const fs::path& file) {
  const auto begin = beginningOf(file, 4 * kBeginning);
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
  if (*format == LabelFormat::kPds4 && label_bytes.size() > kMaxLabelBytes)
    throw InputError(label_file, "the PDS4 label is larger than 4 MB");
  const auto listed = namesIn(*format, label_bytes);
  if (listed.size() > kMostParts)
    throw InputError(label_file,
                     "the label names " + std::to_string(listed.size()) + " files of pixels");
  files.parts.push_back(
      {*format == LabelFormat::kPds4 ? "label-of-image.xml" : "label-of-image.lbl",
       std::move(label_bytes)});
  std::size_t left = kMaxImageFileBytes;
  for (const std::string& name : listed) {
    requireBeside(label_file, name);
    const fs::path part = fileBeside(label_file, name);
    std::error_code error;
    // A label beside the pixels may name itself.
    if (fs::equivalent(part, label_file, error)) {
      files.parts.push_back({name, files.parts.front().bytes});
      continue;
    }
    if (!fs::exists(part, error)) {
      if (listed.size() > 1) continue;  // of several, those that are there
      throw InputError(label_file, "the file of its pixels, '" + name + "', is not beside it");
    }
    files.parts.push_back({name, readFileBytes(part, left)});
    left -= files.parts.back().bytes.size();
  }
  Sha256 sha;
  for (const LabelPart& part : files.parts) sha.update(part.bytes);
  files.sha256 = hexText(sha.digest()).data();
  prepareLabel(files.format, files.parts.front().bytes);
  return files;
}

}  // namespace boresight::sessions
