// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/gltf_geometry.h"

#include <initializer_list>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "sessions/io/byte_cursor.h"
#include "sessions/io/file_bytes.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;
using Keys = std::initializer_list<const char*>;

json kept(const json& object, Keys keys) {
  json made = json::object();
  for (const char* key : keys)
    if (object.contains(key)) made[key] = object[key];
  return made;
}

void keepInEach(json& object, const char* list, Keys keys) {
  if (!object.contains(list)) return;
  for (json& one : object[list]) one = kept(one, keys);
}

std::string geometryJson(std::string_view text) {
  json made = kept(json::parse(text), {"asset", "extensionsRequired", "scene", "scenes", "nodes",
                                       "meshes", "accessors", "bufferViews", "buffers"});
  keepInEach(made, "scenes", {"nodes"});
  keepInEach(made, "nodes", {"children", "mesh", "matrix", "translation", "rotation", "scale"});
  keepInEach(made, "meshes", {"primitives"});
  for (json& mesh : made["meshes"]) {
    keepInEach(mesh, "primitives", {"attributes", "indices", "mode"});
    for (json& primitive : mesh["primitives"])
      primitive["attributes"] = kept(primitive["attributes"], {"POSITION"});
  }
  keepInEach(made, "accessors", {"bufferView", "byteOffset", "componentType", "count", "type"});
  keepInEach(made, "bufferViews", {"buffer", "byteOffset", "byteLength", "byteStride"});
  keepInEach(made, "buffers", {"uri", "byteLength"});
  return made.dump();
}

void appendNumber(std::vector<std::uint8_t>& bytes, std::size_t number) {
  for (int shift = 0; shift < 32; shift += 8)
    bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

}  // namespace

std::vector<std::uint8_t> gltfGeometry(std::span<const std::uint8_t> bytes, MeshFormat format) {
  if (format == MeshFormat::kGltf) {
    const std::string json = geometryJson(asText(bytes));
    return {json.begin(), json.end()};
  }
  constexpr std::size_t kHeader = 20;
  const auto old_size = static_cast<std::size_t>(readUnsigned(bytes, 12, 4, false));
  std::string json = geometryJson(asText(bytes.subspan(kHeader, old_size)));
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto rest = bytes.subspan(kHeader + old_size);
  std::vector<std::uint8_t> made(bytes.begin(), bytes.begin() + 8);
  appendNumber(made, kHeader + json.size() + rest.size());
  appendNumber(made, json.size());
  made.insert(made.end(), bytes.begin() + 16, bytes.begin() + kHeader);
  made.insert(made.end(), json.begin(), json.end());
  made.insert(made.end(), rest.begin(), rest.end());
  return made;
}

}  // namespace boresight::sessions
