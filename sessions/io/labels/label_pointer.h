// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace boresight::sessions {

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
  /// quotes, and objects FILE and IMAGE besides the first IMAGE, whose values it would mix in.
  std::vector<LabelEdit> edits;
  std::size_t label_size = 0;  ///< up to END
  std::string remark;          ///< of several IMAGE objects, which one is read; else empty
};

/// Of the text that a file with a PDS3 label begins with. InputError: no END, no IMAGE with a
/// pointer, a pointer that is no record, byte or name in quotes, a layout stated twice, bands
/// stored pixel by pixel.
Pds3Pointer readPds3Pointer(const std::filesystem::path& file, std::string_view text);

}  // namespace boresight::sessions
