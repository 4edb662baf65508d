// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/example_case.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {

using Arguments = std::vector<std::string>;

/// Programs that tests run keep no log in the user's home.
inline const int kNoLog = ::setenv("XDG_STATE_HOME", "/dev/null", 1);

/// How a program ended and what it said.
struct ProgramRun {
  int exit_code = -1;  ///< -1 when it did not end by itself
  std::string out;
  std::string err;

  std::ptrdiff_t errorLines() const { return std::count(err.begin(), err.end(), '\n'); }
};

inline ProgramRun runProgram(const std::string& program, const Arguments& arguments) {
  const TemporaryFolder folder;
  std::string command = program;
  for (const std::string& argument : arguments) command += " '" + argument + "'";
  command += " >'" + (folder / "out").string() + "' 2>'" + (folder / "err").string() + "'";
  const int status = std::system(command.c_str());
  ProgramRun run;
  if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  run.out = folder.read("out");
  run.err = folder.read("err");
  return run;
}

inline ProgramRun runWhs(const Arguments& arguments) {
  return runProgram(BORESIGHT_WHS, arguments);
}

/// The same; the test fails when it ends with another exit status.
inline ProgramRun runWhs(const Arguments& arguments, int exit_code) {
  ProgramRun run = runWhs(arguments);
  EXPECT_EQ(run.exit_code, exit_code) << testing::PrintToString(arguments) << "\n"
                                      << run.out << run.err;
  return run;
}

/// What whs says when it ends with this exit status and with one line on stderr.
inline std::string refusal(const Arguments& arguments, int exit_code = 3) {
  const ProgramRun run = runWhs(arguments, exit_code);
  EXPECT_EQ(run.errorLines(), 1) << run.err;
  return run.err;
}

/// Options by which the example converges from its seed, in a third of the time of a search.
inline constexpr const char* kNoSearch = "search.enabled=false";
/// Options of a run that ends early, at its iteration limit.
inline const Arguments kQuick = {"--set", kNoSearch, "loop.max_iterations=1",
                                 "loop.max_attempts=1"};

/// The same arguments with others at their end.
inline Arguments with(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// The arguments of `whs localize` for the example's orbiting sample; `replaced` gives some options
/// another value, or takes them away with an empty one. Without a search unless it is asked for.
inline Arguments localizeArguments(const std::map<std::string, std::string>& replaced = {},
                                   bool search = false) {
  const std::filesystem::path folder = exampleFolder() / "os";
  std::map<std::string, std::string> options = {
      {"--image", (folder / "image.png").string()}, {"--camera", (folder / "camera.json").string()},
      {"--mesh", (folder / "model.ply").string()},  {"--mesh-unit", "m"},
      {"--seed", (folder / "seed.json").string()},  {"--feature-size", "0.018"}};
  for (const auto& [name, value] : replaced) options[name] = value;
  Arguments arguments = {"localize"};
  for (const auto& [name, value] : options) {
    if (value.empty()) continue;
    arguments.push_back(name);
    arguments.push_back(value);
  }
  return search ? arguments : with(arguments, {"--set", kNoSearch});
}

/// What a program says from the word "digest" on, which ends what whs localize prints of a run.
inline std::string digestOf(const ProgramRun& run) {
  return run.out.substr(std::min(run.out.find("digest"), run.out.size()), 64 + 7);
}

/// The data set of the example.
inline std::string exampleDataset() { return exampleFolder() / "dataset.json"; }

/// A copy of the example's stations that a test may spoil; returns its data set.
inline std::string copyOfExample(const TemporaryFolder& folder) {
  std::filesystem::copy(exampleFolder(), folder / "stations",
                        std::filesystem::copy_options::recursive);
  return folder / "stations/dataset.json";
}

/// The example's case of the orbiting sample.
inline constexpr const char* kOsCase = "os-000038";

/// A new session of the example in `folder`, which runs without a search: of that case, or of all.
inline std::string newSession(const TemporaryFolder& folder, bool all_cases = false) {
  const std::string file = folder / "s.boresight.json";
  Arguments arguments = {"new", "--dataset", exampleDataset(), "--out", file, "--set", kNoSearch};
  if (!all_cases) arguments.insert(arguments.end(), {"--case", kOsCase});
  runWhs(arguments, 0);
  return file;
}

}  // namespace boresight::test
