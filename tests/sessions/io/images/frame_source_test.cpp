// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/frame_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "tests/sessions/io/folder_test.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

class FrameSourceTest : public FolderTest {
 protected:
  void image(const std::string& name, std::uint8_t gray = 7) const {
    const std::array<std::uint8_t, 6> pixels = {gray, 1, 2, 3, 4, 5};
    writePng(folder_ / name, pixels, 3, 2, 1);
  }
  std::vector<std::string> namesOf(const std::filesystem::path& path) const {
    const auto source = openImages(path);
    std::vector<std::string> names;
    while (const auto frame = source->next()) names.push_back(frame->name);
    EXPECT_EQ(source->count(), static_cast<std::int64_t>(names.size()));
    return names;
  }
  std::string refusal(const std::string& name) const {
    return folder_.message([&] { (void)openImages(folder_ / name); });
  }
};

TEST_F(FrameSourceTest, Folder_GivesItsImagesByNumber) {
  for (const char* name : {"a/10.png", "a/9.png", "a/009b.png", "a/x.PNG"}) {
    folder_.write(name, std::string_view(""));
    image(name);
  }
  folder_.write("a/camera.json", std::string_view("{}"));
  EXPECT_THAT(namesOf(folder_ / "a"), ElementsAre("9.png", "009b.png", "10.png", "x.PNG"));
}

TEST_F(FrameSourceTest, List_GivesItsImagesInOrderRelativeToIt) {
  image("2.png", 2);
  folder_.write("sub/1.png", std::string_view(""));
  image("sub/1.png", 1);
  const auto list =
      folder_.write("list.txt", std::string_view("\xEF\xBB\xBF# order\n2.png\r\n\nsub/1.png"));
  EXPECT_THAT(namesOf(list), ElementsAre("2.png", "sub/1.png"));
  folder_.write("list.txt", std::string_view("# order\r2.png\rsub/1.png\r\x1a"));
  EXPECT_THAT(namesOf(list), ElementsAre("2.png", "sub/1.png"));
  const auto source = openImages(list);
  EXPECT_EQ(source->next()->image->pixels.front(), 2);
}

TEST_F(FrameSourceTest, UnreadableImage_IsAFrameWithItsProblem) {
  image("1.png");
  folder_.write("2.png", std::string_view("no image"));
  image("3.png");
  folder_.write("list.txt", std::string_view("1.png\n2.png\nmissing.png\n3.png\n"));
  const auto source = openImages(folder_ / "list.txt");
  EXPECT_TRUE(source->next()->image);
  for (const char* name : {"2.png", "missing.png"}) {
    const auto frame = source->next();
    EXPECT_FALSE(frame->image);
    EXPECT_EQ(frame->name, name);
    EXPECT_THAT(frame->problem, HasSubstr(name));
  }
  EXPECT_EQ(source->next()->problem, "");
  EXPECT_FALSE(source->next());
}

/// macOS writes them to sticks with file systems of other computers.
TEST_F(FrameSourceTest, HiddenFilesOfAFolder_AreLeftOut) {
  std::filesystem::create_directory(folder_ / "stick");
  for (const char* name : {"stick/1.png", "stick/._1.png", "stick/.2.png"})
    folder_.write(name, std::string_view("x"));
  EXPECT_THAT(namesOf(folder_ / "stick"), ElementsAre("1.png"));
}

TEST_F(FrameSourceTest, NothingToRead_IsRefusedWithTheReason) {
  std::filesystem::create_directory(folder_ / "empty");
  folder_.write("empty.txt", std::string_view("# nothing\n"));
  folder_.write("twice.txt", std::string_view("1.png\n./1.png\n"));
  folder_.write("binary.txt", std::string_view("\0\1", 2));
  EXPECT_THAT(refusal("none"), HasSubstr("there is no such folder or file"));
  EXPECT_THAT(refusal("empty"), HasSubstr("has no image"));
  EXPECT_THAT(refusal("empty.txt"), HasSubstr("lists no image"));
  EXPECT_THAT(refusal("twice.txt"), HasSubstr("line 2: ./1.png is listed twice"));
  EXPECT_THAT(refusal("binary.txt"), HasSubstr("is not a list of images"));
}

}  // namespace
}  // namespace boresight::sessions
