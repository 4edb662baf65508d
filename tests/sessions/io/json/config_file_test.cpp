// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/json/config_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/sessions/io/folder_test.h"

namespace boresight::sessions {
namespace {

enum class Colour : std::int32_t { kRed = 0, kGreen = 1, kBlue = 2 };
constexpr const char* kColourNames[] = {"red", "green", "blue"};

/// One field of each kind that an options struct may have.
struct SampleOptions {
  bool enabled = true;
  std::int32_t count = 10;
  std::int64_t seed = 1;
  double sigma_px = 1.5;
  Colour colour = Colour::kGreen;

  bool operator==(const SampleOptions&) const = default;

  template <class Self, class Visitor>
  static void visitFields(Self& self, Visitor&& visit) {
    visit(OptionInfo{"sample.enabled", "", 0, 1, "Whether."}, self.enabled);
    visit(OptionInfo{"sample.count", "", 1, 50, "How many."}, self.count);
    visit(OptionInfo{"sample.seed", "", 0, 9.3e18, "Of the generator."}, self.seed);
    visit(OptionInfo{"sample.sigma_px", "px", 0.0, 8.0, "Smoothing."}, self.sigma_px);
    visit(OptionInfo{"sample.colour", "", 0, 2, "Which.", kColourNames}, self.colour);
  }
};

class ConfigFile : public FolderTest {
 protected:
  Config read(const std::string& rest) {
    return readConfig(folder_.write("config.json",
                                    R"({"format": "boresight-config", "version": 1)" + rest + "}"));
  }
  std::string error(const std::string& options) {
    return folder_.message([&] {
      SampleOptions sample;
      applyConfig(sample, read(R"(, "options": )" + options));
    });
  }
};

TEST_F(ConfigFile, SetsOptionsOfEveryKindAndMayBeEmpty) {
  const Config config = read(R"(, "profile": "paper", "options": {"sample.enabled": false,
      "sample.count": 20, "sample.seed": 9007199254740993, "sample.sigma_px": 2,
      "sample.colour": "blue"})");
  EXPECT_EQ(config.profile, "paper");
  SampleOptions options;
  applyConfig(options, config);
  EXPECT_EQ(options, (SampleOptions{false, 20, 9007199254740993, 2.0, Colour::kBlue}));
  EXPECT_EQ(read("").profile, "default");
  EXPECT_TRUE(read("").options.empty());
}

TEST_F(ConfigFile, NamesTheOptionItsRangeAndItsUnit) {
  for (const auto& [option, value, refusal] : std::vector<std::array<std::string, 3>>{
           {"sigma_px", "9", "9 px is outside 0 .. 8 px"},
           {"sigma_px", "\"wide\"", "'wide' is not a number in 0 .. 8 px"},
           {"sigma_px", "true", "true is not a number in 0 .. 8 px"},
           {"count", "0", "0 is outside 1 .. 50"},
           {"count", "2.5", "2.5 is not an integer in 1 .. 50"},
           {"count", "[1]", "not a number, true, false, or a name"},
           {"enabled", "1", "1 is not true or false"},
           {"colour", "\"pink\"", "'pink' is not one of red, green, blue"},
           {"colour", "1", "1 is not one of red, green, blue"},
           {"tint", "1", "unknown option"}})
    EXPECT_EQ(error("{\"sample." + option + "\": " + value + "}"),
              "config.json: options.sample." + option + ": " + refusal);
  EXPECT_EQ(error(R"({"sample.count": 3.0})"), "(nothing)");
}

TEST_F(ConfigFile, LeavesTheOptionsAloneWhenOneIsWrong) {
  SampleOptions options;
  EXPECT_THROW(
      applyConfig(options, read(R"(, "options": {"sample.count": 20, "sample.sigma_px": 9})")),
      InputError);
  EXPECT_EQ(options, SampleOptions());
}

TEST_F(ConfigFile, ReadsBackWhatDiffers) {
  const SampleOptions options{true, 10, INT64_MAX, 0.1, Colour::kRed};
  const std::string changed = toJson(changedOptions(options, SampleOptions())).dump();
  EXPECT_EQ(changed,
            R"({"sample.seed":9223372036854775807,"sample.sigma_px":0.1,"sample.colour":"red"})");
  SampleOptions back;
  applyConfig(back, read(", \"options\": " + changed));
  EXPECT_EQ(back, options);
  EXPECT_TRUE(changedOptions(SampleOptions(), SampleOptions()).empty());
}

TEST(OptionValues, CanBeListed) {
  const auto all = listOptions(SampleOptions());
  ASSERT_EQ(all.size(), 5u);
  EXPECT_EQ(all[0].kind, OptionKind::kBoolean);
  EXPECT_EQ(all[1].kind, OptionKind::kInteger);
  EXPECT_EQ(all[3].unit, "px");
  EXPECT_EQ(valueText(all[3], all[3].value), "1.5 px");
  EXPECT_EQ(all[4].kind, OptionKind::kChoice);
  EXPECT_EQ(valueText(all[4], all[4].value), "green");
}

TEST(OptionValues, CanBeGivenAsText) {
  SampleOptions options;
  for (const auto& [name, text] :
       {std::pair("enabled", "false"), {"count", "20"}, {"sigma_px", "2.5e-1"}, {"colour", "blue"}})
    applyOptionText(options, std::string("sample.") + name, text);
  EXPECT_EQ(options, (SampleOptions{false, 20, 1, 0.25, Colour::kBlue}));
  for (const auto& [name, text, refusal] : std::vector<std::array<std::string, 3>>{
           {"sample.count", "many", "'many' is not an integer in 1 .. 50"},
           {"sample.count", "51", "51 is outside 1 .. 50"},
           {"sample.count", "", "'' is not an integer in 1 .. 50"},
           {"sample.sigma_px", "nan", "'nan' is not a number in 0 .. 8 px"},
           {"sample.sigma_px", "1px", "'1px' is not a number in 0 .. 8 px"},
           {"sample.enabled", "yes", "'yes' is not true or false"},
           {"none", "1", "unknown option"}}) {
    const auto apply = [&, name = name, text = text] { applyOptionText(options, name, text); };
    EXPECT_THAT(apply, testing::ThrowsMessage<OptionError>(name + ": " + refusal));
  }
}

}  // namespace
}  // namespace boresight::sessions
