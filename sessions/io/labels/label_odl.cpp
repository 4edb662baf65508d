// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_odl.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>

#include "sessions/io/errors.h"
#include "sessions/io/labels/label_values.h"

namespace boresight::sessions {
namespace {

constexpr std::size_t kMostDepth = 64;  ///< of objects within objects

bool isLineEnd(char c) { return c == '\n' || c == '\r'; }

/// The name of an object, which may stand in quotes.
std::string nameIn(std::string_view value) {
  if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
    value = value.substr(1, value.size() - 2);
  return upperCase(value);
}

namespace fs = std::filesystem;

/// From OBJECT to END_OBJECT.
struct Extent {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// An object IMAGE, at the label's top or in an object FILE.
struct ImageObject {
  std::optional<OdlStatement> pointer;
  std::optional<OdlStatement> storage;  ///< BAND_STORAGE_TYPE
  bool has_bands = false;               ///< more than one
  bool has_samples = false;             ///< LINE_SAMPLES is stated
  std::vector<Extent> extents;          ///< of all of this name, the first one first
  std::set<std::string> layout;         ///< what is stated of the layout
};

struct Objects {
  ImageObject top;
  ImageObject nested;
  std::vector<Extent> files;  ///< OBJECT = FILE
  std::size_t file = 0;       ///< which of them has the first IMAGE; counted from 1
};

bool begins(const OdlStatement& statement) {
  return statement.key == "OBJECT" || statement.key == "GROUP";
}
bool ends(const OdlStatement& statement) {
  return statement.key == "END_OBJECT" || statement.key == "END_GROUP";
}

/// Whether the statement begins or ends one of these.
bool noteExtent(const OdlStatement& statement, std::vector<Extent>& extents) {
  if (begins(statement)) extents.push_back({statement.begin, statement.end});
  if (ends(statement) && !extents.empty()) extents.back().end = statement.end;
  return begins(statement) || ends(statement);
}

/// GDAL takes the first value of a key, its tree of the label the last.
void requireOnce(const fs::path& file, const std::string& key, ImageObject& image) {
  for (const char* layout : {"LINES", "LINE_SAMPLES", "SAMPLE_BITS", "SAMPLE_TYPE", "BANDS",
                             "BAND_STORAGE_TYPE", "LINE_PREFIX_BYTES", "LINE_SUFFIX_BYTES"})
    if (key == layout && !image.layout.insert(key).second)
      throw InputError(file, key, "is stated twice in the label's object IMAGE");
}

/// GDAL reads 1 of 1e3, and of numbers beyond 32 bits what is left of them.
void requirePlainNumber(const fs::path& file, const OdlStatement& statement) {
  constexpr std::string_view kDigits = "0123456789";
  constexpr std::size_t kMostDigits = 9;
  for (const char* size : {"LINES", "LINE_SAMPLES", "SAMPLE_BITS", "BANDS", "LINE_PREFIX_BYTES",
                           "LINE_SUFFIX_BYTES", "RECORD_BYTES"})
    if (statement.key == size && statement.value.find_first_of(kDigits) != std::string_view::npos &&
        (statement.value.find_first_not_of(kDigits) != std::string_view::npos ||
         statement.value.size() > kMostDigits))
      throw InputError(
          file, statement.key,
          oneLine(statement.value.substr(0, 80)) + " is no whole number of at most nine digits");
}

void noteImage(const fs::path& file, const OdlStatement& statement, ImageObject& image) {
  if (noteExtent(statement, image.extents) || image.extents.size() != 1) return;
  requirePlainNumber(file, statement);
  requireOnce(file, statement.key, image);
  if (statement.key == "LINE_SAMPLES") image.has_samples = true;
  if (statement.key == "BAND_STORAGE_TYPE") image.storage = statement;
  if (statement.key == "BANDS") image.has_bands = statement.value != "1";
  if (statement.key == "AXIS_NAME")
    throw InputError(file, "AXIS_NAME", "an IMAGE of axes is not read");
}

void note(const fs::path& file, const OdlStatement& statement, Objects& objects) {
  if (statement.object == "COMPRESSED_FILE" || statement.object == "UNCOMPRESSED_FILE")
    throw InputError(file, std::string(statement.object), "compressed pixels are not read");
  if (statement.key == "RECORD_BYTES") requirePlainNumber(file, statement);
  if (statement.object.empty() && statement.key == "^IMAGE" && !objects.top.pointer)
    objects.top.pointer = statement;
  if (statement.object == "IMAGE") noteImage(file, statement, objects.top);
  if (statement.object == "FILE") {
    // The pointer of the object FILE that has the image, not of one before.
    if (begins(statement) && objects.file == 0) objects.nested.pointer.reset();
    const bool own = objects.file == 0 || objects.file == objects.files.size();
    if (!noteExtent(statement, objects.files) && statement.key == "^IMAGE" && own &&
        !objects.nested.pointer)
      objects.nested.pointer = statement;
  }
  if (statement.object == "FILE.IMAGE") {
    noteImage(file, statement, objects.nested);
    if (objects.file == 0) objects.file = objects.files.size();
  }
}

std::size_t lineAt(std::string_view text, std::size_t at) {
  return 1 + static_cast<std::size_t>(
                 std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

Objects objectsOf(const fs::path& file, std::string_view text, std::size_t& label_size) {
  Objects objects;
  const auto version = text.find("PDS_VERSION_ID");  // GDAL reads from there
  OdlReader reader(text, version == std::string_view::npos ? 0 : version);
  OdlStatement statement;
  while (reader.next(statement)) note(file, statement, objects);
  label_size = reader.position();
  if (reader.ended()) return objects;
  if (reader.position() >= text.size())
    throw InputError(file, "the label has no line END within the file's first " +
                               std::to_string(text.size()) + " bytes");
  if (statement.key == "OBJECT" || statement.key == "GROUP")
    throw InputError(file, "the label's objects are nested deeper than 64");
  throw InputError(file, "line " + std::to_string(lineAt(text, statement.begin)) +
                             " of the label is no statement KEY = VALUE, nor is it END");
}

[[noreturn]] void refusePointer(const fs::path& file, std::string_view value) {
  throw InputError(file, "^IMAGE",
                   "'" + oneLine(value.substr(0, 80)) +
                       "' is neither the number of a record or a byte nor a file's name in quotes");
}

/// 3, or 10851 <BYTES>. False for anything else, also where GDAL would take bytes for records.
bool readPlace(std::string_view text, Pds3Pointer& pointer) {
  text = skipBlanks(text);
  const auto [stop, error] =
      std::from_chars(text.data(), text.data() + text.size(), pointer.number);
  if (error != std::errc() || pointer.number < 1) return false;
  text = skipBlanks(text.substr(static_cast<std::size_t>(stop - text.data())));
  pointer.in_bytes = text.starts_with("<BYTES>");
  if (pointer.in_bytes) text.remove_prefix(std::string_view("<BYTES>").size());
  return skipBlanks(text).empty();
}

/// A name in quotes that `rest` begins with; `rest` becomes what is behind it.
bool readName(std::string_view label, std::string_view& rest, Pds3Pointer& pointer) {
  const char quote = rest.empty() ? '\0' : rest.front();
  if (quote != '"' && quote != '\'') return false;
  const auto end = rest.find(quote, 1);
  if (end == std::string_view::npos || end == 1) return false;
  pointer.file = std::string(rest.substr(1, end - 1));
  const auto at = static_cast<std::size_t>(rest.data() - label.data());
  if (quote == '\'') pointer.edits.insert(pointer.edits.end(), {{at, "\""}, {at + end, "\""}});
  rest = skipBlanks(rest.substr(end + 1));
  return true;
}

/// "X.IMG", ("X.IMG"), ("X.IMG", 3) or ("X.IMG", 12 <BYTES>).
bool readNameAndPlace(std::string_view label, std::string_view value, Pds3Pointer& pointer) {
  if (!value.starts_with('(')) return readName(label, value, pointer) && value.empty();
  if (!value.ends_with(')')) return false;
  value = skipBlanks(value.substr(1, value.size() - 2));
  if (!readName(label, value, pointer)) return false;
  return value.empty() || (value.starts_with(',') && readPlace(value.substr(1), pointer));
}

void readPointer(const fs::path& file, std::string_view label, const OdlStatement& statement,
                 Pds3Pointer& pointer) {
  const std::string unit = statement.unit.empty() ? "" : " <" + std::string(statement.unit) + ">";
  if (!readPlace(std::string(statement.value) + unit, pointer) &&
      !readNameAndPlace(label, statement.value, pointer))
    refusePointer(file, statement.value);
}

/// The word without quotes, which GDAL would not know. Bands pixel by pixel are not for GDAL: it
/// fails when it closes them.
void editStorage(const fs::path& file, std::string_view label, const ImageObject& image,
                 Pds3Pointer& pointer) {
  const std::string_view value = image.storage->value;
  std::string word = upperCase(value);
  std::erase_if(word, [](char c) { return c == '"' || c == '\''; });
  if (image.has_bands && (word == "SAMPLE_INTERLEAVED" || word == "PIXEL_INTERLEAVED"))
    throw InputError(file, "BAND_STORAGE_TYPE",
                     "bands stored as " + word + " are not read; BAND_SEQUENTIAL is");
  word.resize(value.size(), ' ');
  if (word != value)
    pointer.edits.push_back({static_cast<std::size_t>(value.data() - label.data()), word});
}

void blank(const std::vector<Extent>& extents, std::size_t but, Pds3Pointer& pointer) {
  for (std::size_t i = 0; i < extents.size(); ++i)
    if (i != but)
      pointer.edits.push_back(
          {extents[i].begin, std::string(extents[i].end - extents[i].begin, ' ')});
}

}  // namespace

void OdlReader::skipLine() {
  while (at_ < text_.size() && !isLineEnd(here()) && here() != '\0') ++at_;
}

/// Blanks, comments /* ... */ with the rest of their line, and those from '#' on.
void OdlReader::skip() {
  while (at_ < text_.size()) {
    if (here() == '/' && here(1) == '*') {
      at_ = std::min(text_.find("*/", at_ + 2), text_.size());
      skipLine();
    } else if (isBlank(here()) && here(1) == '#') {
      ++at_;
      skipLine();
    } else if (isBlank(here())) {
      ++at_;
    } else {
      return;
    }
  }
}

/// A text in quotes, or all up to a blank or '='.
std::string_view OdlReader::word() {
  const std::size_t begin = at_;
  const char quote = here();
  if (quote == '"' || quote == '\'') {
    const auto end = text_.find(quote, at_ + 1);
    at_ = end == std::string_view::npos ? text_.size() : end + 1;
    return text_.substr(begin, at_ - begin);
  }
  while (at_ < text_.size() && here() != '\0' && here() != '=' && !isBlank(here())) ++at_;
  return text_.substr(begin, at_ - begin);
}

/// From a bracket to the one that closes it; brackets in quotes are none.
std::string_view OdlReader::list() {
  const std::size_t begin = at_;
  const char open = here();
  const char close = open == '(' ? ')' : '}';
  int depth = 0;
  while (at_ < text_.size() && here() != '\0') {
    const char c = here();
    if (c == '"') {
      (void)word();
      continue;
    }
    ++at_;
    if (c == open) ++depth;
    if (c == close && --depth == 0) break;
  }
  return text_.substr(begin, at_ - begin);
}

std::string_view OdlReader::value() { return here() == '(' || here() == '{' ? list() : word(); }

void OdlReader::readUnit(OdlStatement& statement) {
  const std::size_t behind_value = at_;
  skip();
  if (here() != '<') {
    at_ = behind_value;
    return;
  }
  const auto end = std::min(text_.find('>', at_), text_.size());
  statement.unit = text_.substr(at_ + 1, end - at_ - 1);
  at_ = std::min(end + 1, text_.size());
}

bool OdlReader::enter(std::string_view name) {
  if (parents_.size() == kMostDepth) return false;
  parents_.push_back(object_.size());
  object_ += (object_.empty() ? "" : ".") + nameIn(name);
  return true;
}

void OdlReader::leave() {
  leaves_ = false;
  if (parents_.empty()) return;
  object_.resize(parents_.back());
  parents_.pop_back();
}

bool OdlReader::next(OdlStatement& statement) {
  if (leaves_) leave();
  skip();
  statement = OdlStatement();
  statement.begin = at_;
  statement.key = upperCase(word());
  ended_ = statement.key == "END";
  if (ended_ || statement.key.empty()) return false;
  skip();
  leaves_ = statement.key == "END_OBJECT" || statement.key == "END_GROUP";
  if (here() != '=' && !leaves_) return false;
  if (here() == '=') {
    ++at_;
    skip();
    statement.value = value();
    readUnit(statement);
  }
  statement.end = at_;
  if ((statement.key == "OBJECT" || statement.key == "GROUP") && !enter(statement.value))
    return false;
  statement.object = object_;
  return true;
}

Pds3Pointer readPds3Pointer(const fs::path& file, std::string_view text) {
  Pds3Pointer pointer;
  Objects objects = objectsOf(file, text, pointer.label_size);
  pointer.nested = !objects.top.has_samples && objects.nested.has_samples;
  const ImageObject& image = pointer.nested ? objects.nested : objects.top;
  if (!image.pointer)
    throw InputError(file, "the label has no pointer ^IMAGE to the pixels of an object IMAGE");
  readPointer(file, text, *image.pointer, pointer);
  if (image.storage) editStorage(file, text, image, pointer);
  blank(image.extents, 0, pointer);
  if (pointer.nested) blank(objects.files, objects.file - 1, pointer);
  if (image.extents.size() > 1)
    pointer.remark = "the label has " + std::to_string(image.extents.size()) +
                     " objects IMAGE; the first is read";
  return pointer;
}

}  // namespace boresight::sessions
