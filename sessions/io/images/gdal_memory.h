// SPDX-License-Identifier: Apache-2.0
// GDAL on bytes in memory. Only for the source files that see GDAL's headers (CMakeLists.txt).
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_vsi.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>

#include "sessions/text/plain_text.h"

namespace boresight::sessions {

/// Keeps GDAL's messages of this thread off stderr; the destructor restores GDAL's settings.
class GdalQuiet {
 public:
  explicit GdalQuiet(bool vicar_in_pds3 = false)
      : vicar_in_pds3_("GDAL_TRY_PDS3_WITH_VICAR", vicar_in_pds3 ? "YES" : "NO", false) {}
  ~GdalQuiet() { CPLErrorReset(); }
  const std::string& failure() const { return failure_; }  ///< the first one
  const std::string& warning() const { return warning_; }  ///< the first one

 private:
  static void CPL_STDCALL keepMessage(CPLErr kind, CPLErrorNum, const char* message) {
    auto& self = *static_cast<GdalQuiet*>(CPLGetErrorHandlerUserData());
    std::string& kept = kind >= CE_Failure ? self.failure_ : self.warning_;
    if (kind >= CE_Warning && kept.empty()) kept = message;
  }

  std::string failure_, warning_;
  CPLErrorHandlerPusher handler_{keepMessage, this};
  CPLConfigOptionSetter side_files_{"GDAL_PAM_ENABLED", "NO", false};
  CPLConfigOptionSetter folders_{"GDAL_DISABLE_READDIR_ON_OPEN", "EMPTY_DIR", false};
  CPLConfigOptionSetter strips_{"GDAL_ENABLE_TIFF_SPLIT", "NO", false};  ///< as in the file
  CPLConfigOptionSetter vicar_in_pds3_;
};

/// Files in GDAL's memory, in a separate folder. The bytes must outlive them.
class GdalMemory {
 public:
  GdalMemory() {
    static std::atomic<std::uint64_t> next{0};
    folder_ = "/vsimem/boresight-" + std::to_string(++next) + "/";
  }
  GdalMemory(const GdalMemory&) = delete;
  GdalMemory& operator=(const GdalMemory&) = delete;
  ~GdalMemory() {
    for (const std::string& path : paths_) VSIUnlink(path.c_str());
    VSIUnlink(folder_.c_str());
  }
  /// The path by which GDAL opens the file.
  std::string add(const std::string& name, std::span<const std::uint8_t> bytes) {
    const std::string path = folder_ + name;
    VSILFILE* file =
        VSIFileFromMemBuffer(path.c_str(), const_cast<GByte*>(bytes.data()), bytes.size(), FALSE);
    if (file == nullptr) return path;
    paths_.push_back(path);
    VSIFCloseL(file);
    return path;
  }
  /// A message of GDAL without the folder's name.
  std::string plain(std::string text) const {
    for (auto at = text.find(folder_); at != std::string::npos; at = text.find(folder_))
      text.erase(at, folder_.size());
    return oneLine(text);
  }

 private:
  std::string folder_;
  std::vector<std::string> paths_;
};

struct GdalClose {
  void operator()(GDALDataset* dataset) const {
    const GdalQuiet quiet;
    GDALClose(dataset);
  }
};
using GdalDataset = std::unique_ptr<GDALDataset, GdalClose>;

/// Null where the driver cannot open the file. No other driver and no other file is tried.
inline GdalDataset openGdal(const char* driver, const std::string& path) {
  static std::once_flag once;
  std::call_once(once, [] {
    GDALRegister_VICAR();
    GDALRegister_PDS();
    GDALRegister_PDS4();
    GDALRegister_PNG();
    GDALRegister_JPEG();
    GDALRegister_GTiff();
  });
  const char* allowed[] = {driver, nullptr};
  const char* siblings[] = {nullptr};
  return GdalDataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, allowed,
                                       nullptr, siblings));
}

}  // namespace boresight::sessions
