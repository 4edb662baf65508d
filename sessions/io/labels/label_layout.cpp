// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_layout.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "sessions/io/errors.h"
#include "sessions/io/file_bytes.h"
#include "sessions/io/labels/label_values.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

std::int64_t integerOf(const json* group, const char* key) {
  return labelInteger(labelMember(group, key)).value_or(0);
}

std::string wordOf(const json* group, const char* key) {
  return upperCase(labelText(labelMember(group, key)).value_or(""));
}

bool contains(const std::string& text, const char* word) {
  return text.find(word) != std::string::npos;
}

/// Nothing for types that do not say it.
std::optional<bool> isLittleEndian(const std::string& type) {
  for (const char* little : {"LSB", "PC_"})
    if (type.starts_with(little)) return true;
  for (const char* big :
       {"MSB", "MAC_", "SUN_", "IEEE_", "INTEGER", "UNSIGNED_INTEGER", "REAL", "FLOAT"})
    if (type.starts_with(big)) return false;
  return std::nullopt;
}

/// What the label states, as bytes from one sample to the next.
struct Steps {
  std::int64_t pixel = 0;
  std::int64_t line = 0;
  std::int64_t band = 0;
};

/// Nothing for an order of bands of another name.
std::optional<Steps> statedSteps(const std::string& storage, const RasterLayout& layout,
                                 std::int64_t prefix) {
  const std::int64_t item = bitsOf(layout.type) / 8;
  const std::int64_t row = item * layout.width;
  if (layout.bands == 1) return Steps{item, prefix + row, 0};
  // Whether a prefix then is of every band, labels do not tell.
  if (storage == "LINE_INTERLEAVED" && prefix == 0) return Steps{item, row * layout.bands, row};
  if (storage == "BAND_SEQUENTIAL" || storage.empty())
    return Steps{item, prefix + row, (prefix + row) * layout.height};
  return std::nullopt;
}

/// Bytes before the first record or byte that ^IMAGE names.
std::int64_t statedOffset(const LabelFiles& files, const json& label) {
  const json* pointer = labelMember(&label, "^IMAGE");
  const json first = 1;
  const bool names_file = pointer != nullptr && (pointer->is_string() || pointer->is_array());
  if (names_file) pointer = pointer->is_array() && pointer->size() > 1 ? &(*pointer)[1] : &first;
  const std::int64_t number = labelInteger(pointer).value_or(0);
  if (number < 1 || names_file != (files.parts.size() > 1))
    throw InputError(files.file, "^IMAGE",
                     "is neither a record, a byte nor a file's name in quotes");
  if (number == 1 || labelUnit(pointer) == "BYTES") return number - 1;
  const std::int64_t record = integerOf(&label, "RECORD_BYTES");
  if (record < 1 || number > std::int64_t{1} << 30)
    throw InputError(files.file, "^IMAGE",
                     "counts records, but the label states no length of them (RECORD_BYTES)");
  return (number - 1) * record;
}

/// GDAL knows the number of a sample's bits, but not the type: 32 bits are floating-point numbers.
void requireStatedType(const LabelFiles& files, const json* image, const RasterLayout& layout) {
  const std::string stated = wordOf(image, "SAMPLE_TYPE");
  const int bits = bitsOf(layout.type);
  const auto refuse = [&](const std::string& why) {
    throw InputError(files.file, "SAMPLE_TYPE",
                     "samples of the type " + stated + " and " + std::to_string(bits) +
                         " bits are not read" + why);
  };
  if (contains(stated, "VAX") || contains(stated, "COMPLEX")) refuse("");
  const bool integer = contains(stated, "INTEGER") || stated == "MSB" || stated == "LSB";
  if (!stated.empty() && integer == isFloating(layout.type)) refuse("");
  const auto little = isLittleEndian(stated);
  if (bits > 8 && little && *little != layout.little_endian)
    refuse(": the order of their bytes is ambiguous");
}

/// The label's items at the end of a VICAR file, which begin at this byte, are there to the last.
void requireEndLabel(const LabelFiles& files, std::int64_t at) {
  const std::string_view text = asText(files.labelBytes());
  const std::string_view end = text.substr(std::min(static_cast<std::size_t>(at), text.size()));
  const auto size = statedInteger(end.substr(0, 64), "LBLSIZE");
  if (!size || *size < 1 || static_cast<std::uint64_t>(*size) > end.size())
    throw InputError(files.file, "EOL",
                     "the part of the label at the file's end is not there in full");
}

}  // namespace

const char* sampleTypeName(SampleType type) {
  constexpr const char* kNames[] = {
      "8-bit unsigned integers",       "8-bit signed integers",        "16-bit unsigned integers",
      "16-bit signed integers",        "32-bit unsigned integers",     "32-bit signed integers",
      "32-bit floating-point numbers", "64-bit floating-point numbers"};
  return kNames[static_cast<int>(type)];
}

int bitsOf(SampleType type) {
  constexpr int kBits[] = {8, 8, 16, 16, 32, 32, 32, 64};
  return kBits[static_cast<int>(type)];
}

void requireStatedLayout(const LabelFiles& files, const json& label, const RasterLayout& layout) {
  const json* image = labelMember(&label, "IMAGE");
  requireStatedType(files, image, layout);
  for (const auto& [key, used] : {std::pair{"LINES", layout.height},
                                  {"LINE_SAMPLES", layout.width},
                                  {"SAMPLE_BITS", bitsOf(layout.type)}})
    if (integerOf(image, key) != used)
      throw InputError(files.file, key,
                       "the label's object IMAGE states " + std::to_string(integerOf(image, key)) +
                           ", but it would be read as " + std::to_string(used));
  if (integerOf(image, "LINE_SUFFIX_BYTES") != 0)
    throw InputError(files.file, "LINE_SUFFIX_BYTES",
                     "bytes behind every line of the image are not read");
  const std::int64_t prefix = integerOf(image, "LINE_PREFIX_BYTES");
  const std::int64_t offset = statedOffset(files, label) + prefix;
  const std::string storage = wordOf(image, "BAND_STORAGE_TYPE");
  const auto steps = statedSteps(storage, layout, prefix);
  const bool same_steps = steps && steps->pixel == layout.pixel_step &&
                          steps->line == layout.line_step &&
                          (layout.bands == 1 || steps->band == layout.band_step);
  if (!same_steps)
    throw InputError(files.file, "BAND_STORAGE_TYPE",
                     std::to_string(layout.bands) + " bands stored as " +
                         (storage.empty() ? "BAND_SEQUENTIAL" : storage) + ", " +
                         std::to_string(prefix) + " bytes before every line, are not read");
  if (offset != static_cast<std::int64_t>(layout.offset))
    throw InputError(files.file, "^IMAGE",
                     "names byte " + std::to_string(offset) + ", but it would be read as byte " +
                         std::to_string(layout.offset));
}

void requireStatedRecords(const LabelFiles& files, const json& label, const RasterLayout& layout) {
  const std::string_view text = asText(files.labelBytes());
  const std::int64_t label_size = statedInteger(text, "LBLSIZE").value_or(0);
  const auto stated = [own = text.substr(0, static_cast<std::size_t>(label_size))](
                          const char* key) { return statedInteger(own, key).value_or(0); };
  const std::string order = wordOf(&label, "ORG");
  const bool by_pixel = order == "BIP";
  // A record is then one pixel, and each would have a prefix: nobody reads that right.
  if (stated("NBB") > 0 && by_pixel)
    throw InputError(files.file, "NBB", "a prefix of every pixel (ORG='BIP') is not read");
  if (stated("NBB") > 0 && order == "BIL" && layout.bands > 1)
    throw InputError(files.file, "NBB",
                     "a prefix of every line of every band (ORG='BIL') is not read");
  const std::int64_t record =
      stated("NBB") + (by_pixel ? layout.bands : layout.width) * (bitsOf(layout.type) / 8);
  if (stated("RECSIZE") != record)
    throw InputError(files.file, "RECSIZE",
                     std::to_string(stated("RECSIZE")) +
                         " contradicts the label's other sizes, by which a record has " +
                         std::to_string(record) + " bytes");
  if (label_size % record != 0)
    throw InputError(files.file, "LBLSIZE",
                     std::to_string(label_size) + " is no multiple of the " +
                         std::to_string(record) + " bytes of a record");
  if (stated("EOL") != 1) return;
  const std::int64_t lines = std::int64_t{layout.height} * (by_pixel ? layout.width : layout.bands);
  const std::int64_t compressed_end = stated("EOCI1");  // EOCI2 is of files beyond 4 GB
  requireEndLabel(
      files, compressed_end > 0 ? compressed_end : label_size + record * (stated("NLB") + lines));
}

}  // namespace boresight::sessions
