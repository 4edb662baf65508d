// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/mesh_files.h"

#include <system_error>

#include "core/base/digest.h"
#include "sessions/io/errors.h"
#include "sessions/io/json_document.h"

namespace boresight::sessions {
namespace {

namespace fs = std::filesystem;

/// The file name of a URI, in which %20 and the like stand for characters.
std::string nameOf(const std::string& uri) {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const std::string digits = uri[i] == '%' ? uri.substr(i + 1, 2) : "";
    if (digits.size() == 2 &&
        digits.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos) {
      name += static_cast<char>(std::stoi(digits, nullptr, 16));
      i += 2;
    } else {
      name += uri[i];
    }
  }
  return name;
}

/// Whether the name leads to a place in the file's folder, also where its parts are links.
bool staysBeside(const fs::path& file, const fs::path& name) {
  if (name.is_absolute()) return false;
  for (const fs::path& part : name)
    if (part == "..") return false;
  std::error_code error;
  const fs::path top = fs::weakly_canonical(fs::absolute(file).parent_path(), error);
  if (error) return false;
  const fs::path target = fs::weakly_canonical(top / name, error);
  return !error && *target.lexically_relative(top).begin() != "..";
}

void readBuffers(MeshFiles& files) {
  const JsonDocument document(files.file, asText(files.bytes));
  const auto buffers = document.root().find("buffers");
  if (!buffers) return;
  std::size_t room = kMaxMeshFileBytes - files.bytes.size();
  for (const JsonReader& buffer : buffers->elements()) {
    const auto uri = buffer.find("uri");
    if (!uri || uri->text().starts_with("data:")) continue;
    const std::string name = nameOf(uri->nonEmptyText());
    if (!staysBeside(files.file, name))
      uri->fail("'" + name + "' is not in the mesh's folder: only buffers there are read");
    const auto stated = static_cast<std::size_t>(buffer.at("byteLength").integer(0));
    files.buffers.push_back({buffer.place(), uri->text(), name, stated,
                             readFileBytes(files.file.parent_path() / name, room)});
    room -= files.buffers.back().bytes.size();
  }
}

}  // namespace

MeshFiles readMeshFiles(const fs::path& file) {
  MeshFiles files;
  files.file = file;
  files.format = meshFormatOf(file);
  files.bytes = readFileBytes(file, kMaxMeshFileBytes);
  if (files.format == MeshFormat::kGltf) readBuffers(files);
  Sha256 sha;
  sha.update(files.bytes);
  for (const MeshBuffer& buffer : files.buffers) sha.update(buffer.bytes);
  files.sha256 = hexText(sha.digest()).data();
  return files;
}

}  // namespace boresight::sessions
