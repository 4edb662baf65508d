// SPDX-License-Identifier: Apache-2.0
#include "app/documents/manual_page.h"

#include <gtest/gtest.h>

namespace boresight::documents {
namespace {

Program exampleProgram() {
  Argument size;
  size.names = {"-s", "--size"};
  size.value = "N";
  size.help = "Size. More of it";
  size.limits = "1 to 9";
  size.fallback = "3";
  Argument file;
  file.position = "session";
  file.value = "FILE";
  file.help = ".hidden files, too";
  file.required = true;
  Program command;
  command.name = "make";
  command.help = "Makes a \"thing\" of \\ and -. It takes a while";
  command.arguments = {size, file};
  Program program;
  program.name = "tool";
  program.help = "Does things";
  program.exit_status = "0 done.";
  program.commands = {command};
  return program;
}

TEST(ManualPages, AreOneForTheProgramAndOneForEachCommand) {
  const auto pages = manualPages(exampleProgram(), "1.2");
  ASSERT_EQ(pages.size(), 2u);
  EXPECT_EQ(pages[0].first, "tool.1");
  EXPECT_EQ(pages[1].first, "tool-make.1");
  EXPECT_NE(pages[0].second.find("\\fBtool\\-make\\fR(1)"), std::string::npos) << pages[0].second;
}

TEST(ManualPages, ShowTextThatRoffWouldTakeForItsOwn) {
  const std::string page = manualPages(exampleProgram(), "1.2")[1].second;
  EXPECT_NE(page.find("tool\\-make \\- Makes a \"thing\" of \\e and \\-\n"), std::string::npos);
  EXPECT_NE(page.find("\n\\&.hidden files, too.\n"), std::string::npos) << page;
  EXPECT_EQ(page.find("\n.hidden"), std::string::npos);
}

TEST(ManualPages, SayWhatAnOptionTakesAndWhatItIsWithout) {
  const std::string page = manualPages(exampleProgram(), "1.2")[1].second;
  EXPECT_NE(page.find(".TP\n\\fB\\-s\\fR, \\fB\\-\\-size\\fR \\fIN\\fR\n"
                      "Size. More of it. Value: 1 to 9. Default: 3.\n"),
            std::string::npos)
      << page;
  EXPECT_NE(page.find("\\fBtool make\\fR [\\fIoption\\fR ...] \\fIsession\\fR\n"),
            std::string::npos)
      << page;
  EXPECT_NE(page.find(".SH EXIT STATUS\n0 done.\n"), std::string::npos);
}

}  // namespace
}  // namespace boresight::documents
