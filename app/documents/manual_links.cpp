// SPDX-License-Identifier: Apache-2.0
#include "app/documents/manual_links.h"

#include <algorithm>

namespace boresight::documents {
namespace {

/// Place of the bracket that the one at `close` belongs to, or npos.
std::size_t openingOf(const std::string& text, std::size_t close) {
  int depth = 0;
  for (std::size_t i = close + 1; i-- > 0;) {
    if (text[i] == ']') ++depth;
    if (text[i] == '[' && --depth == 0) return i;
  }
  return std::string::npos;
}

/// One line; links do not go over line ends here.
std::string lineWithLinks(std::string line, const LinkTarget& target_of) {
  for (std::size_t close = line.find("]("); close != std::string::npos;
       close = line.find("](", close + 1)) {
    const std::size_t end = line.find(')', close);
    const std::size_t open = openingOf(line, close);
    if (end == std::string::npos || open == std::string::npos) continue;
    const std::string target = target_of(line.substr(close + 2, end - close - 2));
    if (!target.empty()) {
      line.replace(close + 2, end - close - 2, target);
      continue;
    }
    const bool picture = open > 0 && line[open - 1] == '!';
    const std::size_t begin = picture ? open - 1 : open;
    const std::string words = line.substr(open + 1, close - open - 1);
    line.replace(begin, end + 1 - begin, words);
    close = begin;
  }
  return line;
}

}  // namespace

std::string withLinks(const std::string& markdown, const LinkTarget& target_of) {
  std::string text;
  bool code = false;
  for (std::size_t begin = 0; begin < markdown.size();) {
    const std::size_t end = std::min(markdown.find('\n', begin), markdown.size() - 1);
    const std::string line = markdown.substr(begin, end + 1 - begin);
    const bool fence = line.rfind("```", 0) == 0;
    if (fence) code = !code;
    text += code || fence ? line : lineWithLinks(line, target_of);
    begin = end + 1;
  }
  return text;
}

}  // namespace boresight::documents
