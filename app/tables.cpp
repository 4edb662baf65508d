// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <set>
#include <sstream>
#include <stop_token>

#include "app/batch_output.h"
#include "app/commands.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/files/created_folder.h"
#include "sessions/io/files/errors.h"
#include "sessions/tables/error_strips.h"
#include "sessions/tables/flight_table.h"
#include "sessions/tables/method_tables.h"
#include "sessions/tables/result_figures.h"
#include "sessions/tables/results_set.h"
#include "sessions/tables/strata_table.h"
#include "sessions/text/plain_text.h"

namespace boresight::app {
namespace {

using sessions::CanvasFormat;
using sessions::Table;
using sessions::TableFormat;

struct TablesArguments {
  std::vector<std::string> results;
  std::vector<std::string> against;
  std::vector<std::string> tables;
  sessions::ResultsFilter filter;
  std::string format = "text";
  std::string out, figures, failures, instructions;
  double demonstrate_percent = 0.0;  ///< 0: no such table
  std::vector<std::string> figure_formats = {"pdf"};
  bool paper = false;
  bool all = false;

  void addTo(CLI::App& command) {
    addFile(command, "RESULTS", results, "Results of `whs evaluate`")->required();
    auto* comparison = addFile(command, "--against", against,
                               "Compares RESULTS (before) with these results (after), run by run");
    command.add_flag("--all", all, "With --against: also lists unchanged runs");
    command  // not addChoice: the help would show the empty default as []
        .add_option("--table", tables,
                    "Tables to print: errors, success, strata, tolerance, times (default: all)")
        ->check(CLI::IsMember({"errors", "success", "strata", "tolerance", "times"}))
        ->excludes(comparison);
    addOption(command, "--station", "S", filter.stations, "Only runs of these stations");
    addOption(command, "--tag", "T", filter.tags, "Only runs with one of these tags");
    addOption(command, "--method", "M", filter.methods, "Only runs of these methods");
    command
        .add_flag("--paper", paper,
                  "Adds the figures of Pham et al. 2025, with notes on the comparison")
        ->excludes(comparison);
    addFile(command, "--instructions", instructions,
            "Adds a table of minutes at 200 MHz from counts of tests/benchmarks/instructions.sh")
        ->excludes(comparison);
    addOption(command, "--demonstrate", "P", demonstrate_percent,
              "Adds a table: runs that demonstrate this success rate, percent, at 95 % "
              "confidence")
        ->check(CLI::Range(1.0, 99.9999))
        ->excludes(comparison);
    addChoice(command, "--format", format, {"text", "csv", "latex"}, "text, csv or latex")
        ->type_name("F");
    addFile(command, "--out", out, "Writes the tables to this file instead of the terminal");
    addOption(command, "--figures", "FOLDER", figures,
              "Draws the figures into this folder: error_strips, error_distribution, "
              "success_tolerance, success_seed_error, time_accuracy")
        ->excludes(comparison);
    addOption(command, "--failures", "FOLDER", failures,
              "Draws each unsuccessful run into this folder, with the cause of failure; needs "
              "the dataset's images")
        ->excludes(comparison);
    addChoice(command, "--figure-format", figure_formats, {"pdf", "svg", "png"},
              "Formats of the figures: pdf, svg, png")
        ->type_name("F");
  }
};

TableFormat tableFormat(const TablesArguments& arguments) {
  if (arguments.format == "csv") return TableFormat::kCsv;
  return arguments.format == "latex" ? TableFormat::kLatex : TableFormat::kText;
}

CanvasFormat canvasFormat(const std::string& name) {
  if (name == "svg") return CanvasFormat::kSvg;
  return name == "png" ? CanvasFormat::kPng : CanvasFormat::kPdf;
}

void write(const TablesArguments& arguments, const std::string& text) {
  if (arguments.out.empty())
    std::cout << text << std::flush;
  else
    sessions::writeFileAtomically(arguments.out, text);
}

/// Files, machines and options of a table's runs.
std::string provenanceText(const sessions::ResultsSet& set) {
  std::string text;
  for (const sessions::ResultsFacts& file : set.files)
    text += sessions::plainLine(file.file.string() + ": " + file.dataset.dataset + " (SHA-256 " +
                                file.dataset.dataset_sha256.substr(0, 12) + "), version " +
                                file.dataset.version);
  std::set<std::string> machines;
  for (const sessions::ResultsFacts& file : set.files)
    for (const sessions::BatchRun& batch_run : file.batch_runs)
      machines.insert(batch_run.processor + ", " + std::to_string(batch_run.jobs) + " jobs of " +
                      std::to_string(batch_run.threads) + " threads");
  for (const std::string& machine : machines) text += sessions::plainLine("run on " + machine);
  for (const auto& [name, method] : set.methods)
    text += sessions::plainLine(
        name + ": profile " + method.profile +
        (method.options == "{}" ? "" : ", options " + method.options) +
        (method.mesh_of.empty() ? "" : ", WRONG mesh of " + method.mesh_of) +
        (method.mirror.empty() ? "" : ", WRONG mesh mirrored across " + method.mirror) +
        (method.note.empty() ? "" : ", " + method.note));
  return text;
}

/// Below tables; in LaTeX as comments. CSV has no place for it.
std::string provenanceOf(const sessions::ResultsSet& set, TableFormat format) {
  if (format == TableFormat::kCsv) return "";
  const std::string text = provenanceText(set);
  if (format == TableFormat::kText) return "\n" + text;
  std::istringstream lines(text);
  std::string comments;
  for (std::string line; std::getline(lines, line);) comments += "% " + line + "\n";
  return comments;
}

std::vector<std::filesystem::path> paths(const std::vector<std::string>& files) {
  return {files.begin(), files.end()};
}

std::vector<Table> tablesOf(const TablesArguments& arguments, const sessions::ResultsSet& set) {
  std::vector<Table> made;
  const auto add = [&](const char* name, auto make) {
    if (arguments.tables.empty() ||
        std::find(arguments.tables.begin(), arguments.tables.end(), name) != arguments.tables.end())
      made.push_back(make());
  };
  const std::span<const sessions::RunResult> runs = set.runs;
  add("errors", [&] { return sessions::errorTable(runs, arguments.paper); });
  add("success", [&] { return sessions::successTable(runs, arguments.paper); });
  add("strata", [&] { return sessions::strataTable(runs); });
  add("tolerance", [&] { return sessions::toleranceTable(runs); });
  add("times", [&] { return sessions::timeTable(runs); });
  if (!arguments.instructions.empty())
    made.push_back(sessions::flightTable(sessions::readInstructionCounts(arguments.instructions),
                                         arguments.paper));
  if (arguments.demonstrate_percent > 0.0)
    made.push_back(sessions::demonstrationTable(runs, 0.01 * arguments.demonstrate_percent));
  return made;
}

std::string tablesText(const TablesArguments& arguments, const sessions::ResultsSet& set) {
  std::string text;
  for (const Table& table : tablesOf(arguments, set))
    text += (text.empty() ? "" : "\n") + sessions::tableText(table, tableFormat(arguments));
  return text + provenanceOf(set, tableFormat(arguments));
}

void writeFigures(const std::filesystem::path& folder, CanvasFormat format,
                  const std::vector<sessions::Figure>& figures) {
  for (const sessions::Figure& figure : figures)
    sessions::writeFileAtomically(folder / (figure.name + sessions::extensionOf(format)),
                                  figure.bytes);
}

void drawFigures(const TablesArguments& arguments, const sessions::ResultsSet& set) {
  for (const std::string& name : arguments.figure_formats) {
    std::vector<sessions::Figure> figures = sessions::resultFigures(set.runs, canvasFormat(name));
    figures.push_back(sessions::errorStripsFigure(set.runs, canvasFormat(name)));
    writeFigures(arguments.figures, canvasFormat(name), figures);
  }
}

void drawFailures(const TablesArguments& arguments, const std::stop_token& stop) {
  const std::vector<sessions::Failure> failures =
      sessions::failuresOf(paths(arguments.results), arguments.filter);
  if (failures.empty()) {
    note("no unsuccessful run; --failures draws nothing");
    return;
  }
  for (const std::string& name : arguments.figure_formats)
    writeFigures(arguments.failures, canvasFormat(name),
                 sessions::failureSheets(failures, canvasFormat(name), stop));
}

int compareSets(const TablesArguments& arguments, const sessions::ResultsSet& before) {
  const sessions::ResultsSet after =
      sessions::readResultsSet(paths(arguments.against), arguments.filter);
  const sessions::ResultsDifference difference = sessions::compareResults(before, after);
  const Table table = sessions::differenceTable(difference, arguments.all);
  std::string text = sessions::tableText(table, tableFormat(arguments));
  if (tableFormat(arguments) == TableFormat::kText) {
    const std::string sentence = sessions::differenceSentence(difference) + "\n";
    text = (table.rows.empty() ? sentence : text + sentence) + "\nbefore:\n" +
           provenanceText(before) + "after:\n" + provenanceText(after);
  }
  write(arguments, text);
  return difference.holds() ? kDone : kDifferent;
}

int makeTables(const TablesArguments& arguments) {
  const sessions::ResultsSet set =
      sessions::readResultsSet(paths(arguments.results), arguments.filter);
  requireWritable({arguments.out});
  const sessions::CreatedFolder figures(arguments.figures), failures(arguments.failures);
  if (!arguments.against.empty()) return compareSets(arguments, set);
  if (set.runs.empty()) {
    note("no run meets all filters");
    return kBadInput;
  }
  std::stop_source stop;
  const InterruptWatch watch(stop);
  write(arguments, tablesText(arguments, set));
  if (!arguments.figures.empty() && watch.signal() == 0) drawFigures(arguments, set);
  if (!arguments.failures.empty() && watch.signal() == 0) drawFailures(arguments, stop.get_token());
  if (watch.signal() != 0) note("interrupted; what was drawn is kept");
  return watch.exitCode(kDone);
}

}  // namespace

void addTables(CLI::App& app, int& exit_code) {
  addCommand(
      app, exit_code, "tables",
      "Writes tables and figures of results: errors, success, time per step, distributions. With "
      "--against it compares two sets of results run by run; exit status 6: a run became worse or "
      "is missing, or there is none in both",
      makeTables);
}

}  // namespace boresight::app
