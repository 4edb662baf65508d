// SPDX-License-Identifier: Apache-2.0
// Not a test: makes the manual's pictures. make_pictures.sh prepares what it shows.
//
//     manual_pictures SESSIONS OUT [NAME ...]
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include <QtWidgets>

#include "core/localizer/localizer_options.h"
#include "sessions/session/case_run.h"
#include "sessions/trace/iteration_trace.h"
#include "sessions/trace/overlay.h"
#include "sessions/trace/scene_render.h"
#include "sessions/trace/score_map.h"
#include "ui/manual/manual_window.h"
#include "ui/panels/diagnose/hypotheses_panel.h"
#include "ui/review/queue_panel.h"
#include "ui/review/review_panel.h"
#include "ui/style/theme.h"
#include "ui/views/display_image.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/window/application.h"
#include "ui/window/main_window.h"
#include "ui/workspaces/workspaces.h"

namespace boresight::ui {
namespace {

namespace fs = std::filesystem;

constexpr int kTile_px = 420;
constexpr int kGap_px = 8;

void require(Status status) {
  if (status != Status::kOk) throw std::runtime_error("a stage cannot be drawn");
}

/// Tiles in a row, each with its name in its corner.
QImage row(const std::vector<std::pair<QString, QImage>>& tiles) {
  const int count = static_cast<int>(tiles.size());
  QImage picture(count * kTile_px + (count - 1) * kGap_px, kTile_px, QImage::Format_RGB32);
  picture.fill(Qt::white);
  QPainter painter(&picture);
  QFont font = painter.font();
  font.setPixelSize(15);
  font.setBold(true);
  painter.setFont(font);
  for (int i = 0; i < count; ++i) {
    const auto& [name, tile] = tiles[static_cast<std::size_t>(i)];
    const int x = i * (kTile_px + kGap_px);
    painter.drawImage(
        x, 0, tile.scaled(kTile_px, kTile_px, Qt::IgnoreAspectRatio, Qt::SmoothTransformation));
    const QRect plate(x, kTile_px - 26, painter.fontMetrics().horizontalAdvance(name) + 16, 26);
    painter.fillRect(plate, QColor(20, 20, 20));
    painter.setPen(Qt::white);
    painter.drawText(plate, Qt::AlignCenter, name);
  }
  return picture;
}

/// The middle of the image, where the station is.
QRect middleOf(const Camera& camera) {
  const int side = std::min(camera.width, camera.height) * 3 / 4;
  return {(camera.width - side) / 2, (camera.height - side) / 2, side, side};
}

/// A picture by the colour of each of its pixels.
template <class Color>
QImage painted(int width, int height, const Color& color_of) {
  QImage image(width, height, QImage::Format_RGB32);
  for (int i = 0; i < width * height; ++i)
    image.setPixel(i % width, i / width, color_of(static_cast<std::size_t>(i)));
  return image;
}

QImage depthImage(const std::vector<float>& depth_m, int width, int height) {
  float nearest = 1e9F;
  float farthest = 0.0F;
  for (const float depth : depth_m) {
    if (depth <= 0.0F) continue;
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  return painted(width, height, [&](std::size_t i) {
    const float share = (depth_m[i] - nearest) / std::max(1e-6F, farthest - nearest);
    const int gray = depth_m[i] <= 0.0F ? 0 : static_cast<int>(255.0F - 200.0F * share);
    return qRgb(gray, gray, gray);
  });
}

QImage normalImage(const std::vector<Eigen::Vector3f>& normal, int width, int height) {
  const auto part = [](float value) { return static_cast<int>(127.5F + 127.5F * value); };
  return painted(width, height, [&](std::size_t i) {
    const Eigen::Vector3f& n = normal[i];
    return n.isZero() ? qRgb(0, 0, 0) : qRgb(part(n.x()), part(-n.y()), part(-n.z()));
  });
}

QImage bitsImage(const sessions::BitMap& bits) {
  QImage image(bits.width, bits.height, QImage::Format_RGB32);
  image.fill(Qt::black);
  QPainter painter(&image);
  const BitImage view = bits.view();
  for (int y = 0; y < bits.height; ++y)
    for (int x = 0; x < bits.width; ++x)
      if (view.get(x, y)) painter.fillRect(x - 1, y - 1, 2, 2, Qt::white);
  return image;
}

QImage overlay(const LocalizationProblem& problem, const Pose& pose,
               const sessions::ColorBgr& color) {
  const std::array<sessions::OverlayLayer, 1> layers = {{{"", pose, color}}};
  const sessions::ColorImage drawn =
      sessions::drawOverlay(problem.image, problem.camera, problem.mesh, layers);
  return QImage(drawn.bgr.data(), drawn.width, drawn.height, 3 * drawn.width, QImage::Format_RGB888)
      .rgbSwapped();
}

/// Depth, normals and salient edges of the station as the seed has it, side by side.
QImage renderPicture(const sessions::LoadedCase& loaded_case) {
  const LocalizationProblem problem = loaded_case.problem();
  const int width = problem.camera.width;
  const int height = problem.camera.height;
  const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<float> depth_m(size);
  std::vector<Eigen::Vector3f> normal(size, Eigen::Vector3f::Zero());
  SurfaceRender surfaces;
  surfaces.depth_m = depth_m;
  surfaces.normal_in_camera = normal;
  sessions::RenderTrace render;
  require(sessions::renderScene(problem.camera, problem.mesh, problem.camera_from_station_seed,
                                render, surfaces));
  const QRect middle = middleOf(problem.camera);
  return row({{QStringLiteral("depth"), depthImage(depth_m, width, height).copy(middle)},
              {QStringLiteral("normals"), normalImage(normal, width, height).copy(middle)},
              {QStringLiteral("salient edges"), bitsImage(render.edges).copy(middle)}});
}

/// The image and the edges that Canny's detector finds in it, side by side.
QImage edgePicture(const sessions::LoadedCase& loaded_case) {
  const LocalizationProblem problem = loaded_case.problem();
  sessions::EdgeMapTrace edges;
  require(sessions::detectEdges(problem.image, nullptr, defaultProfile().edges, edges));
  const QRect middle = middleOf(problem.camera);
  return row({{QStringLiteral("image"), grayImage(problem.image).copy(middle)},
              {QStringLiteral("Canny's edges"), bitsImage(edges.level[0]).copy(middle)}});
}

/// Part of the image with the edges of the seed, and with those of the result.
QImage beforeAndAfter(const sessions::LoadedCase& loaded_case, const Pose& camera_from_station) {
  const LocalizationProblem problem = loaded_case.problem();
  const QRect middle = middleOf(problem.camera);
  return row(
      {{QStringLiteral("seed"),
        overlay(problem, problem.camera_from_station_seed, sessions::kSeedColor).copy(middle)},
       {QStringLiteral("result"),
        overlay(problem, camera_from_station, sessions::kResultColor).copy(middle)}});
}

/// A window with a session in it, as an operator has it.
class Stage {
 public:
  explicit Stage(const fs::path& session, const QString& case_id = {}) {
    window_.setQuiet(true);
    window_.resize(1280, 800);
    window_.show();
    const QString problem = openForPictures(window_, session, folder_.path().toStdString());
    if (!problem.isEmpty()) throw std::runtime_error(problem.toStdString());
    rest();
    if (!case_id.isEmpty()) window_.cases().chooseCase(case_id);
    rest();
  }

  MainWindow& window() { return window_; }
  void rest() {
    QApplication::processEvents();
    if (!waitUntilResting(window_)) throw std::runtime_error("the window does not rest");
    QApplication::processEvents();
  }
  void run() {
    if (!window_.state().snapshot()) window_.cases().advance(sessions::StepUntil::kEnd);
    rest();
    fit();
  }
  QDockWidget& front(const char* name, int height_px = 0) {
    QDockWidget* dock = window_.dock(QLatin1String(name));
    window_.workspaces().reveal(QLatin1String(name));
    rest();
    if (height_px > 0) height(name, height_px);
    return *dock;
  }
  void fit() { window_.image().view().fit(); }
  void iteration(int index) {
    window_.state().setCursor({.iteration = index});
    rest();
  }
  void layer(LayerId id, bool visible) {
    LayerStyle style = window_.image().style(id);
    style.visible = visible;
    window_.image().setStyle(id, style);
  }
  void height(const char* dock, int pixels) {
    window_.resizeDocks({window_.dock(QLatin1String(dock))}, {pixels}, Qt::Vertical);
    rest();
  }

 private:
  QTemporaryDir folder_;
  MainWindow window_;
};

/// Where sessions are and pictures go.
struct Places {
  fs::path sessions;
  fs::path out;

  void save(const QImage& picture, const char* name) const {
    const fs::path file = out / (std::string(name) + ".png");
    if (!picture.save(QString::fromStdString(file.string()), "PNG"))
      throw std::runtime_error("cannot write " + file.string());
  }
  void save(QWidget& widget, const char* name) const { save(widget.grab().toImage(), name); }
};

void drawWindow(const Places& places) {
  Stage stage(places.sessions / "example.boresight.json");
  stage.run();
  places.save(stage.window(), "window");
}

void drawOnboard(const Places& places) {
  Stage stage(places.sessions / "onboard.boresight.json");
  stage.run();
  stage.height("iterations", 380);
  stage.front("onboard");
  stage.window().onboard().showOnboard();
  stage.rest();
  stage.fit();
  places.save(stage.window(), "onboard");
}

void drawFailedRun(const Places& places) {
  Stage stage(places.sessions / "turned.boresight.json");
  stage.run();
  stage.window().workspaces().show(Workspace::kDiagnose);
  stage.front("remedies");
  places.save(stage.window(), "failed_run");
  stage.iteration(0);
  stage.window().state().selectTemplate(12);
  stage.height("iterations", 400);
  places.save(*stage.front("inspector").widget(), "failed_inspector");
}

void drawStatedRun(const Places& places) {
  Stage stage(places.sessions / "stated.boresight.json");
  stage.run();
  stage.front("hypotheses");
  stage.window().findChild<HypothesesPanel*>()->choose(0);
  stage.rest();
  stage.fit();
  places.save(stage.window(), "stated_run");
}

void drawAnnotation(const Places& places) {
  Stage stage(places.sessions / "annotated.boresight.json");
  AnnotationController& annotation = stage.window().annotation();
  annotation.setMode(PlaceMode::kPoint);
  annotation.select("p7");
  stage.front("annotation");
  const sessions::PointPair* point = annotation.selectedPoint();
  stage.window().image().view().centreOn({point->pixel->x(), point->pixel->y()}, 2.0);
  stage.rest();
  places.save(stage.window(), "annotation");
}

void drawQueue(const Places& places) {
  Stage stage(places.sessions / "batch.boresight.json");
  stage.front("queue", 380);
  stage.fit();
  places.save(stage.window(), "queue");
}

void drawReview(const Places& places) {
  Stage stage(places.sessions / "example.boresight.json");
  stage.run();
  stage.front("review", 420);
  stage.fit();
  places.save(stage.window(), "review");
}

/// The template that was found with the best score of those that agree with the pose.
int bestInlier(const sessions::LocalizationTrace& run, const sessions::IterationTrace& iteration) {
  int best = 0;
  double score = 0.0;
  for (std::size_t i = 0; i < iteration.pnp.inlier.size(); ++i) {
    const int item = iteration.template_of[i];
    const auto map = sessions::scoreMap(*run.edges, iteration, item);
    if (iteration.pnp.inlier[i] == 0 || !map || map->highest <= score) continue;
    score = map->highest;
    best = item;
  }
  return best;
}

void drawStages(const Places& places) {
  Stage stage(places.sessions / "example.boresight.json", QStringLiteral("os-000038"));
  stage.run();
  const auto value = stage.window().state().currentCase();
  places.save(renderPicture(*value), "stage_render");
  places.save(edgePicture(*value), "stage_edges");
  places.save(beforeAndAfter(*value, stage.window().state().snapshot()->camera_from_station),
              "stage_result");
  stage.iteration(0);
  for (const LayerId id : {LayerId::kSeedEdges, LayerId::kIterationEdges}) stage.layer(id, false);
  stage.layer(LayerId::kTemplates, true);
  stage.window().dock(QStringLiteral("layers"))->hide();
  stage.window().resize(1260, 990);
  stage.rest();
  stage.fit();
  stage.rest();
  places.save(stage.window().image().view(), "stage_matches");
  const ViewState& state = stage.window().state();
  stage.window().state().selectTemplate(bestInlier(*state.snapshot(), *state.iteration()));
  places.save(*stage.front("inspector", 420).widget(), "stage_score_map");
}

void drawManual(const Places& places) {
  ManualWindow manual(manualFolder());
  manual.resize(1000, 640);
  manual.showPage(QStringLiteral("checks.md"));
  QApplication::processEvents();
  places.save(manual, "manual");
}

void makePictures(const Places& places, const QStringList& wanted) {
  const std::pair<const char*, void (*)(const Places&)> all[] = {
      {"window", drawWindow},        {"onboard", drawOnboard},       {"failed_run", drawFailedRun},
      {"stated_run", drawStatedRun}, {"annotation", drawAnnotation}, {"queue", drawQueue},
      {"review", drawReview},        {"stages", drawStages},         {"manual", drawManual}};
  for (const auto& [name, draw] : all) {
    if (!wanted.isEmpty() && !wanted.contains(QLatin1String(name))) continue;
    std::printf("%s\n", name);
    std::fflush(stdout);
    draw(places);
  }
}

}  // namespace
}  // namespace boresight::ui

int main(int argc, char** argv) {
  boresight::ui::prepareApplication(false);
  QApplication application(argc, argv);
  boresight::ui::nameApplication(application);
  boresight::ui::applyTheme(application, boresight::ui::ThemeName::kLight);
  const QStringList arguments = QApplication::arguments();
  if (arguments.size() < 3) {
    std::fprintf(stderr, "manual_pictures SESSIONS OUT [NAME ...]\n");
    return 2;
  }
  try {
    boresight::ui::makePictures({arguments[1].toStdString(), arguments[2].toStdString()},
                                arguments.mid(3));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "manual_pictures: %s\n", error.what());
    return 1;
  }
}
