// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "sessions/session/keyed_list.h"
#include "tests/sessions/session/random_session.h"

namespace boresight::test {
namespace {

using sessions::changedCases;
using sessions::Session;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(ChangedCases, NamesThoseThatSomebodyEdited) {
  Random random = randomFor("ChangedCases");
  Session before;
  for (const char* id : {"a", "b", "c"}) before = withCase(before, randomCase(random, id));
  before = withAnnotation(before, "b", randomAnnotation(random));
  EXPECT_THAT(changedCases(before, before), IsEmpty());

  sessions::SessionCase moved = *before.findCase("c");
  moved.camera_from_station_seed.translation_m.x() += 0.01;
  EXPECT_THAT(changedCases(before, withCase(before, moved)), ElementsAre("c"));
  EXPECT_THAT(changedCases(before, withAnnotation(before, "b", {})), ElementsAre("b"));
  EXPECT_THAT(changedCases(before, withAnnotation(before, "a", randomAnnotation(random))),
              ElementsAre("a"));
  EXPECT_THAT(changedCases(before, withCase(before, randomCase(random, "d"))), ElementsAre("d"));
  EXPECT_THAT(changedCases(before, withoutCase(before, "a")), IsEmpty());

  Session decided = before;
  decided.decisions.push_back({"a", sessions::Verdict::kValidated, "Ada", "", "", ""});
  EXPECT_THAT(changedCases(before, decided), ElementsAre("a"));
  Session looked = before;
  looked.view.case_id = "b";
  EXPECT_THAT(changedCases(before, looked), IsEmpty());
}

struct Entry {
  std::string key;
  int number = 0;

  bool operator==(const Entry&) const = default;
};

int keys_asked = 0;
struct KeyOfEntry {
  const std::string& operator()(const Entry& entry) const {
    ++keys_asked;
    return entry.key;
  }
};
using List = sessions::KeyedList<Entry, KeyOfEntry>;

List listOf(int count) {
  List list;
  for (int i = 0; i < count; ++i) list.push_back({"k" + std::to_string(i % 10), i});
  return list;
}

TEST(KeyedList, FindsTheLastElementOfAKey) {
  const List list = listOf(25);
  ASSERT_NE(list.find("k3"), nullptr);
  EXPECT_EQ(list.find("k3")->number, 23);
  EXPECT_EQ(list.find("k7")->number, 17);
  EXPECT_EQ(list.find("other"), nullptr);
  EXPECT_EQ(List().find("k1"), nullptr);
}

TEST(KeyedList, LooksAtNoElementToFindOne) {
  const List list = listOf(1000);
  keys_asked = 0;
  for (int i = 0; i < 1000; ++i) (void)list.find("k" + std::to_string(i));
  EXPECT_EQ(keys_asked, 0);
}

TEST(KeyedList, FindsElementsThatWereChangedRemovedOrReplaced) {
  List list = listOf(25);
  list.back().key = "last";
  EXPECT_EQ(list.find("last")->number, 24);
  EXPECT_EQ(list.find("k4")->number, 14);
  for (Entry& entry : list) entry.number += 100;
  list[0].key = "first";
  list.push_back({"k0", 7});
  EXPECT_EQ(list.find("first")->number, 100);
  EXPECT_EQ(list.find("k0")->number, 7);

  const List copy = list;  // finds them without a search again
  keys_asked = 0;
  EXPECT_EQ(copy.find("last")->number, 124);
  EXPECT_EQ(copy.find("first")->number, 100);
  EXPECT_EQ(keys_asked, 0);
  EXPECT_EQ(copy, list);

  list.eraseIf([](const Entry& entry) { return entry.key == "last" || entry.number == 7; });
  EXPECT_EQ(list.find("last"), nullptr);
  EXPECT_EQ(list.find("k0")->number, 120);
  list = std::vector<Entry>{{"a", 1}, {"a", 2}};
  EXPECT_EQ(list.find("a")->number, 2);
  EXPECT_EQ(list.find("k0"), nullptr);
  list.clear();
  EXPECT_EQ(list.find("a"), nullptr);
}

}  // namespace
}  // namespace boresight::test
