// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/json/json_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/random.h"
#include "sessions/io/files/errors.h"
#include "sessions/io/json/json_writer.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace boresight::sessions {
namespace {

using J = const JsonReader&;

/// What reading `text` with `read` throws.
std::string messageOf(const std::string& text, void (*read)(J)) {
  try {
    const JsonDocument document("f.json", text);
    read(document.root());
  } catch (const InputError& error) {
    return error.what();
  }
  return "(nothing)";
}

std::string parseMessage(const std::string& text) {
  return messageOf(text, [](J) {});
}

/// How a text is read, and what is said of it without the file.
struct Reading {
  void (*read)(J);
  const char* message;
};

void expectMessages(const std::string& text, std::initializer_list<Reading> readings) {
  for (const Reading& reading : readings)
    EXPECT_EQ(messageOf(text, reading.read), std::string("f.json: ") + reading.message);
}

TEST(JsonDocument, RefusesWhatIsNotJson) {
  EXPECT_THAT(parseMessage("{\"a\": 1,\n \"b\": }"),
              StartsWith("f.json: not JSON: parse error at line 2, column 7: "));
  EXPECT_THAT(parseMessage("{\"a\": [1, 2"), HasSubstr("not JSON: the file is truncated"));
  for (const char* text : {"\x89PNG\r\n", "{} {}", "// comment\n{}", " ", "{\"a\": \"\xff\"}",
                           "{\"m\": [[1, 0], [2, NaN]]}", "[-Infinity]", "[nan]", "[1e999]"})
    EXPECT_THAT(parseMessage(text), StartsWith("f.json: not JSON: ")) << text;
  EXPECT_EQ(parseMessage("{\"a\": \"\xc3\xa9\"}"), "(nothing)");
}

TEST(JsonDocument, RefusesAKeyThatIsGivenTwice) {
  EXPECT_EQ(parseMessage("{\"a\": {\"b\": 1, \"c\": [], \"b\": 2}}"), "f.json: b: given twice");
  EXPECT_EQ(parseMessage("{\"a\": {\"b\": 1}, \"c\": {\"b\": 1}}"), "(nothing)");
}

TEST(JsonDocument, RefusesDeepNestingAndLargeFiles) {
  EXPECT_EQ(parseMessage(std::string(64, '[') + std::string(64, ']')), "(nothing)");
  for (const int depth : {65, 1000000})
    EXPECT_THAT(parseMessage(std::string(depth, '[') + std::string(depth, ']')),
                HasSubstr("nested deeper than 64 levels"));
  const test::TemporaryFolder folder;
  const auto large = folder.write("large.json", "{}");
  std::filesystem::resize_file(large, kMaxJsonBytes + 1);
  EXPECT_EQ(folder.message([&] { JsonDocument document(large); }),
            "large.json: larger than the limit of 64 MB");
}

TEST(JsonDocument, ReadsAFile) {
  const test::TemporaryFolder folder;
  const JsonDocument document(folder.write("a.json", "\xEF\xBB\xBF{\"x\": 5}"));
  EXPECT_EQ(document.root().at("x").integer(), 5);
}

TEST(JsonDocument, ChecksFormatAndVersion) {
  const auto message = [](const std::string& text) {
    return messageOf(text, [](J json) { json.requireFormat("boresight-pose", 1); });
  };
  const std::string head =
      ": missing: a file of its own begins with \"format\": \"boresight-pose\", \"version\": 1";
  EXPECT_EQ(message(R"({"format": "boresight-pose", "version": 1})"), "(nothing)");
  EXPECT_EQ(message(R"({"version": 1})"), "f.json: format" + head);
  EXPECT_EQ(message(R"({"format": "boresight-pose"})"), "f.json: version" + head);
  EXPECT_EQ(message(R"({"format": "boresight-camera", "version": 1})"),
            "f.json: format: is 'boresight-camera', not 'boresight-pose'");
  EXPECT_EQ(message(R"({"format": "boresight-pose", "version": 2})"),
            "f.json: version: version 2 is not supported (this program reads version 1)");
  EXPECT_EQ(message("[]"), "f.json: not a JSON object");
}

/// Reads an object of a required `seed`, an optional `profile`, and `parts` with a `name` each.
std::string wholeMessage(const std::string& text) {
  return messageOf(text, [](J json) {
    json.whole([](J top) {
      (void)top.at("seed").number();
      (void)top.find("profile");
      if (const auto parts = top.find("parts"))
        for (const JsonReader& part : parts->elements()) (void)part.at("name");
      if (const auto any = top.find("any")) (void)any->members();
      return 0;
    });
  });
}

TEST(JsonReader, RefusesMembersThatTheReaderDoesNotAskFor) {
  EXPECT_EQ(wholeMessage(R"({"seed": 1, "parts": [{"name": 1}], "any": {"x": 1}})"), "(nothing)");
  EXPECT_EQ(wholeMessage(R"({"seed": 1, "zoom": 2})"),
            "f.json: zoom: is not known to this version of the format, which also has: profile, "
            "parts, any");
  EXPECT_THAT(wholeMessage(R"({"seed": 1, "zoom": null})"),
              StartsWith("f.json: zoom: is not known to this version of the format"));
  EXPECT_EQ(wholeMessage(R"({"seed": 1, "parts": [{"name": 1}, {"name": 2, "size": 3}]})"),
            "f.json: parts[1].size: is not known to this version of the format");
}

TEST(JsonReader, NamesMissingAndMistypedMembers) {
  expectMessages(R"({"n": 1, "s": "x", "l": [1, 2], "o": {"z": null}, "e": ""})",
                 {{[](J j) { j.at("q"); }, "q: missing"},
                  {[](J j) { j.at("o").at("z"); }, "o.z: missing"},
                  {[](J j) { j.at("n").at("q"); }, "n: not an object (is a number)"},
                  {[](J j) { j.at("s").number(); }, "s: not a number (is a string)"},
                  {[](J j) { j.at("l").number(); }, "l: not a number (is a list of 2)"},
                  {[](J j) { j.at("n").text(); }, "n: not a string (is a number)"},
                  {[](J j) { j.at("n").boolean(); }, "n: not true or false (is a number)"},
                  {[](J j) { j.at("o").elements(); }, "o: not a list (is an object)"},
                  {[](J j) { j.at("l").vector3(); }, "l: not a list of 3 (is a list of 2)"},
                  {[](J j) { j.at("e").nonEmptyText(); }, "e: is empty"},
                  {[](J j) {
                     j.at("s").choice({"y", "z"});
                   },
                   "s: 'x' is none of 'y', 'z'"}});
}

TEST(JsonReader, ChecksRanges) {
  const std::string text = R"({"a": 5, "b": 5.0, "c": 5.5, "d": -1, "e": 18446744073709551615,
                               "f": 1e300, "v": [1, 2, 3.5]})";
  expectMessages(text, {{[](J j) { j.at("a").integer(6, 9); }, "a: 5 is outside 6 .. 9"},
                        {[](J j) { j.at("c").integer(); }, "c: not an integer (is 5.5)"},
                        {[](J j) { j.at("e").integer(); }, "e: the integer is too large"},
                        {[](J j) { j.at("f").integer(); }, "f: not an integer (is 1e+300)"},
                        {[](J j) { j.at("d").number(0, 0.5); }, "d: -1 is outside 0 .. 0.5"},
                        {[](J j) { j.at("d").numberAbove(-1); }, "d: -1 is not above -1"},
                        {[](J j) { j.at("v").vector3(0, 3); }, "v[2]: 3.5 is outside 0 .. 3"}});
  const JsonDocument document("f.json", text);
  EXPECT_EQ(document.root().at("a").integer(0, 5), 5);
  EXPECT_EQ(document.root().at("b").integer(), 5);
}

TEST(JsonReader, ReadsMatricesRowByRow) {
  const JsonDocument document("f.json", "[[1,2,3,4],[5,6,7,8],[9,10,11,12],[13,14,15,16]]");
  const Eigen::Matrix4d matrix = document.root().matrix<4>();
  EXPECT_EQ(matrix(0, 3), 4.0);
  EXPECT_EQ(matrix(3, 0), 13.0);
  const auto read = [](J j) { j.matrix<4>(); };
  EXPECT_EQ(messageOf("[[1,2,3,4],[5,6,7]]", read), "f.json: not a list of 4 (is a list of 2)");
  EXPECT_EQ(messageOf("[[1,2,3,4],[5,6,7],[1,2,3,4],[1,2,3,4]]", read),
            "f.json: [1]: not a list of 4 (is a list of 3)");
}

TEST(JsonReader, ResolvesPathsAgainstTheFile) {
  const JsonDocument document("/data/set/d.json", R"(["a/b.png", "../c.ply", "/x/y", ""])");
  const auto all = document.root().elements();
  EXPECT_EQ(all[0].path(), "/data/set/a/b.png");
  EXPECT_EQ(all[1].path(), "/data/c.ply");
  EXPECT_EQ(all[2].path(), "/x/y");
  EXPECT_THROW((void)all[3].path(), InputError);
}

TEST(PrettyJson, KeepsEveryBitOfADouble) {
  Random random(1);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::vector<double> values = {0.1, 1.0 / 3.0, 5e-324, std::numeric_limits<double>::max(), -0.0};
  for (int i = 0; i < 2000; ++i)
    values.push_back((random.uniform() - 0.5) * std::pow(10.0, random.uniform(-300.0, 300.0)));
  for (const double value : values) list.push_back(value);
  const JsonDocument document("f.json", prettyJson(list));
  const auto read = document.root().elements();
  ASSERT_EQ(read.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(read[i].number(), values[i]);
    EXPECT_EQ(std::signbit(read[i].number()), std::signbit(values[i]));
  }
}

TEST(PrettyJson, PutsPlainListsOnOneLineAndRefusesNumbersThatAreNotFinite) {
  const auto json = nlohmann::ordered_json::parse(R"({"b":[1,2,3],"a":[[1.5,2],[3,4]],"e":{}})");
  EXPECT_EQ(
      prettyJson(json),
      "{\n  \"b\": [1, 2, 3],\n  \"a\": [\n    [1.5, 2],\n    [3, 4]\n  ],\n  \"e\": {}\n}\n");
  // Numbers that are not finite are refused.
  EXPECT_THROW((void)prettyJson(nlohmann::ordered_json(std::nan(""))), std::logic_error);
  EXPECT_THROW((void)prettyJson(nlohmann::ordered_json::array({1.0, HUGE_VAL})), std::logic_error);
}

}  // namespace
}  // namespace boresight::sessions
