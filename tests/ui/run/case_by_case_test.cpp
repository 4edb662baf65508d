// SPDX-License-Identifier: Apache-2.0
#include "ui/run/case_by_case.h"

#include <gtest/gtest.h>

#include <QtTest/QTest>

#include <atomic>
#include <stdexcept>
#include <string>

#include "tests/ui/patience.h"

namespace boresight::ui {
namespace {

using test::kPatienceMs;

sessions::SessionCase caseNamed(const std::string& id) {
  sessions::SessionCase session_case;
  session_case.id = id;
  return session_case;
}

/// Names of stations as values of 3,000 cases, and how often they were made.
class CaseByCaseTest : public testing::Test {
 protected:
  static constexpr int kCases = 3000;

  CaseByCaseTest() {
    for (int i = 0; i < kCases; ++i)
      session_.cases.push_back(caseNamed("case-" + std::to_string(i)));
  }
  static std::string stationOf(const sessions::Session& session, const std::string& id) {
    return session.findCase(id)->station;
  }
  CaseWork<std::string> work() {
    return {.listed = {},
            .first = [](const sessions::Session&, const std::string&) { return std::string("?"); },
            .glance =
                [this](const sessions::Session& session, const std::string& id, std::string) {
                  ++glances_;
                  return std::pair(stationOf(session, id) + " at a glance", false);
                },
            .make =
                [this](const sessions::Session& session, const std::string& id, std::string) {
                  ++made_;
                  if (id == "case-7") throw std::runtime_error("no luck");
                  return stationOf(session, id);
                },
            .rank = {}};
  }
  void name(int i, const std::string& station) {
    sessions::SessionCase named = *session_.findCase("case-" + std::to_string(i));
    named.station = station;
    session_ = sessions::withCase(session_, named);
  }
  bool rests() {
    return QTest::qWaitFor([this] { return !values_.isBusy(); }, kPatienceMs);
  }
  void begin() {
    values_.setActive(true);
    values_.follow(session_);
    ASSERT_TRUE(rests());
    glances_ = made_ = lists_ = 0;
    changes_ = 0;
  }

  sessions::Session session_;
  int glances_ = 0;
  std::atomic<int> made_ = 0;
  std::size_t changes_ = 0;
  int lists_ = 0;
  CaseByCase<std::string> values_{work(), [this](const std::vector<std::size_t>* places) {
                                    places ? changes_ += places->size() : ++lists_;
                                  }};
};

TEST_F(CaseByCaseTest, EachValueIsMadeOnce_OneThatThrowsStaysAsItWas) {
  values_.follow(session_);
  EXPECT_EQ(values_.size(), std::size_t{kCases});
  EXPECT_EQ(values_.value(5), "?");
  EXPECT_EQ(glances_, 0) << "not on the window's thread";
  EXPECT_FALSE(values_.isBusy()) << "not active";
  values_.setActive(true);
  ASSERT_TRUE(rests());
  EXPECT_EQ(made_, kCases);
  EXPECT_EQ(values_.value(5), "");
  EXPECT_EQ(values_.value(7), "?");
  EXPECT_EQ(values_.currentCount(), std::size_t{kCases});
}

TEST_F(CaseByCaseTest, EditOfOneCase_MakesItsValueAlone) {
  begin();
  name(4, "Gusev");
  values_.follow(session_);
  EXPECT_EQ(values_.value(4), "Gusev at a glance");
  EXPECT_EQ(values_.currentCount(), std::size_t{kCases - 1});
  ASSERT_TRUE(rests());
  EXPECT_EQ(glances_, 1);
  EXPECT_EQ(made_, 1);
  EXPECT_EQ(changes_, 2u) << "seen, then made";
  EXPECT_EQ(lists_, 0);
  EXPECT_EQ(values_.value(4), "Gusev");
  session_.view.case_id = "case-9";
  values_.follow(session_);
  EXPECT_FALSE(values_.isBusy()) << "nothing of a case has changed";
}

TEST_F(CaseByCaseTest, CasesOfARigDependOnEachOther) {
  for (const char* id : {"case-1", "case-2"}) {
    sessions::SessionCase of_rig = *session_.findCase(id);
    of_rig.rig = sessions::Rig{"rig", Pose()};
    session_ = sessions::withCase(session_, of_rig);
  }
  begin();
  name(1, "Gusev");
  values_.follow(session_);
  ASSERT_TRUE(rests());
  EXPECT_EQ(made_, 2);
}

TEST_F(CaseByCaseTest, ChangeOfAllCases_IsSeenOnTheWorkerAlone) {
  begin();
  session_.robust_annotations = true;
  values_.follow(session_);
  EXPECT_EQ(glances_, 0);
  EXPECT_EQ(values_.currentCount(), 0u);
  ASSERT_TRUE(rests());
  EXPECT_EQ(made_, kCases);
}

TEST_F(CaseByCaseTest, ValueOfACaseThatChangesWhileItIsMade_IsMadeAgain) {
  begin();
  name(4, "Gusev");
  values_.follow(session_);
  name(4, "Jezero");
  values_.follow(session_);
  ASSERT_TRUE(rests());
  EXPECT_EQ(values_.value(4), "Jezero");
  EXPECT_TRUE(values_.isCurrent(4));
}

TEST_F(CaseByCaseTest, TaskOfTheSessionBefore_SetsNoValueOfACaseOfTheSameId) {
  name(4, "Gusev");
  values_.setActive(true);
  values_.follow(session_);
  ASSERT_TRUE(values_.isBusy());
  values_.clear();
  name(4, "Jezero");
  values_.follow(session_);
  ASSERT_TRUE(rests());
  EXPECT_EQ(values_.value(4), "Jezero");
  EXPECT_TRUE(values_.isCurrent(4));
}

TEST_F(CaseByCaseTest, TaskOfARemovedCase_SetsNoValueOfOneThatIsAddedAgain) {
  name(4, "Gusev");
  values_.setActive(true);
  values_.follow(session_);
  ASSERT_TRUE(values_.isBusy());
  values_.follow(sessions::withoutCase(session_, "case-4"));
  name(4, "Jezero");
  values_.follow(session_);
  ASSERT_TRUE(rests());
  EXPECT_EQ(values_.value(4), "Jezero");
}

TEST_F(CaseByCaseTest, AddedAndRemovedCases_LeaveTheOthersAsTheyAre) {
  begin();
  session_ = sessions::withoutCase(session_, "case-0");
  session_ = sessions::withCase(session_, caseNamed("new"));
  values_.follow(session_);
  ASSERT_TRUE(rests());
  EXPECT_EQ(made_, 1);
  EXPECT_EQ(lists_, 1);
  EXPECT_EQ(values_.size(), std::size_t{kCases});
  EXPECT_EQ(values_.placeOf("case-1"), 0u);
  EXPECT_EQ(values_.placeOf("case-0"), values_.size());
  EXPECT_TRUE(values_.isCurrent(values_.placeOf("new")));
}

}  // namespace
}  // namespace boresight::ui
