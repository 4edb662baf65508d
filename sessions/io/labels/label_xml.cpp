// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/label_xml.h"

#include <algorithm>
#include <optional>
#include <unordered_set>
#include <vector>

#include <cpl_minixml.h>
#include <nlohmann/json.hpp>

#include "sessions/io/errors.h"
#include "sessions/io/labels/gdal_quiet.h"
#include "sessions/io/labels/label_values.h"

namespace boresight::sessions {
namespace {

using nlohmann::json;

constexpr int kMostDepth = 64;  ///< of elements within elements
constexpr const char* kProduct = "Product_Observational";
constexpr const char* kArea = "File_Area_Observational";

std::string_view withoutPrefix(std::string_view name) {
  const auto colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// Behind the '>' that ends the declaration at `from`: not one inside of quotes or brackets.
std::size_t behindDeclaration(std::string_view xml, std::size_t from) {
  char quote = 0;
  int brackets = 0;
  for (std::size_t i = from; i < xml.size(); ++i) {
    const char c = xml[i];
    if (quote != 0)
      quote = c == quote ? char{0} : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '[')
      ++brackets;
    else if (c == ']')
      --brackets;
    else if (c == '>' && brackets <= 0)
      return i + 1;
  }
  return xml.size();
}

/// Name of the first element, with its prefix; declarations, instructions and comments are passed
/// over. Empty where there is none.
std::string_view firstElement(std::string_view xml) {
  for (auto at = xml.find('<'); at < xml.size(); at = xml.find('<', at)) {
    const std::string_view rest = xml.substr(at);
    if (rest.starts_with("<!--"))
      at = xml.find("-->", at + 4);
    else if (rest.starts_with("<?"))
      at = xml.find("?>", at);
    else if (rest.starts_with("<!"))
      at = behindDeclaration(xml, at);
    else
      return rest.substr(1, rest.find_first_of(" \t\r\n/>", 1) - 1);
  }
  return {};
}

[[noreturn]] void refuseDepth(const std::filesystem::path& file) {
  throw InputError(file,
                   "the label's elements are nested deeper than " + std::to_string(kMostDepth));
}

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
std::string nameOf(const CPLXMLNode* node) { return std::string(withoutPrefix(node->pszValue)); }

using Nodes = std::unordered_set<const CPLXMLNode*>;

/// Builds trees of elements, without those that it is told to leave out.
class Tree {
 public:
  Tree(const std::filesystem::path& file, Nodes left_out)
      : file_(file), left_out_(std::move(left_out)) {}

  /// An element's children as an object, or its text.
  json of(const CPLXMLNode* element, int depth = 0) const {
    if (depth > kMostDepth) refuseDepth(file_);
    json object = json::object();
    std::string text;
    std::string unit;
    for (const CPLXMLNode* child = element->psChild; child != nullptr; child = child->psNext) {
      if (child->eType == CXT_Text)
        text += child->pszValue;
      else if (isElement(child) && !left_out_.contains(child))
        addMember(object, nameOf(child), of(child, depth + 1));
      else if (child->eType == CXT_Attribute && child->psChild != nullptr &&
               std::string_view(child->pszValue) == "unit")
        unit = child->psChild->pszValue;
    }
    if (!object.empty()) return object;
    if (!unit.empty()) return {{"value", text}, {"unit", unit}};
    return text;
  }

 private:
  const std::filesystem::path& file_;
  Nodes left_out_;
};

struct Array {
  CPLXMLNode* area;
  CPLXMLNode* node;
  bool isImage() const {
    const std::string name = nameOf(node);
    return name == "Array_2D_Image" || name == "Array_3D_Image";
  }
};

std::vector<Array> arraysOf(const CPLXMLNode* product) {
  std::vector<Array> arrays;
  for (CPLXMLNode* area = product->psChild; area != nullptr; area = area->psNext) {
    if (!isElement(area) || nameOf(area) != kArea) continue;
    for (CPLXMLNode* node = area->psChild; node != nullptr; node = node->psNext)
      if (isElement(node) && nameOf(node).starts_with("Array")) arrays.push_back({area, node});
  }
  return arrays;
}

/// What is not of the one array: other areas, and other arrays of its own.
Nodes othersThan(const Array& wanted, const CPLXMLNode* product) {
  Nodes others;
  for (const CPLXMLNode* area = product->psChild; area != nullptr; area = area->psNext)
    if (isElement(area) && nameOf(area) == kArea && area != wanted.area) others.insert(area);
  for (const CPLXMLNode* node = wanted.area->psChild; node != nullptr; node = node->psNext)
    if (isElement(node) && nameOf(node).starts_with("Array") && node != wanted.node)
      others.insert(node);
  return others;
}

std::string labelOfArray(CPLXMLNode* node) {
  CPLXMLNode* const next = node->psNext;  // would be written, too
  node->psNext = nullptr;
  char* const xml = CPLSerializeXMLTree(node);
  node->psNext = next;
  const std::string array = xml == nullptr ? "" : xml;
  CPLFree(xml);
  return std::string("<Product_Observational xmlns=\"http://pds.nasa.gov/pds4/pds/v1\">") +
         "<File_Area_Observational><File><file_name>" + kXmlPixelsName + "</file_name></File>" +
         array + "</File_Area_Observational></Product_Observational>";
}

std::string remarkOf(const std::vector<Array>& arrays, const Array& read, const json& tree) {
  if (arrays.size() < 2) return "";
  auto id = labelText(labelMember(&tree, "local_identifier"));
  if (!id) id = labelText(labelMember(&tree, "name"));
  return "the label has " + std::to_string(arrays.size()) + " arrays; the " + nameOf(read.node) +
         (id ? " '" + *id + "'" : "") + " is read";
}

XmlLabel readProduct(const std::filesystem::path& file, const CPLXMLNode* product) {
  const std::vector<Array> arrays = arraysOf(product);
  if (arrays.empty()) throw InputError(file, "the PDS4 label describes no array of pixels");
  auto read =
      std::find_if(arrays.begin(), arrays.end(), [](const Array& a) { return a.isImage(); });
  if (read == arrays.end()) read = arrays.begin();
  XmlLabel label;
  label.tree = std::make_shared<const json>(Tree(file, othersThan(*read, product)).of(product));
  const json* area = labelMember(label.tree.get(), kArea);
  const auto name = labelText(labelPath(area, {"File", "file_name"}));
  if (!name) throw InputError(file, "the PDS4 label names no file of its pixels");
  label.file_name = *name;
  label.array_label = labelOfArray(read->node);
  label.remark = remarkOf(arrays, *read, *labelMember(area, nameOf(read->node)));
  return label;
}

}  // namespace

bool isXmlLabel(std::string_view text) { return withoutPrefix(firstElement(text)) == kProduct; }

XmlLabel readXmlLabel(const std::filesystem::path& file, std::string_view text) {
  const GdalQuiet quiet;
  CPLXMLNode* root = CPLParseXMLString(std::string(text).c_str());
  if (root == nullptr) throw InputError(file, "the PDS4 label is not well-formed XML");
  const std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)> owner(root, CPLDestroyXMLNode);
  for (const CPLXMLNode* node = root; node != nullptr; node = node->psNext)
    if (isElement(node) && nameOf(node) == kProduct) return readProduct(file, node);
  throw InputError(file, "the PDS4 label has no Product_Observational");
}

}  // namespace boresight::sessions
