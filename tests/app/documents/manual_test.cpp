// SPDX-License-Identifier: Apache-2.0
// The manual as it is installed, against the programs and the source that it tells of.
#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/localizer/localizer_options.h"
#include "sessions/baselines/methods.h"
#include "sessions/decision/check_limits.h"
#include "sessions/io/cameras/frame_transform.h"
#include "sessions/io/images/labels/image_label.h"
#include "sessions/session/session_file.h"
#include "tests/app/run_whs.h"
#include "tests/support/all_cases.h"
#include "tests/support/downlink_image.h"

namespace boresight::test {
namespace {

namespace fs = std::filesystem;

const fs::path kManual = BORESIGHT_MANUAL;
const fs::path kSource = BORESIGHT_SOURCE;

std::string textOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Every page by its name.
const std::map<std::string, std::string>& pages() {
  static const std::map<std::string, std::string> all = [] {
    std::map<std::string, std::string> result;
    for (const auto& entry : fs::directory_iterator(kManual))
      if (entry.path().extension() == ".md")
        result[entry.path().filename().string()] = textOf(entry.path());
    return result;
  }();
  return all;
}

std::vector<std::string> matches(const std::string& text, const std::string& pattern, int group) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), expression), end; it != end; ++it)
    found.push_back((*it)[static_cast<std::size_t>(group)].str());
  return found;
}

/// The blocks between ``` that begin with this, and the text without any block.
struct Blocks {
  std::map<std::string, std::vector<std::string>> by_kind;
  std::string text;
};
Blocks blocksOf(const std::string& page) {
  Blocks blocks;
  std::istringstream stream(page);
  std::string kind;
  bool inside = false;
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("```", 0) == 0) {
      inside = !inside;
      kind = line.substr(3);
      if (inside) blocks.by_kind[kind].emplace_back();
    } else if (inside) {
      blocks.by_kind[kind].back() += line + "\n";
    } else {
      blocks.text += line + "\n";
    }
  }
  EXPECT_FALSE(inside) << "a block is not closed";
  return blocks;
}

/// By which links name the page's headings.
std::set<std::string> anchorsOf(const std::string& page) {
  std::set<std::string> anchors;
  for (std::string heading : matches(blocksOf(page).text, "(^|\n)#+ ([^\n]+)", 2)) {
    std::string anchor;
    for (const char c : heading) {
      if (std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-')
        anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      if (c == ' ') anchor += '-';
    }
    anchors.insert(anchor);
  }
  return anchors;
}

std::vector<std::string> linksOf(const std::string& page) {
  // What is between two backticks is code.
  const std::string text = std::regex_replace(blocksOf(page).text, std::regex("`[^`\n]*`"), "code");
  return matches(text, R"(\]\(([^)\s]+)\))", 1);
}

TEST(Manual, Links_HaveTargets) {
  int links = 0;
  for (const auto& [name, page] : pages()) {
    for (const std::string& link : linksOf(page)) {
      if (link.find("://") != std::string::npos) continue;
      ++links;
      const std::size_t hash = link.find('#');
      const std::string file = hash == 0 ? name : link.substr(0, hash);
      EXPECT_TRUE(fs::is_regular_file(kManual / file)) << name << ": " << link;
      if (hash == std::string::npos || !pages().contains(file)) continue;
      EXPECT_TRUE(anchorsOf(pages().at(file)).contains(link.substr(hash + 1)))
          << name << ": " << link;
    }
  }
  EXPECT_GT(links, 100);
}

/// The index lists what the window's contents show.
TEST(Manual, EveryPageIsListedInTheIndexOnce) {
  const std::vector<std::string> listed =
      matches(pages().at("index.md"), R"(\n- \[[^\]]+\]\(([a-z_]+\.md)\))", 1);
  std::multiset<std::string> expected;
  for (const auto& page : pages()) expected.insert(page.first);
  expected.erase("index.md");
  EXPECT_EQ(std::multiset<std::string>(listed.begin(), listed.end()), expected);
}

TEST(Manual, EveryPictureIsShownAndSmall) {
  std::set<std::string> shown;
  for (const auto& page : pages())
    for (const std::string& link : linksOf(page.second)) shown.insert(link);
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::directory_iterator(kSource / "resources/manual/pictures")) {
    const std::string name = "pictures/" + entry.path().filename().string();
    EXPECT_TRUE(shown.contains(name)) << name;
    EXPECT_LT(entry.file_size(), 260'000u) << name;
    bytes += entry.file_size();
  }
  EXPECT_LT(bytes, 3'000'000u);
}

TEST(Manual, KnowsEveryOptionAndNamesNoOther) {
  const std::string page = std::regex_replace(pages().at("options.md"), std::regex(R"(\\)"), "");
  std::set<std::string> known;
  std::set<std::string> groups;
  for (const auto& options :
       {sessions::listOptions(defaultProfile()), sessions::listOptions(sessions::MethodOptions()),
        sessions::listOptions(sessions::CheckLimits())})
    for (const sessions::OptionDescription& option : options) {
      EXPECT_NE(page.find("| `" + option.name + "` | "), std::string::npos) << option.name;
      EXPECT_NE(page.find("| " + option.help + " ("), std::string::npos) << option.name;
      known.insert(option.name);
      groups.insert(option.name.substr(0, option.name.find('.')));
    }
  for (const char* name : {"failed_run.md", "limits.md", "checks.md", "algorithm.md",
                           "robustness.md", "trust.md", "formats.md", "evaluate.md", "window.md"})
    for (const std::string& word : matches(pages().at(name), R"(`([a-z]+\.[a-z_]+)(=[^`]*)?`)", 1))
      EXPECT_TRUE(known.contains(word) || !groups.contains(word.substr(0, word.find('.'))))
          << name << ": " << word;
}

TEST(Manual, KnowsEveryCommand) {
  const std::string help = runWhs({"--help"}).out;
  const std::vector<std::string> commands =
      matches(help.substr(help.find("Subcommands:")), R"(\n  ([a-z]+) )", 1);
  ASSERT_GT(commands.size(), 15u);
  const std::set<std::string> anchors = anchorsOf(pages().at("whs.md"));
  for (const std::string& command : commands)
    EXPECT_TRUE(anchors.contains("whs-" + command)) << command;
}

/// Of what the source reads or writes under a name of its own.
TEST(Manual, KnowsEveryFormat) {
  std::set<std::string> formats;
  for (const char* folder : {"sessions", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(kSource / folder))
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".h")
        for (const std::string& format :
             matches(textOf(entry.path()), R"re("(boresight-[a-z-]+)")re", 1))
          formats.insert(format);
  EXPECT_GE(formats.size(), 12u);
  const std::string text = pages().at("formats.md") + pages().at("matchers.md");
  for (const std::string& format : formats)
    EXPECT_NE(text.find(format), std::string::npos) << format;
}

TEST(Manual, JsonIsJson) {
  int count = 0;
  for (const auto& [name, page] : pages()) {
    const std::vector<std::string> blocks = blocksOf(page).by_kind["json"];
    for (const std::string& block : blocks)
      EXPECT_TRUE(nlohmann::json::accept(block)) << name << ":\n" << block;
    count += static_cast<int>(blocks.size());
  }
  EXPECT_GE(count, 5);
}

/// The image that pages speak of. Where the camera is and what the label says of frames is taken
/// from the label of 1F483288473EFFCMUFP1214L0M1.IMG; the picture is the example's.
void writeImageOfPages(const TemporaryFolder& folder) {
  const Pose rover_from_camera{Eigen::Quaterniond(0.6554278649933007, 0.2702906109594101,
                                                  0.267541568378369, 0.6525172860600358)
                                   .normalized(),
                               {0.609331, -0.041064, -0.233849}};
  folder.write(
      "1F483288473.IMG",
      downlinkImage(osExample(), rover_from_camera, {"ROVER_FRAME", {194, 835, 1, 0, 0}},
                    "PROPERTY='ROVER_COORDINATE_SYSTEM'  "
                    "COORDINATE_SYSTEM_NAME='ROVER_FRAME'  "
                    "COORDINATE_SYSTEM_INDEX=(194,835,1,0,0)  "
                    "ORIGIN_OFFSET_VECTOR=(-84.1293,-26.1436,3.59172)  "
                    "ORIGIN_ROTATION_QUATERNION=(0.965051,-0.0697583,-0.0424514,0.249015)  "
                    "REFERENCE_COORD_SYSTEM_NAME='SITE_FRAME'  "
                    "REFERENCE_COORD_SYSTEM_INDEX=194  "));
}

/// The commands with fewer runs of the same kind: one further seed, and no convergence test, which
/// app/review_test.cpp runs. With BORESIGHT_ALL they are as the page has them.
std::string shortened(const std::string& script) {
  if (allCases()) return script;
  const std::regex convergence("\nwhs (check|decide) (?!.*--convergence-test)[^\n]*");
  return std::regex_replace(std::regex_replace(script, convergence, "$& --convergence-test 0"),
                            std::regex("--reseed 5"), "--reseed 1");
}

/// Runs the page's commands as an operator types them, one after the other.
void runPage(const std::string& name, const TemporaryFolder& folder) {
  std::string script = "cd \"$HOME\"\n";
  const std::vector<std::string> blocks = blocksOf(pages().at(name)).by_kind["sh run"];
  for (const std::string& block : blocks) script += block;
  script = std::regex_replace(shortened(script), std::regex("/usr/share/boresight/examples"),
                              exampleFolder().parent_path().string());
  if (script.find("1F483288473.IMG") != std::string::npos) writeImageOfPages(folder);
  folder.write("page.sh", script);
  const ProgramRun run =
      runProgram("env HOME=" + folder.path().string() +
                     " PATH=" + fs::path(BORESIGHT_WHS).parent_path().string() + ":\"$PATH\" bash",
                 {"-eu", folder / "page.sh"});
  EXPECT_EQ(run.exit_code, 0) << name << "\n" << script << run.out << run.err;
}

/// A folder in which the page's commands were run, once for all tests.
const TemporaryFolder& folderOfPage(const std::string& name) {
  static std::map<std::string, TemporaryFolder> folders;
  const auto [folder, is_new] = folders.try_emplace(name);
  if (is_new) runPage(name, folder->second);
  return folder->second;
}

/// Page by page, each in a folder of its own.
TEST(Manual, CommandsOfPages_Succeed) {
  int run_pages = 0;
  for (const auto& [name, page] : pages()) {
    if (blocksOf(page).by_kind["sh run"].empty()) continue;
    ++run_pages;
    (void)folderOfPage(name);
  }
  EXPECT_GE(run_pages, 7);
}

TEST(Manual, KnowsEveryCheck) {
  const TemporaryFolder& folder = folderOfPage("start.md");
  runWhs({"check", folder / "examples/example.boresight.json", "--case", "os-000038",
          "--convergence-test", "0", "--json", folder / "checks.json"},
         0);
  const nlohmann::json checks =
      nlohmann::json::parse(folder.read("checks.json")).at("cases").at(0).at("checks");
  EXPECT_GE(checks.size(), 24u);
  const std::string& page = pages().at("checks.md");
  for (const nlohmann::json& check : checks) {
    const std::string row = "| **" + check.at("title").get<std::string>() + "** `" +
                            check.at("id").get<std::string>() + "` |";
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
}

/// The documented example's transform equals that of the label, and both seeds are the same pose.
TEST(Manual, FramesOfThePlanetaryPageAreThoseOfTheLabel) {
  const TemporaryFolder& folder = folderOfPage("planetary.md");
  const sessions::ImageLabel label = sessions::readImageLabel(folder / "1F483288473.IMG");
  const sessions::FrameTransform stated =
      sessions::readFrameTransforms(folder / "site_from_rover.json").front();
  const auto told = std::find_if(label.frames.begin(), label.frames.end(), [&](const auto& item) {
    return item.frame == stated.source && item.reference == stated.target;
  });
  ASSERT_NE(told, label.frames.end());
  // Six digits of 84 m are shown.
  EXPECT_LT(perturbationBetween(stated.target_from_source, told->reference_from_frame).norm(),
            1e-5);
  const auto seedOf = [&folder](const char* session) {
    return sessions::readSessionFile(folder / session).session.cases[0]->camera_from_station_seed;
  };
  const Pose seed = seedOf("sol4000.boresight.json");
  EXPECT_LT(perturbationBetween(seed, seedOf("sol4000_site.boresight.json")).norm(), 1e-5);
}

/// In tables of files, the names next to a file occur in it.
TEST(Manual, NamedFilesAndFunctions_Exist) {
  int files = 0;
  for (const char* page : {"engineer.md", "engineer_add.md", "formats.md", "evaluate.md"}) {
    std::istringstream stream(blocksOf(pages().at(page)).text);
    for (std::string line; std::getline(stream, line);) {
      std::string named;
      for (const std::string& file :
           matches(line, R"(`((core|sessions|ui|app|tests|resources|cmake)/[\w/.]*)`)", 1)) {
        EXPECT_TRUE(fs::exists(kSource / file)) << page << ": " << file;
        if (fs::is_regular_file(kSource / file)) named += textOf(kSource / file);
        ++files;
      }
      if (std::string(page) != "engineer_add.md" || line.rfind("| `", 0) != 0) continue;
      for (const std::string& word : matches(line, R"(`([^`]+)`)", 1))
        EXPECT_TRUE(named.find(word) != std::string::npos || fs::exists(kSource / word))
            << line.substr(0, 60) << ": " << word;
    }
  }
  EXPECT_GT(files, 50);
}

TEST(Manual, PagesThatCannotBeWrittenAreOneLine) { refusal({"documents", "/proc/nowhere"}); }

}  // namespace
}  // namespace boresight::test
