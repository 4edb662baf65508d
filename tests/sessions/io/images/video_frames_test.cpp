// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/images/video_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <opencv2/videoio.hpp>

#include "sessions/io/files/errors.h"
#include "sessions/io/images/pixel_image.h"
#include "tests/sessions/io/folder_test.h"
#include "tests/support/matchers.h"

namespace boresight::sessions {
namespace {

using Video = FolderTest;

/// Five frames of 64 x 48 px, of one colour each, as motion JPEG; false where OpenCV cannot.
bool writeVideo(const std::filesystem::path& file, bool color) {
  cv::VideoWriter writer(file.string(), cv::CAP_OPENCV_MJPEG,
                         cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10.0, cv::Size(64, 48));
  for (int i = 0; i < 5 && writer.isOpened(); ++i)
    writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar(40 * i, 40 * i, color ? 200 : 40 * i)));
  return writer.isOpened();
}

TEST_F(Video, Frames_AreReadInTheirOrder) {
  for (const bool color : {false, true}) {
    const std::filesystem::path file = folder_ / (color ? "color.avi" : "gray.avi");
    ASSERT_TRUE(writeVideo(file, color));
    const auto source = openVideo(file);
    EXPECT_EQ(source->count(), 5);
    for (int i = 0; i < 5; ++i) {
      const auto frame = source->next();
      ASSERT_TRUE(frame && frame->image) << i;
      EXPECT_EQ(frame->name, "frame 00000" + std::to_string(i + 1));
      EXPECT_EQ(std::pair(frame->image->width, frame->image->height), std::pair(64, 48));
      EXPECT_EQ(frame->image->color.empty(), !color);
      const double gray = color ? 0.299 * 200 + 0.701 * 40 * i : 40 * i;
      EXPECT_NEAR(frame->image->pixels[1000], gray, 4.0);
    }
    EXPECT_FALSE(source->next());
  }
}

/// Of a video and of a folder, whatever comes before the frame.
TEST_F(Video, AnyFrame_IsReadByItsNumber) {
  ASSERT_TRUE(writeVideo(folder_ / "gray.avi", false));
  std::filesystem::create_directory(folder_ / "images");
  for (int i = 0; i < 5; ++i)
    writePng(folder_ / ("images/" + std::to_string(i) + ".png"),
             std::vector<std::uint8_t>(64 * 48, static_cast<std::uint8_t>(40 * i)), 64, 48, 1);
  for (const char* images : {"gray.avi", "images"}) {
    const auto frame = readFrame(folder_ / images, 4);
    ASSERT_TRUE(frame && frame->image) << images;
    EXPECT_NEAR(frame->image->pixels[1000], 120, 4) << images;
    EXPECT_FALSE(readFrame(folder_ / images, 6)) << images;
  }
  EXPECT_EQ(readFrame(folder_ / "gray.avi", 4)->name, "frame 000004");
}

TEST_F(Video, FileThatIsNone_IsRefusedWithTheRemedy) {
  const auto file = folder_.write("a.mp4", std::string_view("no video"));
  EXPECT_THAT(folder_.message([&] { (void)openVideo(file); }),
              HasSubstr("cannot read this video; write its frames as PNG images"));
  EXPECT_THAT(folder_.message([&] { (void)openVideo(folder_ / "none.mp4"); }),
              HasSubstr("there is no such file"));
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The number of frames with an image and the notes behind the last one; -1: refused.
std::pair<int, std::vector<std::string>> contentOf(const std::filesystem::path& file) {
  try {
    const auto source = openVideo(file);
    int frames = 0;
    while (const auto frame = source->next()) frames += frame->image ? 1 : 0;
    return {frames, source->notes()};
  } catch (const InputError&) {
    return {-1, {}};
  }
}

/// Frames are never left out in silence.
TEST_F(Video, TruncatedFile_IsRefusedOrNoted) {
  ASSERT_TRUE(writeVideo(folder_ / "whole.avi", true));
  EXPECT_EQ(contentOf(folder_ / "whole.avi"), std::pair(5, std::vector<std::string>()));
  const std::string whole = bytesOf(folder_ / "whole.avi");
  bool noted = false;
  for (std::size_t size = 1; size < whole.size(); size += 1 + whole.size() / 61) {
    const auto [frames, notes] = contentOf(folder_.write("cut.avi", whole.substr(0, size)));
    EXPECT_TRUE(frames == -1 || frames == 5 || !notes.empty()) << size << " of " << whole.size();
    noted = noted || (frames > 0 && !notes.empty());
  }
  EXPECT_TRUE(noted);
}

TEST_F(Video, DamagedFrame_IsNoted) {
  ASSERT_TRUE(writeVideo(folder_ / "whole.avi", true));
  std::string bytes = bytesOf(folder_ / "whole.avi");
  const std::size_t frame = bytes.find("\xFF\xD8", bytes.size() / 2);
  ASSERT_NE(frame, std::string::npos);
  bytes.replace(frame, 600, 600, '\0');
  EXPECT_FALSE(contentOf(folder_.write("damaged.avi", bytes)).second.empty());
}

/// As images are. The matrix of an MP4 file's track states a quarter turn.
TEST_F(Video, RotationTag_IsNotAppliedAndNoted) {
  const auto file = folder_ / "turned.mp4";
  {
    cv::VideoWriter writer(file.string(), cv::CAP_FFMPEG,
                           cv::VideoWriter::fourcc('m', 'p', '4', 'v'), 10.0, cv::Size(64, 48));
    if (!writer.isOpened()) GTEST_SKIP() << "this OpenCV writes no MP4";
    cv::Mat pixels(48, 64, CV_8UC3, cv::Scalar(0, 0, 0));
    pixels.colRange(0, 32).setTo(cv::Scalar(255, 255, 255));
    for (int i = 0; i < 5; ++i) writer.write(pixels);
  }
  std::string bytes = bytesOf(file);
  const std::size_t matrix = bytes.find("tkhd") + 44;
  const std::string quarter("\0\0\0\0\0\1\0\0\0\0\0\0\xFF\xFF\0\0\0\0\0\0", 20);
  bytes.replace(matrix, quarter.size(), quarter);
  folder_.write("turned.mp4", bytes);
  const auto source = openVideo(file);
  const auto frame = source->next();
  ASSERT_TRUE(frame && frame->image);
  EXPECT_EQ(std::pair(frame->image->width, frame->image->height), std::pair(64, 48));
  EXPECT_GT(frame->image->pixels[64 * 24 + 5], 200);
  EXPECT_LT(frame->image->pixels[64 * 24 + 58], 50);
  EXPECT_THAT(source->notes(), ::testing::ElementsAre(HasSubstr("deg, which is not applied")));
}

/// FFmpeg would take what is in front of the colon for a protocol.
TEST_F(Video, NameWithAColonOrInTheWorkingFolder_IsRead) {
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_.path());
  for (const char* name :
       {"take:1.avi", "http:x.avi", "concat:a|b.avi", "caf\xE9.avi", "%03d.avi"}) {
    ASSERT_TRUE(writeVideo("plain.avi", false));
    std::filesystem::rename("plain.avi", name);
    EXPECT_EQ(contentOf(name).first, 5) << name;
  }
  std::filesystem::current_path(before);
}

TEST_F(Video, Names_AreKnownByTheirEnds) {
  for (const char* name : {"approach.MP4", "a/b.avi"}) EXPECT_TRUE(isVideoName(name)) << name;
  for (const char* name : {"images", "images.txt"}) EXPECT_FALSE(isVideoName(name)) << name;
}

TEST_F(Video, PixelImage_IsThatOfAFileWithThesePixels) {
  cv::Mat pixels(5, 7, CV_8UC3);
  cv::randu(pixels, 0, 256);
  writePng(folder_ / "a.png", {pixels.data, pixels.total() * 3}, 7, 5, 3);
  const GrayImage read = readImage(folder_ / "a.png");
  const GrayImage made = grayImageOf("a", pixels);
  EXPECT_EQ(std::tie(made.pixels, made.color, made.pixels_sha256, made.rule),
            std::tie(read.pixels, read.color, read.pixels_sha256, read.rule));
}

}  // namespace
}  // namespace boresight::sessions
