// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace boresight {
namespace {

namespace fs = std::filesystem;

/// The stages in pipeline order: a folder may include itself and those before it.
const std::vector<std::string> kStages = {"base",      "geometry", "edges",  "render", "templates",
                                          "match",     "pnp",      "refine", "accept", "search",
                                          "localizer", "views",    "record"};

/// The standard headers that flight code may use: no streams, threads, heap containers, locales,
/// clocks or random distributions. <cstdlib> is where the integers' std::abs lives.
const std::set<std::string> kStandardHeaders = {
    "algorithm",   "array",   "bit",         "climits", "cmath",           "compare",
    "concepts",    "cstddef", "cstdint",     "cstdlib", "cstring",         "iterator",
    "limits",      "new",     "numbers",     "numeric", "optional",        "span",
    "string_view", "tuple",   "type_traits", "utility", "initializer_list"};

struct Include {
  fs::path file;
  std::string header;
  bool quoted = false;
};

/// Headers and sources of core/.
std::vector<fs::path> filesOfCore() {
  std::vector<fs::path> files;
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(BORESIGHT_SOURCE_DIR) / "core"))
    if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
      files.push_back(entry.path());
  return files;
}

std::vector<Include> includesOf(const fs::path& file) {
  static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> includes;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (std::regex_search(line, match, pattern))
      includes.push_back({file, match[2].str(), match[1].str() == "\""});
  }
  return includes;
}

std::ptrdiff_t stageNumber(const std::string& folder) {
  return std::find(kStages.begin(), kStages.end(), folder) - kStages.begin();
}

/// Files for one kind of processor, which other machines do not compile, may use its instructions.
bool isForOneProcessor(const Include& include) {
  const std::string stem = include.file.stem().string();
  return stem.ends_with("_x86") && include.file.extension() == ".cpp" &&
         (include.header == "immintrin.h" || include.header == "cpuid.h");
}

/// "" when the include is allowed, else what is wrong with it.
std::string fault(const std::string& including_folder, const Include& include) {
  const auto stage_count = static_cast<std::ptrdiff_t>(kStages.size());
  if (stageNumber(including_folder) == stage_count) return "is in no stage of the pipeline";
  if (!include.quoted) {
    const bool eigen = include.header.starts_with("Eigen/");
    return eigen || isForOneProcessor(include) || kStandardHeaders.contains(include.header)
               ? ""
               : "includes <" + include.header + ">, which flight code may not";
  }
  if (!include.header.starts_with("core/")) return "includes " + include.header + " outside core/";
  const std::string folder = include.header.substr(5, include.header.find('/', 5) - 5);
  if (stageNumber(folder) > stageNumber(including_folder))
    return "includes " + include.header + " of a later stage";
  return "";
}

std::string textOf(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Whether a source calls sin, exp and the like of the C library, whose bits differ between
/// machines: as std::sin(), or as sin() without the header that declares core's own.
bool callsTheCLibrary(const std::string& text) {
  static const std::regex comment("//[^\n]*");
  static const std::regex of_std(R"(std::(a?(sin|cos|tan)h?|atan2|exp|log|pow)\()");
  static const std::regex unqualified(R"([^\w:.>](a?(sin|cos|tan)h?|atan2|exp|log|pow)\()");
  static const std::regex declared(R"(#include "core/base/math\.h")");
  const std::string code = std::regex_replace(text, comment, "");
  return std::regex_search(code, of_std) ||
         (std::regex_search(code, unqualified) && !std::regex_search(code, declared));
}

TEST(Layering, NoStageIncludesALaterStageOrAForeignHeader) {
  std::size_t count = 0;
  for (const fs::path& file : filesOfCore()) {
    const fs::path relative = fs::relative(file, fs::path(BORESIGHT_SOURCE_DIR) / "core");
    for (const Include& include : includesOf(file)) {
      EXPECT_EQ(fault(relative.begin()->string(), include), "") << relative;
      ++count;
    }
  }
  EXPECT_GT(count, 50u) << "the sources were not found in " << BORESIGHT_SOURCE_DIR;
}

TEST(Layering, ElementaryFunctionsInCore_AreCoresOwn) {
  for (const fs::path& file : filesOfCore())
    EXPECT_FALSE(file.extension() == ".cpp" && callsTheCLibrary(textOf(file))) << file;
  EXPECT_TRUE(callsTheCLibrary("double a = std::sin(x);"));
  EXPECT_TRUE(callsTheCLibrary("#include <cmath>\ndouble a = exp(x);"));
  EXPECT_FALSE(callsTheCLibrary("#include \"core/base/math.h\"\ndouble a = exp(x);"));
  EXPECT_FALSE(callsTheCLibrary("double a = std::sqrt(x);  // not sin(x)"));
}

TEST(Layering, ForbiddenIncludes_AreDetected) {
  const auto faulty = [](const std::string& folder, const std::string& header, bool quoted) {
    return !fault(folder, {"x.cpp", header, quoted}).empty();
  };
  EXPECT_TRUE(faulty("geometry", "core/edges/edge_map.h", true));
  EXPECT_TRUE(faulty("pnp", "core/localizer/localizer.h", true));
  EXPECT_TRUE(faulty("base", "sessions/io/image.h", true));
  EXPECT_TRUE(faulty("base", "math.h", true));
  EXPECT_TRUE(faulty("edges", "core/unheard_of/x.h", true));
  EXPECT_TRUE(faulty("unheard_of", "cstdint", false));
  for (const char* header :
       {"vector", "iostream", "thread", "opencv2/core.hpp", "random", "immintrin.h"})
    EXPECT_TRUE(faulty("match", header, false)) << header;
  EXPECT_FALSE(faulty("match", "core/base/image.h", true));
  EXPECT_FALSE(faulty("match", "core/match/whs.h", true));
  EXPECT_FALSE(faulty("localizer", "core/pnp/pnp.h", true));
  EXPECT_FALSE(faulty("pnp", "Eigen/Core", false));
  EXPECT_FALSE(faulty("pnp", "cmath", false));
}

}  // namespace
}  // namespace boresight
