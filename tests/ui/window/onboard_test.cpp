// SPDX-License-Identifier: Apache-2.0
// An onboard record dropped on the window: shown, run again on the ground, compared.

#include "core/base/bytes.h"
#include "core/base/crc32.h"
#include "sessions/record/compare_records.h"
#include "sessions/run/runner.h"
#include "sessions/session/case_run.h"
#include "tests/ui/window_test.h"
#include "ui/widgets/widgets.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

using sessions::RunPart;
using sessions::RunVerdict;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kAltered = 5;  ///< template of the first iteration

/// The image as a compressed downlink brings it.
Bytes compressed(const boresight::ImageView& image, int quality) {
  const QImage whole(image.data, image.width, image.height, static_cast<int>(image.stride),
                     QImage::Format_Grayscale8);
  QBuffer buffer;
  buffer.open(QIODevice::ReadWrite);
  EXPECT_TRUE(whole.save(&buffer, "JPG", quality));
  const QImage read = QImage::fromData(buffer.data()).convertToFormat(QImage::Format_Grayscale8);
  Bytes pixels;
  for (int y = 0; y < read.height(); ++y)
    pixels.insert(pixels.end(), read.constScanLine(y), read.constScanLine(y) + read.width());
  return pixels;
}

/// Moves where a template of the first iteration was found by a pixel, under a right checksum.
void alterTemplate(Bytes& bytes) {
  std::size_t at = 12;
  const auto number = [&](std::size_t place) {
    return ByteReader(std::span(bytes).subspan(place, 4)).u32();
  };
  while (number(at) != static_cast<std::uint32_t>(RecordBlock::kTemplates))
    at += kBlockBytes + number(at + 8);
  const std::size_t length = number(at + 8);
  const std::size_t found = at + kBlockHeadBytes + 8 + kAltered * kTemplateBytes + 5;
  const float x = ByteReader(std::span(bytes).subspan(found, 4)).f32();
  ByteWriter(std::span(bytes).subspan(found, 4)).f32(x + 1.0F);
  const auto block = std::span(bytes).subspan(at, kBlockHeadBytes + length);
  ByteWriter(std::span(bytes).subspan(at + block.size(), 4)).u32(crc32(block));
}

class OnboardTest : public test::WindowTest {
 protected:
  /// What the flight side would send down of the shown case; nullptr: of its image as it is.
  Bytes onboardRecord(const Bytes* pixels = nullptr) {
    Bytes bytes(65536);
    RecordWriter writer(bytes);
    sessions::RunSettings settings;
    settings.level = sessions::RecordLevel::kSummary;
    settings.onboard_record = &writer;
    LocalizationProblem problem = window_.state().currentCase()->problem();
    if (pixels) {
      problem.image.data = pixels->data();
      problem.image.stride = problem.image.width;
    }
    (void)sessions::localize(problem, sessions::RunPlan(window_.cases().options()), settings);
    bytes.resize(writer.bytes().size());
    return bytes;
  }

  void drop(const std::filesystem::path& file) {
    WindowTest::drop(file);
    ASSERT_TRUE(rests());
  }
  void drop(const Bytes& record) { drop(folder_.write("run.whsr", record)); }

  void click(const char* name) {
    ASSERT_TRUE(find<QPushButton>(name).isEnabled()) << name;
    window_.workspaces().reveal(QStringLiteral("onboard"));
    QTest::mouseClick(&find<QPushButton>(name), Qt::LeftButton);
    ASSERT_TRUE(rests());
  }

  QString label(const char* name) { return find<QLabel>(name).text(); }
  const sessions::SessionCase& one() {
    return *window_.document().session().findCase(window_.cases().caseId().toStdString());
  }
};

TEST_F(OnboardTest, ADroppedRecordIsShownRunAgainAndFoundEqual) {
  openExample();
  drop(onboardRecord());
  ASSERT_TRUE(one().onboard_record);
  ASSERT_NE(window_.onboard().review(), nullptr) << window_.onboard().problem().toStdString();
  EXPECT_TRUE(test::has(label("recordSheet"), "converged"));
  EXPECT_TRUE(test::has(label("verdict"), "no run on the ground"));

  click("showOnboard");
  ASSERT_TRUE(window_.state().snapshot() && window_.state().snapshot()->replayed);
  EXPECT_TRUE(find<Banner>("runStatus").text().startsWith(QStringLiteral("Onboard record")));
  EXPECT_TRUE(test::has(find<Banner>("shownRun").text(), "ONBOARD"));
  EXPECT_FALSE(window_.state().snapshot()->iterations.front()->templates.empty());
  EXPECT_TRUE(window_.document().session().runs.empty()) << "a replay is no run";

  click("rerunOnGround");
  ASSERT_TRUE(wait([&] { return window_.document().session().runs.size() == 1 && resting(); }));
  EXPECT_FALSE(window_.state().snapshot()->replayed);
  ASSERT_NE(window_.onboard().comparison(), nullptr);
  EXPECT_EQ(window_.onboard().comparison()->verdict, RunVerdict::kEqual);
  EXPECT_TRUE(test::has(label("verdict"), "bit for bit"));
  EXPECT_EQ(window_.document().session().runs.front().digest,
            window_.onboard().review()->record.end->digest);

  for (const bool replayed : {true, false}) {
    QTest::keyClick(&window_, Qt::Key_B, Qt::ControlModifier);
    EXPECT_EQ(window_.state().snapshot()->replayed, replayed);
  }
  QTest::keyClick(&window_, Qt::Key_B, Qt::ControlModifier);
  QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
  ASSERT_TRUE(rests());
  EXPECT_FALSE(one().onboard_record);
  EXPECT_EQ(window_.onboard().review(), nullptr);
  EXPECT_FALSE(window_.state().snapshot()->replayed) << "a removed record is not shown";
}

TEST_F(OnboardTest, WideWindowShowsBothRunsSideBySide) {
  openRun();
  window_.resize(1920, 1080);
  drop(onboardRecord());
  window_.workspaces().show(Workspace::kOnboard);
  ASSERT_TRUE(rests());
  auto& canvas = find<QWidget>("compareView");
  EXPECT_TRUE(canvas.isVisible());
  EXPECT_EQ(find<QComboBox>("compareWith").currentText(), QStringLiteral("Onboard run"));
  const QWidget* frame = canvas.parentWidget()->parentWidget();
  EXPECT_EQ(frame->property("source").toString(), QStringLiteral("onboard"));
  for (const Workspace workspace : {Workspace::kReview, Workspace::kOnboard}) {
    window_.workspaces().show(workspace);
    EXPECT_EQ(canvas.isVisible(), workspace == Workspace::kOnboard);
  }
  window_.resize(1280, 800);
  EXPECT_TRUE(wait([&] { return !canvas.isVisible(); }))
      << "there the two are blinked; " << window_.width() << " px wide";
}

TEST_F(OnboardTest, AnAlteredTemplateIsFoundAndGoneTo) {
  openRun();
  Bytes bytes = onboardRecord();
  alterTemplate(bytes);
  drop(bytes);
  ASSERT_NE(window_.onboard().comparison(), nullptr);
  const auto& found = *window_.onboard().comparison();
  EXPECT_EQ(found.verdict, RunVerdict::kDifferent);
  ASSERT_TRUE(found.first);
  EXPECT_EQ(found.first->part, RunPart::kMatches);
  EXPECT_EQ(found.first->template_index, static_cast<int>(kAltered));
  EXPECT_TRUE(test::has(label("firstDifference"), "template 6 has different matches"));
  QTest::keyClick(&window_, Qt::Key_B, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_EQ(window_.state().cursor().iteration, 0);
  EXPECT_EQ(window_.state().selectedTemplate(), static_cast<int>(kAltered));
}

TEST_F(OnboardTest, ACompressedImageIsHeldToTheLimits) {
  openRun();
  const Bytes pixels = compressed(window_.state().currentCase()->problem().image, 90);
  drop(onboardRecord(&pixels));
  ASSERT_NE(window_.onboard().comparison(), nullptr);
  const auto& found = *window_.onboard().comparison();
  EXPECT_EQ(found.verdict, RunVerdict::kWithinLimits) << sessions::comparisonText(found);
  EXPECT_EQ(found.first->part, RunPart::kPixels);
  EXPECT_TRUE(test::has(label("verdict"), "Within the limits"));
  EXPECT_TRUE(test::has(label("recordRemarks"), "pixels differ from this case"));
  const auto& table = find<QTableWidget>("comparison");
  ASSERT_EQ(table.rowCount(), static_cast<int>(found.iterations.size()) + 1);
  EXPECT_TRUE(test::has(table.item(0, 1)->text(), " of "));
  EXPECT_TRUE(test::has(table.item(table.rowCount() - 1, 1)->text(), "sigmas"));
}

TEST_F(OnboardTest, UnreadableRecord_IsReported) {
  openExample();
  drop(folder_.write("not.whsr", "something else"));
  EXPECT_TRUE(test::has(window_.lastMessage(), "is not an onboard record"));
  EXPECT_FALSE(one().onboard_record);
  const Bytes bytes = onboardRecord();
  drop(bytes);
  ASSERT_NE(window_.onboard().review(), nullptr);
  click("showOnboard");
  // A record that was cut is shown as far as it goes.
  Bytes cut = bytes;
  cut.resize(bytes.size() / 2);
  drop(folder_.write("cut.whsr", cut));
  ASSERT_NE(window_.onboard().review(), nullptr);
  EXPECT_FALSE(window_.onboard().review()->record.whole());
  EXPECT_TRUE(test::has(label("recordRemarks"), "is incomplete"));
  // One that is another than it was attached as is not shown.
  folder_.write("cut.whsr", bytes);
  window_.document().save();
  ASSERT_TRUE(window_.openSession(folder_.path() / "one.boresight.json"));
  ASSERT_TRUE(wait([&] { return !window_.onboard().problem().isEmpty(); }));
  EXPECT_EQ(window_.onboard().review(), nullptr);
  EXPECT_TRUE(test::has(label("recordSheet"), "differs from the attached record"));
}

}  // namespace
}  // namespace boresight::ui
