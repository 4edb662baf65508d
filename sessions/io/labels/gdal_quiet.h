// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <cpl_conv.h>
#include <cpl_error.h>

namespace boresight::sessions {

/// While it lives, GDAL's messages in this thread go here and never to stderr; its settings are its
/// own again after. Only for the files that see GDAL's headers.
class GdalQuiet {
 public:
  explicit GdalQuiet(bool vicar_in_pds3 = false) {
    CPLPushErrorHandlerEx(keepMessage, &message_);
    set("GDAL_PAM_ENABLED", "NO");
    set("GDAL_DISABLE_READDIR_ON_OPEN", "EMPTY_DIR");
    set("GDAL_TRY_PDS3_WITH_VICAR", vicar_in_pds3 ? "YES" : "NO");
  }
  GdalQuiet(const GdalQuiet&) = delete;
  GdalQuiet& operator=(const GdalQuiet&) = delete;
  ~GdalQuiet() {
    for (const auto& [key, before] : settings_)
      CPLSetThreadLocalConfigOption(key, before.empty() ? nullptr : before.c_str());
    CPLPopErrorHandler();
    CPLErrorReset();
  }
  /// The first failure that GDAL told of.
  const std::string& message() const { return message_; }

 private:
  static void CPL_STDCALL keepMessage(CPLErr kind, CPLErrorNum, const char* message) {
    auto* kept = static_cast<std::string*>(CPLGetErrorHandlerUserData());
    if (kept != nullptr && kind >= CE_Failure && kept->empty()) *kept = message;
  }
  void set(const char* key, const char* value) {
    const char* before = CPLGetThreadLocalConfigOption(key, nullptr);
    settings_.emplace_back(key, before != nullptr ? before : "");
    CPLSetThreadLocalConfigOption(key, value);
  }

  std::string message_;
  std::vector<std::pair<const char*, std::string>> settings_;
};

}  // namespace boresight::sessions
