// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/labels/label_files.h"

#include <algorithm>

#include "core/base/digest.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/image_decoder.h"
#include "sessions/io/images/image_file.h"
#include "sessions/io/images/labels/label_values.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxLabelBytes = 4 * kMegabyte;
constexpr std::size_t kBeginning = 4096;

/// The text after KEY = at its first place from `from` on.
std::optional<std::string_view> textAfter(std::string_view label, std::string_view key,
                                          std::size_t from = 0) {
  for (auto at = label.find(key, from); at != std::string_view::npos;
       at = label.find(key, at + 1)) {
    const std::string_view rest = skipBlanks(label.substr(at + key.size()));
    if ((at == 0 || isBlank(label[at - 1])) && rest.starts_with('='))
      return skipBlanks(rest.substr(1));
  }
  return std::nullopt;
}

std::string_view firstWord(std::string_view text) {
  return text.substr(0, text.find_first_of(std::string_view(" \t\r\n\0", 5)));
}

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Writes FORTRAN's exponents, 1.5D-03, as 1.5E-03: GDAL takes that for 1.5. Texts are kept.
/// `label` is a part of the file's bytes.
void rewriteExponents(LabelFiles& files, std::string_view label, char quote) {
  const auto begin =
      static_cast<std::size_t>(label.data() - asText(files.parts.front().bytes).data());
  bool in_text = false;
  bool in_number = false;
  const auto digitAt = [label](std::size_t i) { return i < label.size() && isDigit(label[i]); };
  for (std::size_t i = 0; i < label.size(); ++i) {
    const char c = label[i];
    if (c == quote) in_text = !in_text;
    const bool sign = i + 1 < label.size() && (label[i + 1] == '-' || label[i + 1] == '+');
    if (in_number && !in_text && (c == 'D' || c == 'd') && digitAt(sign ? i + 2 : i + 1)) {
      if (files.rewritten.empty()) files.rewritten = files.parts.front().bytes;
      files.rewritten[begin + i] = 'E';
    }
    // A number begins after a blank, '=', '(' or ','; letters end it.
    const bool before =
        i == 0 || std::string_view(" \t\r\n=(,+-").find(label[i - 1]) != std::string_view::npos;
    in_number = (isDigit(c) || c == '.') && (in_number || before);
  }
}

/// GDAL reads only the beginning of numbers that are no plain integers, and allocates tables for
/// sizes before it checks them.
void requireSize(const LabelFiles& files, std::string_view label, const char* key,
                 std::int64_t least, std::int64_t most) {
  for (auto text = textAfter(label, key); text;) {
    const std::string_view word = firstWord(*text);
    const auto value = numberIn<std::int64_t>(word);
    const bool number = !word.empty() && (isDigit(word.front()) || word.front() == '-');
    if (number && (!value || *value < least || *value > most))
      throw InputError(files.file, key,
                       oneLine(word.substr(0, 80)) + " is not a whole number from " +
                           std::to_string(least) + " to " + std::to_string(most));
    // The sizes of a VICAR image come first; tasks may have items of the same names.
    if (files.format == LabelFormat::kVicar) return;
    text = textAfter(label, key, static_cast<std::size_t>(text->data() - label.data()));
  }
}

/// VICAR's default is BSQ, but GDAL reads no image whose label leaves ORG out: it is written behind
/// LBLSIZE, in place of the padding at the label's end.
void stateOrganization(LabelFiles& files, std::string_view label) {
  constexpr std::string_view kDefault = " ORG='BSQ'";
  if (textAfter(label, "ORG")) return;
  const std::size_t padding =
      label.size() - 1 - label.find_last_not_of(std::string_view(" \0", 2), label.size() - 1);
  if (padding < kDefault.size())
    throw InputError(files.file, "ORG", "is missing, and the label has no room for its default");
  if (files.rewritten.empty()) files.rewritten = files.parts.front().bytes;
  const auto word = textAfter(label, "LBLSIZE").value_or(label);
  const auto at = static_cast<std::ptrdiff_t>(word.data() - label.data()) +
                  static_cast<std::ptrdiff_t>(firstWord(word).size());
  const auto begin = files.rewritten.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(label.size() - kDefault.size());
  std::copy_backward(begin + at, end, end + static_cast<std::ptrdiff_t>(kDefault.size()));
  std::copy(kDefault.begin(), kDefault.end(), begin + at);
}

constexpr std::int64_t kMostBytesOfSample = 8;
constexpr std::int64_t kMostPrefix = kMaxImageSide_px * kMostBytesOfSample;

void readVicarLabel(LabelFiles& files) {
  constexpr std::int64_t kMostLabel = 10 * 1024 * 1024;
  const auto& bytes = files.parts.front().bytes;
  const std::string_view text = asText(bytes);
  const std::int64_t size = statedInteger(text.substr(0, 64), "LBLSIZE").value_or(0);
  if (size < 16 || size > kMostLabel || size > static_cast<std::int64_t>(bytes.size()))
    throw InputError(
        files.file, "LBLSIZE",
        "is not the length of a label in this file of " + std::to_string(bytes.size()) + " bytes");
  const std::string_view label = text.substr(0, static_cast<std::size_t>(size));
  requireSize(files, label, "NL", 1, kMaxImageSide_px);
  requireSize(files, label, "NS", 1, kMaxImageSide_px);
  requireSize(files, label, "NB", 1, kMostLabelBands);
  requireSize(files, label, "NBB", 0, kMostPrefix);
  requireSize(files, label, "NLB", 0, kMaxImageSide_px);
  requireSize(files, label, "RECSIZE", 1, kMostPrefix + kMaxImageSide_px * kMostBytesOfSample);
  rewriteExponents(files, label, '\'');
  if (const auto end = vicarEndLabel(label); end && *end < static_cast<std::int64_t>(text.size())) {
    const std::string_view rest = text.substr(static_cast<std::size_t>(*end));
    const std::int64_t rest_size = statedInteger(rest.substr(0, 64), "LBLSIZE").value_or(0);
    if (rest_size > 0)
      rewriteExponents(files, rest.substr(0, static_cast<std::size_t>(rest_size)), '\'');
  }
  stateOrganization(files, label);
}

/// Up to the line END.
std::string_view pds3Label(std::string_view text) {
  text = text.substr(0, kMaxLabelBytes);
  for (auto at = text.find("\nEND"); at != std::string_view::npos; at = text.find("\nEND", at + 1))
    if (at + 4 == text.size() || isBlank(text[at + 4])) return text.substr(0, at);
  return {};
}

/// The file that the pointer ^IMAGE names in quotes; empty: the label's own. GDAL gets no other
/// file, and LabelRaster compares what GDAL makes of the pointer.
std::string pds3PixelsFile(std::string_view label) {
  std::string_view value = textAfter(label, "^IMAGE").value_or("");
  if (value.starts_with('(')) value = skipBlanks(value.substr(1));
  if (!value.starts_with('"') && !value.starts_with('\'')) return "";
  return std::string(value.substr(1, value.find(value.front(), 1) - 1));
}

std::string readPds3Label(LabelFiles& files) {
  const std::string_view label = pds3Label(asText(files.parts.front().bytes));
  if (label.empty())
    throw InputError(files.file, "the PDS3 label has no line END within the file's first 4 MB");
  if (!textAfter(label, "^IMAGE"))
    throw InputError(files.file,
                     "the label has no pointer ^IMAGE to the pixels of an object IMAGE");
  if (upperCase(label).find("PIXEL_INTERLEAVED") != std::string::npos)  // crashes GDAL 3.6
    throw InputError(files.file, "BAND_STORAGE_TYPE",
                     "bands stored as PIXEL_INTERLEAVED are not read");
  for (const char* key : {"LINES", "LINE_SAMPLES", "SAMPLE_BITS", "BANDS", "LINE_PREFIX_BYTES",
                          "LINE_SUFFIX_BYTES", "RECORD_BYTES"})
    requireSize(files, label, key, 0, 999'999'999);
  rewriteExponents(files, label, '"');
  return pds3PixelsFile(label);
}

std::string readPds4Label(LabelFiles& files) {
  if (files.parts.front().bytes.size() > kMaxLabelBytes)
    throw InputError(files.file, "the PDS4 label is larger than 4 MB");
  return readXmlLabel(files);
}

/// The files of that name in the folder of `file`: the one of the same case, if there is one, else
/// all that differ in case, as on discs that such labels were written for.
std::vector<fs::path> filesBeside(const fs::path& file, const std::string& name) {
  const fs::path folder = file.parent_path();
  std::error_code error;
  if (fs::exists(folder / name, error)) return {folder / name};
  const std::string wanted = lowerCase(name);
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, error))
    if (const fs::path other = entry.path().filename(); lowerCase(other.string()) == wanted)
      found.push_back(folder / other);
  std::sort(found.begin(), found.end());
  return found;
}

/// The file of that name, which may differ in case, in the label's folder.
fs::path fileBeside(const fs::path& label_file, const std::string& name) {
  const std::vector<fs::path> found = filesBeside(label_file, name);
  return found.empty() ? label_file.parent_path() / name : found.front();
}

/// None of a file that cannot be read.
std::vector<std::uint8_t> beginningOf(const fs::path& file, std::size_t count) {
  try {
    return readBeginning(file, count);
  } catch (const InputError&) {
    return {};
  }
}

/// Whether the label's pixels are those of the file.
bool names(const fs::path& label_file, const fs::path& file) {
  LabelFiles label;
  label.file = label_file;
  label.parts.push_back({"", beginningOf(label_file, kMaxLabelBytes)});
  const auto format = labelFormatOf(label.parts.front().bytes);
  std::string named;
  try {
    if (format == LabelFormat::kPds3)
      named = pds3PixelsFile(pds3Label(asText(label.parts.front().bytes)));
    if (format == LabelFormat::kPds4) named = readXmlLabel(label);
  } catch (const InputError&) {
    // Not a label that says so.
  }
  std::error_code error;
  return !named.empty() && fs::equivalent(fileBeside(label_file, named), file, error);
}

/// Reads the file of the pixels that the label names.
void readPixelsPart(LabelFiles& files, const std::string& name) {
  const bool plain = !name.empty() && name != "." && name != ".." && name.size() <= 255 &&
                     std::all_of(name.begin(), name.end(), [](char c) {
                       return static_cast<unsigned char>(c) >= 0x20 && c != '/' && c != '\\';
                     });
  if (!plain)
    throw InputError(files.file, "the label names the file '" + oneLine(name).substr(0, 80) +
                                     "', which is not in its folder: only a name without a folder "
                                     "is followed");
  const fs::path part = fileBeside(files.file, name);
  std::error_code error;
  // A label next to the pixels may name itself.
  if (fs::equivalent(part, files.file, error)) {
    files.parts.push_back({name, files.parts.front().bytes});
    return;
  }
  if (!fs::exists(part, error))
    throw InputError(files.file, "the file of its pixels, '" + name + "', is not in its folder");
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
  const std::string_view begin = skipBlanks(text);
  for (const std::string_view key : {"PDS_VERSION_ID", "ODL_VERSION_ID", "CCSD3ZF"})
    if (begin.starts_with(key)) return LabelFormat::kPds3;
  if (begin.starts_with('<') && isXmlLabel(text)) return LabelFormat::kPds4;
  return std::nullopt;
}

std::optional<std::int64_t> statedInteger(std::string_view label, std::string_view key) {
  return numberIn<std::int64_t>(firstWord(textAfter(label, key).value_or("")));
}

std::optional<std::int64_t> vicarEndLabel(std::string_view label) {
  const auto stated = [label](const char* key) { return statedInteger(label, key).value_or(0); };
  if (stated("EOL") != 1) return std::nullopt;
  // Behind compressed pixels; EOCI2 is of files beyond 4 GB.
  if (const std::int64_t compressed_end = stated("EOCI1"); compressed_end > 0)
    return compressed_end;
  const bool by_pixel = firstWord(textAfter(label, "ORG").value_or("")) == "'BIP'";
  const std::int64_t lines = stated("NL") * (by_pixel ? stated("NS") : stated("NB"));
  return stated("LBLSIZE") + stated("RECSIZE") * (stated("NLB") + lines);
}

std::optional<fs::path> labelFileOf(const fs::path& file) {
  auto begin = beginningOf(file, kBeginning);
  // Long comments may precede the first element.
  if (skipBlanks(withoutMark(asText(begin))).starts_with('<'))
    begin = beginningOf(file, kMaxLabelBytes);
  if (labelFormatOf(begin)) return file;
  if (begin.empty() || imageContainerOf(begin) != nullptr) return std::nullopt;
  for (const char* ending : {".lbl", ".LBL", ".xml", ".XML"})
    for (const fs::path& label : filesBeside(file, file.stem().string() + ending))
      if (label.filename() != file.filename() && names(label, file)) return label;
  return std::nullopt;
}

LabelFiles readLabelFiles(const fs::path& label_file) {
  std::vector<std::uint8_t> label_bytes = readFileBytes(label_file, kMaxImageFileBytes);
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
