// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/labels/label_files.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <cpl_minixml.h>
#include <nlohmann/json.hpp>

#include "sessions/io/files/errors.h"
#include "sessions/io/files/file_bytes.h"
#include "sessions/io/images/gdal_memory.h"
#include "sessions/io/images/labels/label_values.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

constexpr int kMostDepth = 64;  ///< of elements within elements
constexpr const char* kProduct = "Product_Observational";
constexpr const char* kArea = "File_Area_Observational";

void addMember(json& object, const std::string& name, json value) {
  const auto found = object.find(name);
  if (found == object.end())
    object[name] = std::move(value);
  else if (found->is_array())
    found->push_back(std::move(value));
  else
    *found = json::array({std::move(*found), std::move(value)});
}

bool isElement(const CPLXMLNode* node) { return node->eType == CXT_Element; }
std::string nameOf(const CPLXMLNode* node) { return node->pszValue; }
bool isArray(const CPLXMLNode* node) {
  return isElement(node) && nameOf(node).starts_with("Array");
}
bool isArea(const CPLXMLNode* node) { return isElement(node) && nameOf(node) == kArea; }

/// An element's children as an object, or its text.
json treeOf(const std::filesystem::path& file, const CPLXMLNode* element, int depth = 0) {
  if (depth > kMostDepth)
    throw InputError(file,
                     "the label's elements are nested deeper than " + std::to_string(kMostDepth));
  json object = json::object();
  std::string text;
  std::string unit;
  for (const CPLXMLNode* child = element->psChild; child != nullptr; child = child->psNext) {
    if (child->eType == CXT_Text)
      text += child->pszValue;
    else if (isElement(child))
      addMember(object, nameOf(child), treeOf(file, child, depth + 1));
    else if (child->eType == CXT_Attribute && child->psChild != nullptr && nameOf(child) == "unit")
      unit = child->psChild->pszValue;
  }
  if (!object.empty()) return object;
  if (!unit.empty()) return {{"value", text}, {"unit", unit}};
  return text;
}

struct Array {
  CPLXMLNode* area;
  CPLXMLNode* node;
  bool isImage() const {
    return nameOf(node) == "Array_2D_Image" || nameOf(node) == "Array_3D_Image";
  }
};

std::vector<Array> arraysOf(const CPLXMLNode* product) {
  std::vector<Array> arrays;
  for (CPLXMLNode* area = product->psChild; area != nullptr; area = area->psNext)
    for (CPLXMLNode* node = isArea(area) ? area->psChild : nullptr; node != nullptr;
         node = node->psNext)
      if (isArray(node)) arrays.push_back({area, node});
  return arrays;
}

/// Removes the children of this kind except for one.
void keepOnly(const CPLXMLNode* kept, CPLXMLNode* parent, bool (*isKind)(const CPLXMLNode*)) {
  for (CPLXMLNode* node = parent->psChild; node != nullptr;) {
    CPLXMLNode* const next = node->psNext;
    if (isKind(node) && node != kept && CPLRemoveXMLChild(parent, node)) CPLDestroyXMLNode(node);
    node = next;
  }
}

std::string remarkOf(std::size_t count, const Array& read, const json& tree) {
  auto id = labelText(labelMember(&tree, "local_identifier"));
  if (!id) id = labelText(labelMember(&tree, "name"));
  return "the label has " + std::to_string(count) + " arrays; the " + nameOf(read.node) +
         (id ? " '" + *id + "'" : "") + " is read";
}

std::string readProduct(CPLXMLNode* product, LabelFiles& files) {
  const std::vector<Array> arrays = arraysOf(product);
  if (arrays.empty()) throw InputError(files.file, "the PDS4 label describes no array of pixels");
  auto read =
      std::find_if(arrays.begin(), arrays.end(), [](const Array& a) { return a.isImage(); });
  if (read == arrays.end()) read = arrays.begin();
  keepOnly(read->area, product, isArea);
  keepOnly(read->node, read->area, isArray);
  files.elements = std::make_shared<const json>(treeOf(files.file, product));
  const json* area = labelMember(files.elements.get(), kArea);
  const auto name = labelText(labelPath(area, {"File", "file_name"}));
  if (!name) throw InputError(files.file, "the PDS4 label names no file of its pixels");
  // GDAL would turn the lines of an image that is displayed from bottom to top.
  keepOnly(read->area, product, isElement);
  char* const xml = CPLSerializeXMLTree(product);
  const std::string_view text = xml == nullptr ? "" : xml;
  files.rewritten.assign(text.begin(), text.end());
  CPLFree(xml);
  if (arrays.size() > 1)
    files.remark = remarkOf(arrays.size(), *read, *labelMember(area, nameOf(read->node)));
  return *name;
}

}  // namespace

bool isXmlLabel(std::string_view text) {
  return skipBlanks(text).starts_with('<') && text.find(kProduct) != std::string_view::npos;
}

std::string readXmlLabel(LabelFiles& files) {
  const GdalQuiet quiet;
  const std::string text(asText(files.parts.front().bytes));
  CPLXMLNode* root = CPLParseXMLString(text.c_str());
  if (root == nullptr) throw InputError(files.file, "the PDS4 label is not well-formed XML");
  const std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)> owner(root, CPLDestroyXMLNode);
  CPLStripXMLNamespace(root, nullptr, TRUE);
  for (CPLXMLNode* node = root; node != nullptr; node = node->psNext)
    if (isElement(node) && nameOf(node) == kProduct) return readProduct(node, files);
  throw InputError(files.file, "the PDS4 label has no Product_Observational");
}

}  // namespace boresight::sessions
