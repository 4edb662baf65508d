// SPDX-License-Identifier: Apache-2.0
#include "app/display.h"

#include <dlfcn.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace boresight::app {
namespace {

/// Connects as Qt's plugin does, with the user's authorization. The library is loaded by name: the
/// plugin needs it, this program is not linked to it.
bool xAnswers() {
  using Connect = void* (*)(const char*, int*);
  using HasError = int (*)(void*);
  using Disconnect = void (*)(void*);
  void* library = ::dlopen("libxcb.so.1", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return true;
  const auto connect = reinterpret_cast<Connect>(::dlsym(library, "xcb_connect"));
  const auto has_error = reinterpret_cast<HasError>(::dlsym(library, "xcb_connection_has_error"));
  const auto disconnect = reinterpret_cast<Disconnect>(::dlsym(library, "xcb_disconnect"));
  if (connect == nullptr || has_error == nullptr || disconnect == nullptr) return true;
  void* connection = connect(nullptr, nullptr);  // never null: an error is a state of it
  const bool answers = has_error(connection) == 0;
  disconnect(connection);
  return answers;
}

std::string fromEnvironment(const char* name, const std::string& otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : otherwise;
}

bool waylandAnswers() {
  const std::string name = fromEnvironment("WAYLAND_DISPLAY", "wayland-0");
  const std::string path =
      name.front() == '/' ? name : fromEnvironment("XDG_RUNTIME_DIR", "/") + "/" + name;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return false;
  std::memcpy(address.sun_path, path.c_str(), path.size());
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return true;
  const bool answers =
      ::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  ::close(descriptor);
  return answers;
}

}  // namespace

bool displayAnswers(const std::string& platform) {
  // "wayland;xcb" is a list of fallbacks; a platform's settings follow a colon.
  bool asked = false;
  for (std::size_t begin = 0; begin <= platform.size();) {
    const std::size_t end = std::min(platform.find(';', begin), platform.size());
    const std::string name = platform.substr(begin, end - begin);
    begin = end + 1;
    if (name.starts_with("xcb")) {
      if (xAnswers()) return true;
    } else if (name.starts_with("wayland")) {
      if (waylandAnswers()) return true;
    } else if (!name.empty()) {
      return true;
    }
    asked = asked || !name.empty();
  }
  return !asked;
}

}  // namespace boresight::app
