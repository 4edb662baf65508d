// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/options_page.h"
#include "sessions/baselines/methods.h"
#include "sessions/text/text_table.h"

namespace boresight::app {
namespace {

using sessions::OptionDescription;

void printTable(const std::vector<OptionDescription>& options) {
  for (const OptionDescription& option : options) {
    std::cout << option.name << " = " << sessions::valueText(option, option.value) << "   ("
              << rangeText(option) << ")\n    " << option.help << "\n";
  }
}

void printOptions(const std::string& profile) {
  printTable(sessions::listOptions(profileOptions(profile)));
  std::cout << "\nOf the methods beside whs (" << sessions::methodNames() << "):\n";
  printTable(sessions::listOptions(sessions::MethodOptions()));
}

}  // namespace

void addOptions(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "options", "Lists every parameter of a run: value in a profile, range, meaning");
  auto profile = std::make_shared<std::string>("default");
  command->add_option("--profile", *profile, "default or paper")
      ->check(CLI::IsMember({"default", "paper"}))
      ->capture_default_str();
  command->callback([profile, &exit_code] {
    printOptions(*profile);
    exit_code = kDone;
  });
}

}  // namespace boresight::app
