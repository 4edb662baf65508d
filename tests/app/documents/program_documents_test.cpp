// SPDX-License-Identifier: Apache-2.0
// Completions and manual pages against what --help prints, in the programs that read them.
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/app/run_whs.h"

namespace boresight::test {
namespace {

const std::string kCompletions = BORESIGHT_APP "/completions/";

bool hasProgram(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

std::set<std::string> lines(const std::string& text) {
  std::set<std::string> found;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (!line.empty()) found.insert(line);
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

std::set<std::string> offered(const Arguments& words) {
  return lines(runWhs(with({"--complete"}, words), 0).out);
}

using Words = std::set<std::string>;

TEST(Completions, KnowEveryCommandAndOptionOfTheHelp) {
  const std::string help = runWhs({"--help"}, 0).out;
  const Words commands = offered({""});
  EXPECT_GT(commands.size(), 15u);
  for (const std::string& command : commands) {
    EXPECT_NE(help.find("\n  " + command + " "), std::string::npos) << command;
    EXPECT_EQ(offered({command, "--"}), optionsOf(runWhs({command, "--help"}, 0).out)) << command;
  }
}

TEST(Completions, OfferCommandsThenOptionsThenChoices) {
  EXPECT_EQ(offered({"loc"}), Words{"localize"});
  EXPECT_EQ(offered({"localize", "--see"}), Words{"--seed"});
  EXPECT_EQ(offered({"localize", "--profile", "f"}), Words{"flight"});
  EXPECT_EQ(offered({"localize", "--seed", ""}), Words{});  // a file: left to the shell
  EXPECT_EQ(offered({"docu"}), Words{});                    // hidden from the help
  EXPECT_EQ(offered({"localize", "--kern"}), Words{});
  EXPECT_EQ(offered({"nothing", "--"}), Words{});
}

TEST(Completions, WorkInBash) {
  const std::string script = "source " + kCompletions +
                             "whs; COMP_WORDS=(" BORESIGHT_WHS
                             " localize --profile f) COMP_CWORD=3; _whs; echo ${COMPREPLY[*]}";
  EXPECT_EQ(runProgram("bash", {"-c", script}).out, "flight\n");
}

TEST(Completions, AreWhatOtherShellsRead) {
  for (const auto& [shell, file] :
       {std::pair("zsh", "_whs"), std::pair("zsh", "_boresight"), std::pair("fish", "whs.fish"),
        std::pair("fish", "boresight.fish")}) {
    if (!hasProgram(shell)) continue;
    const ProgramRun run = runProgram(shell, {"-n", kCompletions + file});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
  }
}

TEST(ManualPages, ProgramAndCommands_HavePagesThatRoffReads) {
  if (!hasProgram("help2man")) GTEST_SKIP() << "there is no help2man";
  const TemporaryFolder folder;
  const ProgramRun run =
      runProgram(BORESIGHT_APP "/manual_pages.sh", {folder.path().string(), BORESIGHT_WHS});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  Words commands = offered({""});
  for (const std::string& command : commands) {
    const std::string page = folder.read("whs-" + command + ".1");
    const std::string name = std::regex_replace(command, std::regex("-"), R"(\-)");
    EXPECT_NE(page.find("\nwhs\\-" + name + " \\- "), std::string::npos) << page.substr(0, 400);
  }
  EXPECT_NE(folder.read("whs.1").find(".SH NAME\nwhs \\- "), std::string::npos);
  if (!hasProgram("groff")) GTEST_SKIP() << "there is no groff";
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_EQ(runProgram("groff", {"-man", "-Tutf8", "-ww", "-z", entry.path().string()}).err, "");
}

#ifdef BORESIGHT_DESKTOP_PROGRAM
TEST(DesktopProgram, SaysItsVersionAndItsOptionsWithoutADisplay) {
  const TemporaryFolder folder;
  // Qt warns of a session without a folder of its own.
  const std::string program =
      "env -u DISPLAY -u QT_QPA_PLATFORM XDG_RUNTIME_DIR=" + folder.path().string() +
      " " BORESIGHT_DESKTOP_PROGRAM;
  EXPECT_EQ(runProgram(program, {"--version"}).out.rfind("boresight 1.", 0), 0u);
  ASSERT_EQ(runProgram(program, {"--documents", folder.path().string()}).exit_code, 0);
  const std::string page = folder.read("boresight.md");
  for (const char* option : {"--self-test", "--screenshot FILE"})
    EXPECT_NE(page.find("| `" + std::string(option) + "` |"), std::string::npos) << page;
  EXPECT_EQ(runProgram(program, {"--documents", "/proc/nowhere"}).errorLines(), 1);
}

TEST(DesktopProgram, DisplayThatDoesNotAnswer_IsOneSentence) {
  const TemporaryFolder folder;
  const std::string runtime = "XDG_RUNTIME_DIR=" + folder.path().string();
  for (const std::string& display :
       {std::string("-u DISPLAY"), std::string("DISPLAY=:91"),
        std::string("DISPLAY=localhost:10.0"), std::string("QT_QPA_PLATFORM=wayland"),
        std::string("QT_QPA_PLATFORM='wayland;xcb'")}) {
    const std::string unset = display.starts_with("DISPLAY") ? "" : "-u DISPLAY ";
    const ProgramRun run = runProgram(
        "env -u QT_QPA_PLATFORM " + unset + display + " " + runtime + " " BORESIGHT_DESKTOP_PROGRAM,
        {"/nowhere.boresight.json"});
    EXPECT_EQ(run.exit_code, 3) << display << run.err;
    EXPECT_EQ(run.err, "boresight: there is no display: connect with ssh -X, or use whs\n")
        << display;
  }
}
#endif

}  // namespace
}  // namespace boresight::test
