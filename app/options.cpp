// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/written_pages.h"
#include "core/record/parameter_table.h"
#include "sessions/baselines/methods.h"
#include "sessions/decision/check_limits.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/text/plain_text.h"

namespace boresight::app {
namespace {

using sessions::OptionDescription;
using sessions::OptionKind;
using Options = std::vector<OptionDescription>;

/// "0 .. 10", or the choices.
std::string rangeText(const OptionDescription& option) {
  if (option.kind == OptionKind::kBoolean) return "true, false";
  if (option.kind == OptionKind::kChoice) return sessions::joined(option.choices);
  return sessions::numberText(option.minimum) + " .. " + sessions::numberText(option.maximum);
}

/// One column of values by what they are called.
struct Column {
  std::string title;
  Options options;
};

/// "edges" of edges.high_quantile.
std::string groupOf(const OptionDescription& option) {
  return option.name.substr(0, option.name.find('.'));
}

/// The value in the first column's set, and those in others that differ from it.
std::string values(const std::vector<Column>& columns, std::size_t index) {
  const OptionDescription& option = columns.front().options[index];
  const std::string first = sessions::valueText(option, option.value);
  std::string text = first;
  for (const Column& column : columns) {
    const std::string other = sessions::valueText(option, column.options[index].value);
    if (other != first) text += "; " + column.title + ": " + other;
  }
  return text;
}

std::string row(const std::vector<Column>& columns, std::size_t index) {
  const OptionDescription& option = columns.front().options[index];
  return "| `" + option.name + "` | " + markdownText(values(columns, index)) + " | " +
         markdownText(option.help) + " (" + markdownText(rangeText(option)) + ") |\n";
}

/// A table for every group of options, in the order of declaration.
std::string tables(const std::vector<Column>& columns, const std::string& heading) {
  std::string text;
  std::string group;
  for (std::size_t i = 0; i < columns.front().options.size(); ++i) {
    if (groupOf(columns.front().options[i]) != group) {
      group = groupOf(columns.front().options[i]);
      text += "\n" + heading + " " + group + "\n\n| option | " + columns.front().title +
              " | meaning |\n|---|---|---|\n";
    }
    text += row(columns, i);
  }
  return text;
}

void printList(const std::vector<OptionDescription>& options) {
  for (const OptionDescription& option : options) {
    std::cout << option.name << " = " << sessions::valueText(option, option.value) << "   ("
              << rangeText(option) << ")\n    " << option.help << "\n";
  }
}

struct OptionsArguments {
  OptionArguments options;
  std::string table, dictionary;

  void addTo(CLI::App& command) {
    options.addTo(command);
    addFile(command, "--table", table,
            "Writes the options as a binary table with a checksum, which --config and the flight "
            "driver read");
    addFile(command, "--dictionary", dictionary,
            "Writes a description of the table's parameters as JSON");
  }
};

void writeTable(const std::string& file, const LocalizerOptions& options) {
  std::vector<std::uint8_t> bytes(encodeParameters(options, {}));
  (void)encodeParameters(options, bytes);
  sessions::writeFileAtomically(file, bytes);
}

/// Name, kind, unit, range, meaning and default of every option, in the order of the table.
void writeDictionary(const std::string& file) {
  static const char* const kKinds[] = {"boolean", "integer", "real", "choice"};
  nlohmann::ordered_json json = {{"format", "boresight-parameter-dictionary"},
                                 {"version", kParameterVersion}};
  json["parameters"] = nlohmann::ordered_json::array();
  for (const OptionDescription& option : sessions::listOptions(LocalizerOptions())) {
    nlohmann::ordered_json entry = {{"name", option.name},
                                    {"kind", kKinds[static_cast<int>(option.kind)]},
                                    {"default", sessions::valueText(option, option.value)},
                                    {"meaning", option.help}};
    if (!option.unit.empty()) entry["unit"] = option.unit;
    if (option.kind == OptionKind::kChoice) entry["choices"] = option.choices;
    if (option.kind == OptionKind::kInteger || option.kind == OptionKind::kReal)
      entry["range"] = {option.minimum, option.maximum};
    json["parameters"].push_back(std::move(entry));
  }
  sessions::writeJsonFile(file, json);
}

int printOptions(const OptionsArguments& arguments) {
  const LocalizerOptions options = arguments.options.read();  // an input is never an output
  if (!arguments.table.empty()) writeTable(arguments.table, options);
  if (!arguments.dictionary.empty()) writeDictionary(arguments.dictionary);
  if (!arguments.table.empty() || !arguments.dictionary.empty()) return kDone;
  const std::string profile = arguments.options.profileName();
  printList(sessions::listOptions(options));
  std::cout << "\nOptions of the other methods (" << sessions::methodNames() << "):\n";
  printList(sessions::listOptions(methodProfile(profile)));
  return kDone;
}

/// The manual's page of every option: of a run, of the other methods, and the limits of the
/// checks, as they are declared, with their values in each profile and preset.
std::string optionsPage() {
  std::string text =
      "# Every option\n\n"
      "A run takes them from its profile, then from `--config`, then from `--set NAME=VALUE`; in "
      "the desktop program *Configuration* shows and changes them. A session keeps those that "
      "differ from its profile. The profile `flight` has the options of `default`, and refuses "
      "what does not fit its memory. `whs options` prints the same list.\n\n"
      "## Options of a run\n";
  text += tables({{"default", sessions::listOptions(profileOptions("default"))},
                  {"paper", sessions::listOptions(profileOptions("paper"))}},
                 "###");
  text += "\n## Options of the other methods\n\nFor `--method`; see [Other methods](methods.md).\n";
  text += tables({{"default", sessions::listOptions(methodProfile("default"))},
                  {"paper", sessions::listOptions(methodProfile("paper"))}},
                 "###");
  text +=
      "\n## Limits of the checks\n\nSet by *Limits* under *Review*, or by `whs check --preset`; "
      "see [What each check means](checks.md).\n";
  std::vector<Column> presets;
  for (const sessions::CheckPreset& preset : sessions::checkPresets())
    presets.push_back({preset.name, sessions::listOptions(preset.limits)});
  return text + tables(presets, "###");
}

/// Every command under a heading of its own, with the text of `--help`.
std::string commandsPage(const CLI::App& app) {
  std::string text = "# whs, command by command\n\nExit status: " + markdownText(kExitStatusText) +
                     "\n\n" + commandText(app);
  for (const CLI::App* command : app.get_subcommands({}))
    if (!command->get_group().empty())
      text += "\n## whs " + command->get_name() + "\n\n" + commandText(*command);
  return text;
}

}  // namespace

void addOptions(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "options",
             "Lists every option of a run: value, range, meaning; or writes them as a table for "
             "uplink",
             printOptions);
}

/// Writes the manual's pages of commands and options, for the build: hidden from the help.
void addDocuments(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("documents", "Writes pages of the manual");
  command->group("");
  auto folder = std::make_shared<std::string>();
  addOption(*command, "folder", "DIR", *folder, "Folder of the pages")->required();
  command->callback([folder, &app, &exit_code] {
    exit_code = writePages(*folder, {{"options.md", optionsPage()}, {"whs.md", commandsPage(app)}});
  });
}

}  // namespace boresight::app
