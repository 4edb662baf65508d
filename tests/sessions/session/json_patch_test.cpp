// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/json_patch.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "sessions/session/session_json.h"
#include "tests/sessions/session/random_session.h"

namespace boresight::test {
namespace {

using nlohmann::json;

TEST(JsonPatch, TurnsOneSessionIntoAnother) {
  Random random = randomFor("JsonPatch");
  for (int i = 0; i < 200; ++i) {
    const sessions::Session before = randomSession(random);
    const sessions::Session after =
        coin(random) ? randomEdit(random, before) : randomSession(random);
    json value = json::parse(sessions::sessionText(before, "/data/s.json"));
    const json wanted = json::parse(sessions::sessionText(after, "/data/s.json"));
    const json patch = sessions::jsonPatch(value, wanted);
    ASSERT_TRUE(sessions::applyJsonPatch(json::parse(patch.dump()), value)) << patch.dump();
    ASSERT_EQ(value.dump(), wanted.dump()) << patch.dump();
  }
}

TEST(JsonPatch, SeesWhatOnlyTheTextTells) {
  for (const auto& [a, b] :
       {std::pair("0.0", "-0.0"), std::pair("1", "1.0"), std::pair("[1, 2]", "[1.0, 2]"),
        std::pair("{\"a\": 0.0}", "{\"a\": -0.0}"), std::pair("null", "{}"),
        std::pair("[]", "{}")}) {
    json value = json::parse(a);
    const json wanted = json::parse(b);
    const json patch = sessions::jsonPatch(value, wanted);
    EXPECT_FALSE(patch.empty()) << a << " and " << b;
    ASSERT_TRUE(sessions::applyJsonPatch(patch, value));
    EXPECT_EQ(value.dump(), wanted.dump());
  }
}

TEST(JsonPatch, IsSmallForAnInsertedElement) {
  json before = json::array();
  for (int i = 0; i < 100; ++i) before.push_back({{"id", i}});
  json after = before;
  after.insert(after.begin() + 3, json{{"id", "new"}});
  EXPECT_EQ(sessions::jsonPatch(before, after).dump(), R"([["splice",[],3,0,[{"id":"new"}]]])");
  EXPECT_EQ(sessions::jsonPatch(after, before).dump(), R"([["splice",[],3,1,[]]])");
  EXPECT_EQ(sessions::jsonPatch(before, before).dump(), "[]");
}

TEST(JsonPatch, RefusesWhatDoesNotFit) {
  for (const char* patch : {"1",
                            "[1]",
                            "[[]]",
                            R"([["set"]])",
                            R"([["set", []]])",
                            R"([["set", ["a", "b"], 1]])",
                            R"([["set", [0], 1]])",
                            R"([["set", ["list", 3], 1]])",
                            R"([["set", ["list", -1], 1]])",
                            R"([["set", ["list", "a"], 1]])",
                            R"([["remove", []]])",
                            R"([["remove", ["b"]]])",
                            R"([["remove", ["list", 0]]])",
                            R"([["splice", ["list"], 2, 2, []]])",
                            R"([["splice", ["list"], 4, 0, []]])",
                            R"([["splice", ["list"], 0, 1, 5]])",
                            R"([["splice", ["list"], 0, 18446744073709551615, []]])",
                            R"([["splice", [], 0, 0, []]])",
                            R"([["turn", ["list"]]])",
                            R"([[5, []]])",
                            R"([["set", 5, 5]])"}) {
    json value = json::parse(R"({"a": 1, "list": [1, 2, 3]})");
    EXPECT_FALSE(sessions::applyJsonPatch(json::parse(patch), value)) << patch;
  }
}

}  // namespace
}  // namespace boresight::test
