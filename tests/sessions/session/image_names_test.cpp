// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/image_names.h"

#include <gtest/gtest.h>

#include <initializer_list>

#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

Session withImages(std::initializer_list<const char*> files) {
  Session session;
  for (const char* file : files) {
    SessionCase session_case;
    session_case.id = "case " + std::to_string(session.cases.size());
    session_case.image.source.file = file;
    session.cases.push_back(session_case);
  }
  return session;
}

TEST(ImageNames, AreRelativeToTheFolderOfAll) {
  EXPECT_THAT(imageNames({}), IsEmpty());
  EXPECT_THAT(imageNames(withImages({"/data/sol 12/a.png"})), ElementsAre("a.png"));
  EXPECT_THAT(imageNames(withImages({"/data/a/1.png", "/data/a/2.png"})),
              ElementsAre("1.png", "2.png"));
  EXPECT_THAT(imageNames(withImages({"/data/a/b/1.png", "/data/a/1.png", "/data/ab/1.png"})),
              ElementsAre("a/b/1.png", "a/1.png", "ab/1.png"));
  EXPECT_THAT(imageNames(withImages({"/x/1.png", "/y/1.png"})), ElementsAre("x/1.png", "y/1.png"));
}

TEST(ImageNumbers, AreThoseOfTheNamesWhereAllHaveOne) {
  EXPECT_THAT(imageNumbers({}), IsEmpty());
  EXPECT_THAT(imageNumbers(withImages({"/a/000.png", "/a/12.png"})), ElementsAre(0, 12));
  for (const char* other : {"/b/12.png", "/b/-3.png", "/b/x.png", "/b/99999999999.png"})
    EXPECT_THAT(imageNumbers(withImages({"/a/7.png", "/a/12.png", other})), ElementsAre(1, 2, 3))
        << other;
}

TEST(StationNumbers, CountDifferentMeshes) {
  Session session = withImages({"/1.png", "/2.png", "/3.png", "/4.png"});
  const char* const meshes[] = {"a", "b", "a", "c"};
  for (std::size_t i = 0; i < 4; ++i) {
    SessionCase session_case = *session.cases[i];
    session_case.parts.resize(1);
    session_case.parts[0].sha256 = meshes[i];
    session = withCase(session, session_case);
  }
  EXPECT_THAT(stationNumbers(session), ElementsAre(1, 2, 1, 3));
  EXPECT_THAT(stationNumbers({}), IsEmpty());
}

TEST(IsEndOf, ComparesWholeNames) {
  for (const char* end : {"7.png", "b/7.png", "./b/7.png", "/data/b/7.png"})
    EXPECT_TRUE(isEndOf(end, "/data/b/7.png")) << end;
  for (const char* end : {"", "png", "17.png", "a/7.png", "b", "/more/data/b/7.png"})
    EXPECT_FALSE(isEndOf(end, "/data/b/7.png")) << end;
}

}  // namespace
}  // namespace boresight::sessions
