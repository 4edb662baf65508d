// SPDX-License-Identifier: Apache-2.0
#include "sessions/annotation/annotations_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_reader.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/text/text_reading.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

constexpr std::array<const char*, 16> kColumns = {
    "kind", "id",   "x1_px", "y1_px", "x2_px",    "y2_px",   "x1_m",   "y1_m",
    "z1_m", "x2_m", "y2_m",  "z2_m",  "sigma_px", "enabled", "locked", "comment"};
constexpr std::size_t kFirstPixel = 2;
constexpr std::size_t kFirstPlace = 6;
constexpr std::size_t kSigma = 12;

using Row = std::array<std::string, kColumns.size()>;

std::string lineOf(const Row& row) {
  std::string line;
  for (const std::string& field : row)
    line += (&field == &row.front() ? "" : ",") + csvField(field);
  return line + "\r\n";
}

template <class Vector>
void put(const Vector& values, std::size_t column, Row& row) {
  for (Eigen::Index i = 0; i < values.size(); ++i)
    row[column + static_cast<std::size_t>(i)] = numberText(values[i]);
}

template <class Pair>
Row commonRow(const char* kind, const Pair& pair) {
  Row row;
  row[0] = kind;
  row[1] = pair.id;
  row[kSigma] = numberText(pair.sigma_px);
  row[kSigma + 1] = pair.enabled ? "1" : "0";
  row[kSigma + 2] = pair.locked ? "1" : "0";
  row[kSigma + 3] = pair.comment;
  return row;
}

/// A record of the text: its fields, and the line that it begins in.
struct Record {
  std::vector<std::string> fields;
  int line = 0;
};

/// Reads the records of a text (RFC 4180); lines may also end with a line feed,
/// or a carriage return, alone.
class CsvReader {
 public:
  CsvReader(const std::filesystem::path& file, std::string_view text) : file_(file), text_(text) {}

  /// Goes to the next record that has a field; spreadsheets write empty rows behind the last one.
  bool next(Record& record) {
    do {
      if (at_ >= text_.size()) return false;
      read(record);
    } while (std::ranges::all_of(record.fields, &std::string::empty));
    return true;
  }

 private:
  [[noreturn]] void fail(int line, const char* reason) const {
    throw InputError(file_, "line " + std::to_string(line), reason);
  }

  void read(Record& record) {
    record = {{}, line_};
    for (bool more = true; more; at_ += more ? 1 : 0) {
      record.fields.push_back(
          textOfCsvField(at_ < text_.size() && text_[at_] == '"' ? quoted() : plain()));
      more = at_ < text_.size() && text_[at_] == ',';
    }
    const bool carriage_return = at_ < text_.size() && text_[at_] == '\r';
    if (carriage_return) ++at_;
    const bool line_feed = at_ < text_.size() && text_[at_] == '\n';
    if (line_feed) ++at_;
    if (!carriage_return && !line_feed && at_ < text_.size())
      fail(line_, "text follows a closing quote");
    ++line_;
  }

  std::string plain() {
    const std::size_t end = std::min(text_.find_first_of(",\r\n", at_), text_.size());
    return std::string(text_.substr(std::exchange(at_, end), end - at_));
  }

  std::string quoted() {
    const int begun = line_;
    std::string field;
    for (++at_;; ++at_) {
      if (at_ >= text_.size()) fail(begun, "closing quote is missing");
      if (text_[at_] == '\n') ++line_;
      if (text_[at_] == '"' && !text_.substr(++at_).starts_with('"')) return field;
      field += text_[at_];
    }
  }

  const std::filesystem::path& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// The fields of a record by column; every message names line and column.
class RowReader {
 public:
  RowReader(const std::filesystem::path& file, const Record& record)
      : file_(file), record_(record) {
    if (record.fields.size() != kColumns.size())
      throw InputError(file, "line " + std::to_string(record.line),
                       "has " + std::to_string(record.fields.size()) + " fields, needs " +
                           std::to_string(kColumns.size()));
  }

  const std::string& text(std::size_t column) const { return record_.fields[column]; }

  [[noreturn]] void fail(std::size_t column, const std::string& reason) const {
    throw InputError(file_, "line " + std::to_string(record_.line) + ", " + kColumns[column],
                     reason);
  }

  double number(std::size_t column) const {
    const auto value = realIn(text(column));
    if (!value) fail(column, noNumberText(text(column)));
    if (!std::isfinite(*value)) fail(column, shortWord(text(column)) + " is too large");
    return *value;
  }

  bool flag(std::size_t column) const {
    if (text(column) != "0" && text(column) != "1") fail(column, "must be 0 or 1");
    return text(column) == "1";
  }

  /// Nothing where all fields are empty.
  template <int N>
  std::optional<Eigen::Matrix<double, N, 1>> vector(std::size_t column) const {
    bool empty = true;
    for (std::size_t i = 0; i < N; ++i) empty = empty && text(column + i).empty();
    if (empty) return {};
    Eigen::Matrix<double, N, 1> matrix;
    for (std::size_t i = 0; i < N; ++i) matrix[static_cast<Eigen::Index>(i)] = number(column + i);
    return matrix;
  }

  template <class Pair>
  void readCommon(Pair& pair) const {
    pair.id = text(1);
    if (pair.id.empty()) fail(1, "is empty");
    pair.sigma_px = number(kSigma);
    if (!(pair.sigma_px >= 1e-6 && pair.sigma_px <= 1e4)) fail(kSigma, "is outside 1e-06 .. 10000");
    pair.enabled = flag(kSigma + 1);
    pair.locked = flag(kSigma + 2);
    pair.comment = text(kSigma + 3);
  }

 private:
  const std::filesystem::path& file_;
  const Record& record_;
};

PointPair readPoint(const RowReader& row) {
  PointPair point;
  row.readCommon(point);
  point.pixel = row.vector<2>(kFirstPixel);
  point.point_in_station_m = row.vector<3>(kFirstPlace);
  for (const std::size_t column :
       {kFirstPixel + 2, kFirstPixel + 3, kFirstPlace + 3, kFirstPlace + 4, kFirstPlace + 5})
    if (!row.text(column).empty()) row.fail(column, "a point has only one pixel");
  return point;
}

LinePair readLine(const RowReader& row) {
  LinePair line;
  row.readCommon(line);
  const auto start = row.vector<2>(kFirstPixel);
  const auto end = row.vector<2>(kFirstPixel + 2);
  if (start.has_value() != end.has_value() || (start && *start == *end))
    row.fail(kFirstPixel, "a line needs two pixels, or none");
  if (start) line.line = ImageLine{*start, *end};
  const auto from = row.vector<3>(kFirstPlace);
  const auto to = row.vector<3>(kFirstPlace + 3);
  if (from.has_value() != to.has_value() || (from && *from == *to))
    row.fail(kFirstPlace, "an edge needs two points of the station, or none");
  if (from) line.edge = ModelEdge{*from, *to};
  return line;
}

/// Whether the header has semicolons or tabs, as spreadsheets of countries with decimal commas
/// write.
bool isSplitOtherwise(const Record& header) {
  return header.fields.size() == 1 && header.fields[0].starts_with(kColumns[0]) &&
         header.fields[0].find_first_of(";\t") != std::string::npos;
}

}  // namespace

std::string annotationsCsv(const Annotations& annotations) {
  Row header;
  for (std::size_t i = 0; i < kColumns.size(); ++i) header[i] = kColumns[i];
  std::string text = lineOf(header);
  for (const PointPair& point : annotations.points) {
    Row row = commonRow("point", point);
    if (point.pixel) put(*point.pixel, kFirstPixel, row);
    if (point.point_in_station_m) put(*point.point_in_station_m, kFirstPlace, row);
    text += lineOf(row);
  }
  for (const LinePair& line : annotations.lines) {
    Row row = commonRow("line", line);
    if (line.line) {
      put(line.line->start, kFirstPixel, row);
      put(line.line->end, kFirstPixel + 2, row);
    }
    if (line.edge) {
      put(line.edge->start_in_station_m, kFirstPlace, row);
      put(line.edge->end_in_station_m, kFirstPlace + 3, row);
    }
    text += lineOf(row);
  }
  return text;
}

Annotations parseAnnotationsCsv(const std::filesystem::path& file, std::string_view text) {
  CsvReader reader(file, text);
  Record record;
  if (!reader.next(record) ||
      record.fields != std::vector<std::string>(kColumns.begin(), kColumns.end()))
    throw InputError(file, "line 1",
                     "is not the header of an annotation table (kind,id,x1_px,...)" +
                         std::string(isSplitOtherwise(record)
                                         ? ": save it with commas between fields and points in "
                                           "numbers"
                                         : ""));
  Annotations annotations;
  std::set<std::string> ids;
  while (reader.next(record)) {
    const RowReader row(file, record);
    for (std::size_t column = 0; column < kColumns.size(); ++column)
      if (!isUtf8(row.text(column))) row.fail(column, "is not UTF-8 text: save the table as UTF-8");
    if (!ids.insert(row.text(1)).second) row.fail(1, "'" + row.text(1) + "' is given twice");
    if (row.text(0) == "point") {
      annotations.points.push_back(readPoint(row));
    } else if (row.text(0) == "line") {
      annotations.lines.push_back(readLine(row));
    } else {
      row.fail(0, "must be point or line");
    }
  }
  return annotations;
}

}  // namespace boresight::sessions
