// SPDX-License-Identifier: Apache-2.0
// What the programs write of themselves, against what their --help says, and in the shells that
// read it.
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

/// Where the programs wrote; made once, for it takes a process each.
const TemporaryFolder& written() {
  static const TemporaryFolder folder;
  static const bool done = [] {
    EXPECT_EQ(runWhs({"documents", folder.path().string()}).exit_code, 0);
    return true;
  }();
  EXPECT_TRUE(done);
  return folder;
}

bool hasProgram(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> found;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) found.push_back(line);
  return found;
}

/// The long options at the beginning of a help's lines, those of groups, too.
std::set<std::string> optionsOf(const std::string& help) {
  static const std::regex pattern(R"(^ {2,4}(?:-\w, ?)?(--[\w-]+))");
  std::set<std::string> options;
  for (const std::string& line : lines(help)) {
    std::smatch match;
    if (std::regex_search(line, match, pattern)) options.insert(match[1].str());
  }
  return options;
}

/// The words under "Subcommands:".
std::vector<std::string> commandsOf(const std::string& help) {
  std::vector<std::string> commands;
  bool inside = false;
  for (const std::string& line : lines(help)) {
    if (line == "Subcommands:") {
      inside = true;
    } else if (line.empty() || line[0] != ' ') {
      inside = false;
    } else if (inside && line.size() > 2 && line[2] != ' ') {
      commands.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
  }
  return commands;
}

std::string escaped(const std::string& option) {
  return std::regex_replace(option, std::regex("-"), "\\-");
}

/// What bash offers for the last of the words.
std::vector<std::string> offeredByBash(const std::string& program, const Arguments& words) {
  std::string script = "source '" + (written() / ("bash/" + program)).string() + "'; COMP_WORDS=(";
  for (const std::string& word : words) script += "\"" + word + "\" ";
  script += "); COMP_CWORD=" + std::to_string(words.size() - 1) + "; _" + program +
            "_completion; printf \"%s\\n\" \"${COMPREPLY[@]}\"";
  const ProgramRun run =
      runProgram("bash", {"-c", std::regex_replace(script, std::regex("'"), "")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  std::vector<std::string> offered = lines(run.out);
  std::erase(offered, "");
  return offered;
}

TEST(Documents, OfWhsKnowEveryCommandAndOptionOfItsHelp) {
  const std::string fish = written().read("fish/whs.fish");
  const std::string zsh = written().read("zsh/_whs");
  const std::vector<std::string> commands = commandsOf(runWhs({"--help"}).out);
  ASSERT_GT(commands.size(), 15u);
  for (const std::string& command : commands) {
    SCOPED_TRACE(command);
    const std::string page = written().read("man1/whs-" + command + ".1");
    const std::set<std::string> options = optionsOf(runWhs({command, "--help"}).out);
    EXPECT_GE(options.size(), 2u);
    const std::vector<std::string> offered = offeredByBash("whs", {"whs", command, "--"});
    EXPECT_EQ(std::set<std::string>(offered.begin(), offered.end()), options);
    for (const std::string& option : options) {
      EXPECT_NE(page.find("\\fB" + escaped(option) + "\\fR"), std::string::npos) << option;
      EXPECT_NE(zsh.find(option + "["), std::string::npos) << option;
      EXPECT_NE(fish.find("__fish_seen_subcommand_from " + command + "' "), std::string::npos);
      EXPECT_NE(fish.find(" -l " + option.substr(2) + " "), std::string::npos) << option;
    }
  }
}

TEST(Documents, HideWhatTheHelpHides) {
  EXPECT_FALSE(std::filesystem::exists(written() / "man1/whs-documents.1"));
  EXPECT_EQ(offeredByBash("whs", {"whs", "docu"}), std::vector<std::string>());
  EXPECT_EQ(offeredByBash("whs", {"whs", "localize", "--kern"}), std::vector<std::string>());
}

TEST(Documents, InBashOfferCommandsThenOptionsThenChoices) {
  EXPECT_EQ(offeredByBash("whs", {"whs", "loc"}), std::vector<std::string>{"localize"});
  EXPECT_EQ(offeredByBash("whs", {"whs", "localize", "--see"}), std::vector<std::string>{"--seed"});
  EXPECT_EQ(offeredByBash("whs", {"whs", "localize", "--profile", "f"}),
            std::vector<std::string>{"flight"});
  // A file: left to the shell.
  EXPECT_EQ(offeredByBash("whs", {"whs", "localize", "--seed", ""}), std::vector<std::string>());
}

TEST(Documents, InFishOfferCommandsThenOptionsThenChoices) {
  if (!hasProgram("fish")) GTEST_SKIP() << "there is no fish";
  const auto offered = [](const std::string& line) {
    const ProgramRun run = runProgram("fish", {"--no-config", "-c",
                                               "source " + (written() / "fish/whs.fish").string() +
                                                   "; complete -C \"" + line + "\""});
    EXPECT_EQ(run.err, "");
    return run.out;
  };
  EXPECT_EQ(offered("whs loc").rfind("localize\t", 0), 0u) << offered("whs loc");
  EXPECT_EQ(offered("whs localize --see").rfind("--seed\t", 0), 0u);
  const std::string profiles = offered("whs localize --profile f");
  EXPECT_EQ(profiles.rfind("flight\t", 0), 0u) << profiles;
  EXPECT_EQ(lines(profiles).size(), 1u) << profiles;
  EXPECT_EQ(offered("whs docu").find("documents"), std::string::npos);
}

TEST(Documents, AreWhatZshReads) {
  if (!hasProgram("zsh")) GTEST_SKIP() << "there is no zsh";
  const ProgramRun run = runProgram("zsh", {"-n", (written() / "zsh/_whs").string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
}

TEST(Documents, ArePagesThatRoffHasNothingToSayOf) {
  if (!hasProgram("groff")) GTEST_SKIP() << "there is no groff";
  int pages = 0;
  for (const auto& entry : std::filesystem::directory_iterator(written() / "man1")) {
    const ProgramRun run =
        runProgram("groff", {"-man", "-Tutf8", "-ww", "-z", entry.path().string()});
    EXPECT_EQ(run.err, "") << entry.path();
    ++pages;
  }
  EXPECT_GT(pages, 15);
}

TEST(Documents, ThatCannotBeWrittenAreOneLine) {
  const ProgramRun run = runWhs({"documents", "/proc/nowhere"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.errorLines(), 1) << run.err;
}

#ifdef BORESIGHT_DESKTOP_PROGRAM
TEST(Documents, OfTheDesktopProgramKnowEveryOptionOfItsHelp) {
  const ProgramRun wrote =
      runProgram("env -u DISPLAY -u QT_QPA_PLATFORM " BORESIGHT_DESKTOP_PROGRAM,
                 {"--documents", written().path().string()});
  ASSERT_EQ(wrote.exit_code, 0) << wrote.err;
  const ProgramRun help =
      runProgram("env -u DISPLAY -u QT_QPA_PLATFORM " BORESIGHT_DESKTOP_PROGRAM, {"--help"});
  ASSERT_EQ(help.exit_code, 0) << help.err;
  std::set<std::string> options = optionsOf(help.out);
  options.erase("--help-all");  // Qt's own addition
  EXPECT_TRUE(options.contains("--self-test"));
  EXPECT_TRUE(options.contains("--screenshot"));
  const std::string page = written().read("man1/boresight.1");
  for (const std::string& option : options)
    EXPECT_NE(page.find("\\fB" + escaped(option) + "\\fR"), std::string::npos) << option;
  EXPECT_EQ(page.find("documents\\fR"), std::string::npos);
  EXPECT_EQ(offeredByBash("boresight", {"boresight", "--scr"}),
            std::vector<std::string>{"--screenshot"});
}

TEST(DesktopProgram, SaysItsVersionWithoutADisplay) {
  const ProgramRun run =
      runProgram("env -u DISPLAY -u QT_QPA_PLATFORM " BORESIGHT_DESKTOP_PROGRAM, {"--version"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out.rfind("boresight 0.", 0), 0u) << run.out;
}
#endif

}  // namespace
}  // namespace boresight::test
