// SPDX-License-Identifier: Apache-2.0
// What a matcher may do wrong costs one sentence.
#include "sessions/baselines/matcher_client.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

std::string matcherCommand(const std::string& what) {
  return std::string("'") + BORESIGHT_TEST_MATCHER + "' " + what;
}

struct Gray {
  std::vector<std::uint8_t> pixels;
  ImageView view;
  Gray(int width, int height, std::uint8_t value)
      : pixels(static_cast<std::size_t>(width * height), value),
        view{pixels.data(), width, height, width} {}
};

/// The sentence that a matcher is refused with; empty when it is not.
std::string sentenceOf(const std::string& command, double timeout_s = 20.0,
                       const std::stop_token& stop = {}) {
  const Gray first(64, 48, 100), second(80, 60, 50);
  try {
    MatcherClient client(command, timeout_s, stop);
    client.match(first.view, second.view, 10, timeout_s, stop);
  } catch (const MethodError& error) {
    EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
    return error.what();
  }
  return "";
}

TEST(MatcherClient, GivesWhatTheMatcherFoundInSmallAndLargeImages) {
  const Gray first(64, 48, 100), second(80, 60, 50);
  MatcherClient client(matcherCommand("shift 3 -2"), 20.0, {});
  EXPECT_EQ(client.name(), "test");
  EXPECT_EQ(client.width(), 160);
  EXPECT_EQ(client.height(), 120);
  for (int request = 0; request < 3; ++request) {
    const std::vector<PixelPair> pairs = client.match(first.view, second.view, 100, 20.0, {});
    ASSERT_EQ(pairs.size(), 12u) << "4 x 3 places, 16 px apart";
    for (const PixelPair& pair : pairs) {
      EXPECT_EQ(pair.second_x - pair.first_x, 3.0);
      EXPECT_EQ(pair.second_y - pair.first_y, -2.0);
      EXPECT_EQ(pair.score, 0.5);
    }
  }
  EXPECT_EQ(client.match(first.view, second.view, 5, 20.0, {}).size(), 5u);
  const Gray large(2048, 2048, 1), other(2048, 2048, 2);
  EXPECT_EQ(client.match(large.view, other.view, 100000, 60.0, {}).size(), 128u * 128u);
}

TEST(MatcherClient, TellsHowItDied) {
  EXPECT_THAT(sentenceOf(matcherCommand("die")),
              AllOf(HasSubstr("ended with status 3"), HasSubstr("out of paper"),
                    Not(HasSubstr("first line"))));
  EXPECT_THAT(sentenceOf(matcherCommand("crash")), HasSubstr("died of signal 6"));
  EXPECT_THAT(sentenceOf("/nowhere/matcher"), HasSubstr("ended with status 127"));
  EXPECT_THAT(sentenceOf("true"), HasSubstr("ended with status 0"));
}

TEST(MatcherClient, DoesNotWaitForOneThatHangs) {
  for (const char* what : {"hang", "mute", "half"})
    EXPECT_THAT(sentenceOf(matcherCommand(what), 0.5), HasSubstr("did not answer in time")) << what;
}

TEST(MatcherClient, DoesNotWaitForOneThatTakesNoInput) {
  const Gray large(2048, 2048, 1);
  MatcherClient client("echo '{\"protocol\": \"boresight-matcher\", \"version\": 1}'; sleep 60",
                       20.0, {});
  EXPECT_EQ(client.width(), 0);
  try {
    client.match(large.view, large.view, 10, 0.5, {});
    FAIL() << "more than a pipe holds";
  } catch (const MethodError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did not take its input in time"));
  }
}

TEST(MatcherClient, NoticesAStop) {
  std::stop_source source;
  std::jthread stopper([&source] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    source.request_stop();
  });
  EXPECT_THAT(sentenceOf(matcherCommand("hang"), 600.0, source.get_token()),
              HasSubstr("was stopped"));
}

TEST(MatcherClient, RefusesNonsense) {
  for (const char* what : {"babble", "other", "many", "nan", "outside"})
    EXPECT_THAT(sentenceOf(matcherCommand(what)), HasSubstr("answered nonsense")) << what;
  EXPECT_THAT(sentenceOf(matcherCommand("endless")), HasSubstr("a line of more than 65536 bytes"));
  EXPECT_THAT(sentenceOf(matcherCommand("stranger")),
              AllOf(HasSubstr("does not speak the protocol"), HasSubstr("Welcome")));
  EXPECT_THAT(sentenceOf(matcherCommand("future")), HasSubstr("another version"));
  EXPECT_THAT(sentenceOf(matcherCommand("refuse")), HasSubstr("could not match: too dark"));
}

}  // namespace
}  // namespace boresight::sessions
