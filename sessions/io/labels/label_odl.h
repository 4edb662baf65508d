// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace boresight::sessions {

/// A statement KEY = VALUE of a PDS3 label, in its Object Description Language.
struct OdlStatement {
  /// Objects and groups that it stands in, e.g. "FILE.IMAGE", upper case; for OBJECT, END_OBJECT
  /// and the like including the one that they begin or end. The reader's, until it reads on.
  std::string_view object;
  std::string key;  ///< upper case
  /// As written, with quotes or brackets, without a unit behind it; a part of the label's text.
  std::string_view value;
  std::string_view unit;  ///< of "3 <BYTES>" what stands between < and >
  std::size_t begin = 0;  ///< where it stands in the text
  std::size_t end = 0;
};

/// Reads a label's statements one by one, in time that grows with its length alone.
class OdlReader {
 public:
  explicit OdlReader(std::string_view text, std::size_t from = 0) : text_(text), at_(from) {}
  /// False at END, and where the text ends or is no statement.
  bool next(OdlStatement& statement);
  bool ended() const { return ended_; }         ///< END was read
  std::size_t position() const { return at_; }  ///< behind what was read

 private:
  char here(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  void skip();
  void skipLine();
  std::string_view word();
  std::string_view list();
  std::string_view value();
  void readUnit(OdlStatement& statement);
  bool enter(std::string_view name);
  void leave();

  std::string_view text_;
  std::size_t at_;
  bool ended_ = false;
  bool leaves_ = false;               ///< the statement before ends an object
  std::string object_;                ///< names joined by '.'
  std::vector<std::size_t> parents_;  ///< lengths of object_ without the innermost ones
};

/// Bytes of a label that are written otherwise for GDAL, as many as before.
struct LabelEdit {
  std::size_t at = 0;
  std::string text;
};

/// Where the pixels of a PDS3 label's IMAGE are: its pointer ^IMAGE.
struct Pds3Pointer {
  std::string file;         ///< as the label has it, without quotes; empty: the label's own
  std::int64_t number = 1;  ///< of a record or byte of that file, from 1
  bool in_bytes = false;
  bool nested = false;  ///< IMAGE stands in an OBJECT = FILE, and so does the pointer
  /// What GDAL would take otherwise than it is meant: names in '...', the storage of bands in
  /// quotes, and objects FILE and IMAGE after the first IMAGE, whose values it would mix in.
  std::vector<LabelEdit> edits;
  std::size_t label_size = 0;  ///< up to END
  std::string remark;          ///< of several IMAGE objects, which one is read; else empty
};

/// Of the text that a file with a PDS3 label begins with. InputError: no END, no IMAGE with a
/// pointer, a pointer that is no record, byte or name in quotes, a layout stated twice, bands
/// stored pixel by pixel.
Pds3Pointer readPds3Pointer(const std::filesystem::path& file, std::string_view text);

}  // namespace boresight::sessions
