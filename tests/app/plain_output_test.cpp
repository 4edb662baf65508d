// SPDX-License-Identifier: Apache-2.0
// What whs prints: text that came in files cannot act on the terminal or begin a line of its own,
// and output that is lost is not passed over.
#include <gtest/gtest.h>

#include "tests/app/json_lines.h"
#include "tests/app/run_whs.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using nlohmann::json;

/// A name that would colour, clear and turn round the terminal, and forge a line.
std::string hostile(const std::string& name) {
  return name +
         "\x1b[31m\t\x7f\xc2\x9b"
         "2J\xe2\x80\xae\r\nFORGED\xe2\x80\xa8 line";
}

/// Nothing but text, and no line that a name began.
void expectPlain(const ProgramRun& run, const std::string& command) {
  const std::string text = run.out + run.err;
  EXPECT_THAT(text, HasSubstr("FORGED")) << command << " prints none of the names";
  for (const char c : text)
    EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20) << command << "\n" << text;
  for (const char* sequence : {"\x7f", "\xc2\x9b", "\xe2\x80\xae", "\xe2\x80\xa8", "\nFORGED"})
    EXPECT_EQ(text.find(sequence), std::string::npos) << command << "\n" << text;
}

class PlainOutput : public testing::Test {
 protected:
  PlainOutput() {
    json dataset = jsonOf(exampleDataset());
    for (json& item : dataset["cases"]) {
      const std::string folder = item["image"].get<std::string>().substr(0, 2);
      const std::string image = hostile(folder) + ".png";
      std::filesystem::copy(exampleFolder() / item["image"].get<std::string>(), folder_ / image);
      item["image"] = image;
      item["tags"] = {hostile("tag")};
      for (const char* member : {"id", "station", "camera"}) item[member] = hostile(item[member]);
    }
    for (const std::string station : {"bc", "os"}) {
      const std::string mesh = hostile(station) + ".ply";
      std::filesystem::copy(exampleFolder() / station / "model.ply", folder_ / mesh);
      dataset["stations"][station]["mesh"] = mesh;
    }
    for (const char* member : {"stations", "cameras"}) {
      json renamed = json::object();
      for (const auto& [name, value] : dataset[member].items()) renamed[hostile(name)] = value;
      dataset[member] = renamed;
    }
    case_ = dataset["cases"][0]["id"];
    folder_.write("dataset.json", dataset.dump());
  }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  /// Runs a command that is to end with one of these, and looks at what it prints.
  static void run(const Arguments& arguments, int exit_code = 0) {
    expectPlain(runWhs(arguments, exit_code), arguments[0]);
  }

  TemporaryFolder folder_;
  std::string case_;
};

TEST_F(PlainOutput, OfSessionsIsText) {
  const std::string session = file("s.boresight.json");
  run({"info", file("dataset.json")});
  runWhs({"new", "--dataset", file("dataset.json"), "--out", session, "--set", kNoSearch}, 0);
  run({"run", session});
  run({"check", session, "--case", case_, "--convergence-test", "0", "--sentences"}, 0);
  run({"decide", session, "--case", case_, "--validate", "--convergence-test", "0", "--by",
       hostile("Ada"), "--comment", hostile("right")});
  run({"info", session});
  run({"queue", session, "--csv", file("q.csv")});
  run({"queue", session, "--differences"});
  run({"report", session, "--case", case_, "--out", file("r.pdf")});
  run({"export", session, "--case", case_, "--pose", file("p.json")});
  run({"verify", file("p.json")});
  run({"info", file("p.json")});
  run({"run", session, "--case", "none" + hostile("")}, 3);
}

TEST_F(PlainOutput, OfResultsAndUsageErrorsIsText) {
  const std::string results = file("r.sqlite");
  run(with({"evaluate", "--dataset", file("dataset.json"), "--out", results}, kQuick));
  run({"tables", results});
  run({"tables", results, "--against", results, "--all"});
  run({"problem", "--dataset", file("dataset.json"), "--case", hostile("none"), "--out",
       file("p.bin"), "--image-out", file("p.pgm")},
      3);
  run({"options", hostile("--what")}, 2);
  run({"info", file(hostile("none.json"))}, 3);
}

/// Whs with its output on a full device.
ProgramRun runOnFullDevice(const Arguments& arguments) {
  std::string command = BORESIGHT_WHS;
  for (const std::string& argument : arguments) command += " \"" + argument + "\"";
  return runProgram("sh", {"-c", command + " >/dev/full"});
}

TEST(LostOutput, FailsTheProgramAndHidesNoOtherFailure) {
  const std::filesystem::path example = exampleFolder() / "os";
  for (const Arguments& arguments :
       {localizeArguments(), Arguments{"info", example / "image.png"}, Arguments{"options"},
        Arguments{"--help"}, Arguments{"--version"}}) {
    const ProgramRun lost = runOnFullDevice(arguments);
    EXPECT_EQ(lost.exit_code, 3) << arguments[0] << lost.err;
    EXPECT_THAT(lost.err, HasSubstr("cannot write standard output")) << arguments[0];
    EXPECT_EQ(lost.errorLines(), 1) << lost.err;
  }
  const ProgramRun lost = runOnFullDevice(localizeArguments({{"--set", "loop.max_iterations=1"}}));
  EXPECT_EQ(lost.exit_code, 4) << "it did not converge either";
  EXPECT_THAT(lost.err, HasSubstr("cannot write standard output"));
}

}  // namespace
}  // namespace boresight::test
