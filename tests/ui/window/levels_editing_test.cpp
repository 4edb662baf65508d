// SPDX-License-Identifier: Apache-2.0
// An image of 12 bits in a file of 16: how it is shown, and what the core is given.
#include <algorithm>

#include "sessions/session/case_run.h"
#include "tests/support/vicar_image.h"
#include "tests/ui/window_test.h"
#include "ui/views/display_image.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"

namespace boresight::ui {
namespace {

constexpr int kFactor = 16;  ///< from the example's 8 bits to 12

class LevelsEditingTest : public test::WindowTest {
 protected:
  void SetUp() override {
    sessions::CaseFiles files;
    const auto station = test::exampleFolder() / "os";
    files.id = "os";
    files.image = deepImage();
    files.camera = station / "camera.json";
    files.parts.emplace_back().mesh = station / "model.ply";
    files.parts.front().mesh_unit = "m";
    files.seed = station / "seed.json";
    open(test::withoutSearch(withCase({}, sessions::makeCase(files).made)));
  }

  virtual std::filesystem::path deepImage() {
    static const test::TemporaryFolder folder;
    const auto file = folder.path() / "image.png";
    if (std::filesystem::exists(file)) return file;
    QImage deep(original_.width, original_.height, QImage::Format_Grayscale16);
    for (int y = 0; y < deep.height(); ++y) {
      auto* line = reinterpret_cast<quint16*>(deep.scanLine(y));
      for (int x = 0; x < deep.width(); ++x)
        line[x] = static_cast<quint16>(kFactor * original_.view().at(x, y));
    }
    EXPECT_TRUE(deep.save(QString::fromStdString(file.string())));
    EXPECT_EQ(sessions::readImage(file).sample_bits, 16);
    return file;
  }
  const sessions::SessionCase& edited() { return *window_.document().session().findCase("os"); }
  DisplayImage& display() { return window_.image().display(); }
  /// What is drawn of a pixel of the image, from the screen.
  int shownGray(int x, int y) {
    ImageView& view = window_.image().view();
    for (int i = 0; i < kLayerCount; ++i) {
      LayerStyle style = view.layer(static_cast<LayerId>(i)).style;
      style.visible = false;
      view.setStyle(static_cast<LayerId>(i), style);
    }
    view.centreOn(QPointF(x, y), 6.0);
    const QImage picture = view.grab().toImage();
    return qRed(picture.pixel(view.transform().toWidget(QPointF(x, y)).toPoint()));
  }
  void apply(int bits) {
    find<QSpinBox>("conversionBits").setValue(bits);
    QTest::mouseClick(&find<QPushButton>("applyConversion"), Qt::LeftButton);
  }

  const sessions::GrayImage& original_ = test::osExample().image;
};

TEST_F(LevelsEditingTest, ADeepImageIsShownStretchedAndTheCoresViewIsNot) {
  const auto& core = window_.state().currentCase()->image;
  const auto brightest = std::max_element(original_.pixels.begin(), original_.pixels.end());
  const auto index = static_cast<int>(brightest - original_.pixels.begin());
  const int x = index % original_.width, y = index / original_.width;
  EXPECT_LE(core.view().at(x, y), 16) << "12 of 16 bits";
  EXPECT_EQ(shownGray(x, y), 255);
  for (const int expected : {static_cast<int>(core.view().at(x, y)), 255}) {
    QTest::keyClick(&window_, Qt::Key_C);
    ASSERT_TRUE(rests());
    EXPECT_EQ(shownGray(x, y), expected);
  }
  auto& place = find<QLabel>("place");
  const QPoint at = window_.image().view().transform().toWidget(QPointF(x, y)).toPoint();
  QTest::mouseMove(&window_.image().view(), at);
  EXPECT_TRUE(test::has(place.text(), "gray "));
  EXPECT_TRUE(test::has(place.text(), "(sample "));
}

TEST_F(LevelsEditingTest, TheDisplaysLevelsChangeThePictureAndNothingElse_NorDoTooFewBits) {
  const std::string digest = sessions::inputsDigest(edited());
  const auto before = window_.state().currentCase();
  find<QSpinBox>("displayBlack").setValue(1000);
  find<QSpinBox>("displayWhite").setValue(1100);
  ASSERT_TRUE(rests());
  EXPECT_EQ(display().levels(), (sessions::GrayLevels{1000, 1100}));
  const QImage& picture = display().picture();
  for (int y = 0; y < picture.height(); y += 37)
    for (int x = 0; x < picture.width(); x += 31) {
      const int v = std::clamp(kFactor * original_.view().at(x, y), 1000, 1100);
      ASSERT_EQ(picture.constScanLine(y)[x], (2 * (v - 1000) * 255 + 100) / 200);
    }
  EXPECT_FALSE(window_.document().isModified());
  EXPECT_FALSE(window_.document().canUndo());
  EXPECT_EQ(window_.state().currentCase(), before);
  EXPECT_EQ(sessions::inputsDigest(edited()), digest);
  apply(8);
  ASSERT_TRUE(rests());
  EXPECT_TRUE(test::has(window_.lastMessage(), "more than 8 bits"));
  EXPECT_FALSE(window_.document().isModified()) << "too few bits are refused";
}

TEST_F(LevelsEditingTest, TheConversionIsAnEditThatMakesRunsStale) {
  ASSERT_TRUE(runToTheEnd(1));
  apply(12);
  ASSERT_TRUE(wait([&] {
    return resting() && window_.state().currentCase()->source.image.eight_bit.bit_depth == 12;
  }));
  const auto& session = window_.document().session();
  EXPECT_TRUE(stalenessOf(session.runs[0], session, {}).inputs_changed);
  EXPECT_FALSE(window_.cases().staleness().isEmpty());
  EXPECT_GT(*std::max_element(window_.state().currentCase()->image.pixels.begin(),
                              window_.state().currentCase()->image.pixels.end()),
            200);
  EXPECT_TRUE(test::has(find<QLabel>("conversionRule").text(), "2^12"));
  ASSERT_TRUE(runToTheEnd(2));
  EXPECT_EQ(session.runs[1].digest,
            sessions::runCase(session, "os", sessions::RecordLevel::kSummary).digest);
  QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
  EXPECT_FALSE(edited().image.eight_bit.bit_depth);
  EXPECT_FALSE(stalenessOf(session.runs[0], session, {}).stale());
}

TEST_F(LevelsEditingTest, AsDisplayed_CopiesTheDisplayLevelsToTheConversion) {
  find<QSpinBox>("displayBlack").setValue(160);
  find<QSpinBox>("displayWhite").setValue(3000);
  ASSERT_TRUE(rests());
  QTest::mouseClick(&find<QPushButton>("conversionFromDisplay"), Qt::LeftButton);
  QTest::mouseClick(&find<QPushButton>("applyConversion"), Qt::LeftButton);
  ASSERT_TRUE(wait([&] { return resting() && edited().image.eight_bit.levels; }));
  EXPECT_EQ(*edited().image.eight_bit.levels, (sessions::GrayLevels{160, 3000}));
  ASSERT_TRUE(rests());
  EXPECT_EQ(display().corePicture(), display().picture());
}

/// The same image with a label that says how many bits are used.
class LabelledLevelsTest : public LevelsEditingTest {
 protected:
  std::filesystem::path deepImage() override {
    std::vector<std::uint16_t> samples;
    for (const std::uint8_t gray : original_.pixels)
      samples.push_back(static_cast<std::uint16_t>(kFactor * gray));
    return folder_.write(
        "sol12.img",
        test::vicarImage(original_.width, original_.height, samples,
                         "PROPERTY='IMAGE_DATA'  SAMPLE_BIT_MASK='2#0000111111111111#'"));
  }
};

TEST_F(LabelledLevelsTest, TheBitsOfTheLabelAreShownAndNotStatedAgain) {
  ASSERT_TRUE(find<QLabel>("conversionRule").text().contains(QStringLiteral("2^12")));
  EXPECT_EQ(find<QSpinBox>("conversionBits").value(), 12);
  EXPECT_EQ(find<QSpinBox>("conversionWhite").value(), 4095);
  EXPECT_FALSE(find<QPushButton>("applyConversion").isEnabled()) << "nothing differs";
  apply(13);
  ASSERT_TRUE(wait([&] { return resting() && edited().image.eight_bit.bit_depth == 13; }));
  QTest::keyClick(&window_, Qt::Key_Z, Qt::ControlModifier);
  ASSERT_TRUE(wait([&] { return resting() && !edited().image.eight_bit.bit_depth; }));
  EXPECT_EQ(find<QSpinBox>("conversionBits").value(), 12);
}

}  // namespace
}  // namespace boresight::ui
