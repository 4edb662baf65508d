// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <stdexcept>

#include "core/base/random.h"
#include "sessions/session/keyed_list.h"
#include "sessions/session/rig_links.h"
#include "tests/sessions/session/example_session.h"
#include "tests/sessions/session/random_session.h"
#include "tests/support/matchers.h"

namespace boresight::test {
namespace {

using sessions::changedCases;
using sessions::Session;

TEST(FreeCaseId, IsTheFirstThatNoCaseHas) {
  Random random = randomFor("FreeCaseId");
  Session session;
  EXPECT_EQ(freeCaseId(session, "a"), "a");
  for (const char* id : {"a", "a-2", "b"}) session = withCase(session, randomCase(random, id));
  EXPECT_EQ(freeCaseId(session, "a"), "a-3");
  EXPECT_EQ(freeCaseId(session, "b"), "b-2");
  EXPECT_EQ(freeCaseId(session, "c"), "c");
}

TEST(ChangedCases, ListsEditedCases) {
  Random random = randomFor("ChangedCases");
  Session before;
  for (const char* id : {"a", "b", "c"}) before = withCase(before, randomCase(random, id));
  before = withAnnotations(before, "b", randomAnnotations(random));
  EXPECT_THAT(changedCases(before, before), IsEmpty());

  sessions::SessionCase moved = *before.findCase("c");
  moved.camera_from_station_seed.translation_m.x() += 0.01;
  EXPECT_THAT(changedCases(before, withCase(before, moved)), ElementsAre("c"));
  EXPECT_THAT(changedCases(before, withAnnotations(before, "b", {})), ElementsAre("b"));
  EXPECT_THAT(changedCases(before, withAnnotations(before, "a", randomAnnotations(random))),
              ElementsAre("a"));
  EXPECT_THAT(changedCases(before, withCase(before, randomCase(random, "d"))), ElementsAre("d"));
  EXPECT_THAT(changedCases(before, withoutCase(before, "a")), IsEmpty());

  Session after = before;
  after.view.case_id = "b";
  EXPECT_THAT(changedCases(before, after), IsEmpty());
  after.decisions.push_back({"a", sessions::Verdict::kValidated, "Ada", "", "", ""});
  EXPECT_THAT(changedCases(before, after), ElementsAre("a"));
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
/// Every third number is in no group; the others are in that of their key.
struct GroupOfEntry {
  const std::string* operator()(const Entry& entry) const {
    return entry.number % 3 == 0 ? nullptr : &entry.key;
  }
};
using List = sessions::KeyedList<Entry, KeyOfEntry, GroupOfEntry>;

TEST(SameScene, FramesAndStatesOfPartsMakeAnother) {
  Random random = randomFor("SameScene");
  const sessions::SessionCase session_case = randomCase(random, "a");
  sessions::SessionCase other = session_case;
  other.camera_from_station_seed.translation_m.x() += 0.01;
  EXPECT_TRUE(sameScene(session_case, other)) << "the seed is no part of the scene";
  other = session_case;
  other.frames.emplace_back();  // may place a part elsewhere
  EXPECT_FALSE(sameScene(session_case, other));
  EXPECT_TRUE(sameMeshes(session_case, other));
  other = session_case;
  other.parts[0].source.state.present = !other.parts[0].source.state.present;
  EXPECT_FALSE(sameScene(session_case, other));
  EXPECT_TRUE(sameMeshes(session_case, other)) << "in another state";
}

/// What a list should be.
struct PlainList {
  std::vector<Entry> entries;

  const Entry* find(const std::string& key) const {
    const auto found = std::find_if(entries.rbegin(), entries.rend(),
                                    [&key](const Entry& entry) { return entry.key == key; });
    return found == entries.rend() ? nullptr : &*found;
  }
  std::ptrdiff_t count(const std::string& key) const {
    return std::ranges::count(entries, key, &Entry::key);
  }
};

/// A random change of both.
void change(Random& random, List& list, PlainList& plain) {
  const Entry entry{"k" + std::to_string(random.below(40)), static_cast<int>(random.below(1000))};
  const auto odd = [](const Entry& other) { return other.number % 2 == 1; };
  const auto any = [&] { return indexBelow(random, plain.entries.size()); };
  const auto at = [&plain](std::size_t i) {
    return plain.entries.begin() + static_cast<std::ptrdiff_t>(i);
  };
  const std::uint32_t kind = plain.entries.empty() ? 9 : random.below(12);
  if (kind == 0) {
    const std::size_t i = any();
    list.replace(i, entry);
    plain.entries[i] = entry;
  } else if (kind == 1) {
    const std::size_t i = any();
    list.erase(i);
    plain.entries.erase(at(i));
  } else if (kind == 2) {
    const std::size_t i = any();
    list.insert(i, entry);
    plain.entries.insert(at(i), entry);
  } else if (kind == 3) {
    list.put(entry);
    if (const Entry* found = plain.find(entry.key))
      plain.entries[static_cast<std::size_t>(found - plain.entries.data())] = entry;
    else
      plain.entries.push_back(entry);
  } else if (kind == 4) {
    list.eraseIf(entry.key, odd);
    std::erase_if(plain.entries,
                  [&](const Entry& other) { return other.key == entry.key && odd(other); });
  } else if (kind == 5) {
    const auto chosen = [&](const Entry& other) { return other.number == entry.number; };
    list.eraseIf(chosen);
    std::erase_if(plain.entries, chosen);
  } else if (kind == 6) {
    const std::size_t i = any();
    list[i] = plain.entries[i] = entry;
  } else {
    list.push_back(entry);
    plain.entries.push_back(entry);
  }
}

/// The later list, built from the earlier one and their differences.
List rebuilt(const List& before, const List& after) {
  List list = before;
  std::vector<std::size_t> erased;
  List::forEachDifference(
      before, after, [&](std::size_t i, const Entry& entry) { list.replace(i, entry); },
      [&](std::size_t i) { erased.push_back(i); }, [](std::size_t, const Entry&) {});
  std::for_each(erased.rbegin(), erased.rend(), [&](std::size_t i) { list.erase(i); });
  List::forEachDifference(
      before, after, [](std::size_t, const Entry&) {}, [](std::size_t) {},
      [&](std::size_t i, const Entry& entry) { list.insert(i, entry); });
  return list;
}

TEST(KeyedList, EqualsAPlainListAfterRandomChanges) {
  Random random = randomFor("KeyedList");
  List list;
  PlainList plain;
  std::vector<std::pair<List, PlainList>> copies;
  for (int i = 0; i < 6000; ++i) {
    change(random, list, plain);
    if (i % 100 != 0) continue;
    ASSERT_EQ(std::vector<Entry>(std::as_const(list).begin(), std::as_const(list).end()),
              plain.entries);
    for (int key = 0; key < 40; ++key) {
      const std::string text = "k" + std::to_string(key);
      const Entry* expected = plain.find(text);
      const Entry* found = list.find(text);
      ASSERT_EQ(found == nullptr, expected == nullptr) << text;
      if (found != nullptr) {
        ASSERT_EQ(*found, *expected);
      }
      ASSERT_EQ(std::ssize(list.findAll(text)), plain.count(text));
      std::vector<Entry> group, expected_group;
      for (const Entry* entry : list.findGroup(text)) group.push_back(*entry);
      std::ranges::copy_if(plain.entries, std::back_inserter(expected_group),
                           [&](const Entry& entry) {
                             return entry.key == text && GroupOfEntry()(entry) != nullptr;
                           });
      ASSERT_EQ(group, expected_group);
    }
    copies.emplace_back(list, plain);
  }
  for (const auto& [copy, expected] : copies) {
    ASSERT_EQ(std::vector<Entry>(copy.begin(), copy.end()), expected.entries)
        << "later changes of the list do not change copies";
    ASSERT_EQ(rebuilt(copy, list), list);
    ASSERT_EQ(copy == list, expected.entries == plain.entries);
  }
}

TEST(KeyedList, ACopyIsComparedByItsDifferentBlocks) {
  List list;
  for (int i = 0; i < 10000; ++i) list.push_back({"k" + std::to_string(i), i});
  List other = list;
  other.put({"k7000", 1});
  other.push_back({"new", 2});
  int differences = 0;
  const auto count = [&](const auto&...) { ++differences; };
  List::forEachDifference(list, other, count, count, count);
  EXPECT_EQ(differences, 2);
  EXPECT_EQ(&std::as_const(list)[100], &std::as_const(other)[100]) << "they share it";
  EXPECT_EQ(list.find("k7000")->number, 7000);
}

TEST(KeyedList, FindsTheLastElementOfAKeyAlsoWhenElementsWereChangedRemovedOrReplaced) {
  List list;
  EXPECT_EQ(list.find("k1"), nullptr);
  for (int i = 0; i < 25; ++i) list.push_back({"k" + std::to_string(i % 10), i});
  keys_asked = 0;
  ASSERT_NE(list.find("k3"), nullptr);
  EXPECT_EQ(list.find("k3")->number, 23);
  EXPECT_EQ(list.find("k7")->number, 17);
  EXPECT_EQ(list.find("other"), nullptr);
  EXPECT_EQ(keys_asked, 3) << "only the elements found are looked at";

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
  EXPECT_EQ(keys_asked, 2);
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

namespace boresight::sessions {
namespace {

/// A run of every case as it is, without running it.
Session asIfRun(Session session) {
  for (const auto& session_case : session.cases) {
    RunRecord run;
    run.case_id = session_case->id;
    run.inputs_sha256 = inputsDigest(*session_case);
    run.options_sha256 = optionsDigest(caseOptions(session, *session_case, {}));
    session.runs.push_back(run);
  }
  return session;
}

Session withRandomEdit(const Session& session, Random& random) {
  SessionCase session_case = *session.cases[test::indexBelow(random, session.cases.size())];
  LocalizerOptions options = sessionOptions(session, {});
  switch (random.below(5)) {
    case 0:
      session_case.camera_from_station_seed.translation_m.x() += 0.01;
      break;
    case 1:
      session_case.feature_size_m = random.uniform(0.001, 0.004);
      break;
    case 2:
      session_case.tags.push_back("seen");  // no input of a run
      break;
    case 3:
      options.pnp.seed += 1;
      return withOptions(session, session.profile, options);
    default:
      return withOptions(session, session.profile == "paper" ? "default" : "paper", options);
  }
  return withCase(session, session_case);
}

TEST(StaleRuns, SaysAsStalenessWhateverIsEditedAndUndone) {
  Random random(5);
  StaleRuns known;
  std::vector<Session> history = {asIfRun(makeSession(test::exampleFolder() / "dataset.json"))};
  int stale_count = 0, fresh_count = 0;
  for (int edit = 0; edit < 200; ++edit) {
    const double chance = random.uniform();
    if (chance < 0.1)
      history.resize(1);
    else if (chance < 0.5 && history.size() > 1)
      history.pop_back();
    else
      history.push_back(withRandomEdit(history.back(), random));
    const Session& session = history.back();
    for (const auto& session_case : session.cases) {
      const RunRecord& run = *session.lastRunOf(session_case->id);
      const bool stale = stalenessOf(run, session, {}).stale();
      EXPECT_EQ(known.isStale(run, session_case, session, {}), stale) << edit;
      ++(stale ? stale_count : fresh_count);
    }
  }
  EXPECT_GT(stale_count, 50);
  EXPECT_GT(fresh_count, 20);
}

TEST(CurrentRun, IsTheLastOneOfTheInputsThatTheCaseHas) {
  Session session = makeSession(test::exampleFolder() / "dataset.json");
  const std::string id = session.cases.front()->id;
  const auto refusal = [&id](const Session& asked) {
    try {
      (void)currentRunOf(asked, id);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal(session), HasSubstr("it has no run: run it first"));
  session = asIfRun(session);
  EXPECT_EQ(&currentRunOf(session, id), session.lastRunOf(id));
  LocalizerOptions options = sessionOptions(session, {});
  options.pnp.seed += 1;
  EXPECT_EQ(refusal(withOptions(session, session.profile, options)), "") << "the pose stays";
  const std::function<void(SessionCase&)> edits[] = {
      [](auto& item) { item.camera.fx *= 1.01; },
      [](auto& item) { item.camera_from_station_seed.translation_m.x() += 1e-3; },
      [](auto& item) { item.image.color_sha256 = std::string(64, 'a'); }};
  for (const auto& edit : edits)
    EXPECT_THAT(refusal(withChanged(session, id, edit)), HasSubstr("changed since the last run"));
}

/// The end effector is an input of runs that measure their corrections there, and of no others.
TEST(CurrentRun, OfARunThatUsedTheEndEffector_EndsWithAnotherOne) {
  Session session = asIfRun(makeSession(test::exampleFolder() / "dataset.json"));
  const std::string id = session.cases.front()->id;
  const auto withEffector = [&](double z_m) {
    return withChanged(session, id, [z_m](SessionCase& item) {
      item.camera_from_end_effector.emplace().translation_m = {0.0, 0.0, z_m};
    });
  };
  EXPECT_FALSE(inputsChangedSince(*session.lastRunOf(id), withEffector(0.3)));
  for (RunRecord& run : session.runs) run.end_effector_in_camera_m = {0.0, 0.0, 0.3};
  const auto& run = *session.lastRunOf(id);
  StaleRuns known;
  for (const double z_m : {0.3, 0.4}) {
    const Session edited = withEffector(z_m);
    EXPECT_EQ(inputsChangedSince(run, edited), z_m != 0.3);
    EXPECT_EQ(known.isStale(run, edited.cases.front(), edited, {}), z_m != 0.3);
  }
}

Pose somePose(double x_m) {
  Pose pose;
  pose.rotation = Eigen::Quaterniond(0.9, 0.1, -0.2, 0.3).normalized();
  pose.translation_m = {x_m, 0.02, -0.01};
  return pose;
}

Session leftRightTop() {
  Session session;
  SessionCase session_case;
  for (const char* id : {"left", "right", "top"}) {
    session_case.id = id;
    session = withCase(session, session_case);
  }
  return session;
}

Pose between(const Session& session, const char* to, const char* from) {
  return session.findCase(to)->rig->camera_from_rig *
         session.findCase(from)->rig->camera_from_rig.inverse();
}

auto isNear(const Pose& pose) { return test::poseNear(pose, 1e-12, 1e-12); }

TEST(RigLinks, TheCameraThatIsLinkedLiesWhereItWasSaidFromTheOther) {
  Session session = withRigLink(leftRightTop(), "left", "right", somePose(0.1));
  EXPECT_THAT(casesOfRig(session, "left"), ElementsAre("right"));
  EXPECT_THAT(between(session, "right", "left"), isNear(somePose(0.1)));
  // A third one linked to the second is linked to the first as well.
  session = withRigLink(session, "right", "top", somePose(-0.3));
  EXPECT_THAT(casesOfRig(session, "left"), ElementsAre("right", "top"));
  EXPECT_THAT(between(session, "top", "right"), isNear(somePose(-0.3)));
  EXPECT_THAT(between(session, "top", "left"), isNear(somePose(-0.3) * somePose(0.1)));
}

TEST(RigLinks, ALinkThatIsDroppedLeavesTheOthersAndARigOfOneIsNone) {
  Session session = withRigLink(leftRightTop(), "left", "right", somePose(0.1));
  session = withRigLink(session, "left", "top", Pose());
  session = withoutRigLink(session, "left");
  EXPECT_FALSE(session.findCase("left")->rig);
  EXPECT_THAT(casesOfRig(session, "right"), ElementsAre("top"));
  // A new rig does not take the name of another.
  ASSERT_EQ(session.findCase("top")->rig->id, "left");
  SessionCase fourth;
  fourth.id = "fourth";
  EXPECT_THAT(casesOfRig(withRigLink(withCase(session, fourth), "left", "fourth", Pose()), "left"),
              ElementsAre("fourth"));
  session = withoutRigLink(session, "top");
  for (const auto& session_case : session.cases)
    EXPECT_FALSE(session_case->rig) << session_case->id;
  EXPECT_EQ(withoutRigLink(session, "top"), session);
}

TEST(RigLinks, NonsenseIsRefused) {
  Pose broken;
  broken.translation_m.x() = std::numeric_limits<double>::quiet_NaN();
  const Session session = leftRightTop();
  EXPECT_THROW(withRigLink(session, "left", "left", Pose()), std::invalid_argument);
  EXPECT_THROW(withRigLink(session, "left", "none", Pose()), std::invalid_argument);
  EXPECT_THROW(withRigLink(session, "left", "right", broken), std::invalid_argument);
}

}  // namespace
}  // namespace boresight::sessions
