// SPDX-License-Identifier: Apache-2.0
// Renders per second while a pose is nudged: nudge_rate DATASET CASE [SECONDS].
// Poses come at 60 a second, as a held key sends them at most.
#include <QCoreApplication>
#include <QElapsedTimer>
#include <QTimer>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "sessions/session/case_run.h"
#include "sessions/session/session_maker.h"
#include "ui/run/pose_renderer.h"

using namespace boresight;

namespace {

std::shared_ptr<const sessions::LoadedCase> load(const char* file, const char* id) {
  const sessions::Session session = sessions::makeSession(file, {id});
  return sessions::loadCase(*session.cases.front());
}

}  // namespace

int main(int argc, char** argv) {
  const QCoreApplication application(argc, argv);
  const auto value = argc > 2 ? load(argv[1], argv[2]) : nullptr;
  if (!value) {
    std::fputs("usage: nudge_rate DATASET CASE [SECONDS]\n", stderr);
    return 2;
  }
  const int seconds = argc > 3 ? std::atoi(argv[3]) : 5;
  ui::PoseRenderer renderer;
  renderer.setCase(value);
  int moving = 0;
  QElapsedTimer rested;
  QElapsedTimer clock;
  QObject::connect(&renderer, &ui::PoseRenderer::rendered, [&](const auto& render, int level) {
    if (level > 0) {
      ++moving;
      return;
    }
    std::printf(
        "%d x %d, %zu faces: %d renders at half resolution in %d s (%.1f a second); full "
        "resolution %lld ms after the last move\n",
        render->edges.width, render->edges.height, value->scene.faces.size(), moving, seconds,
        static_cast<double>(moving) / seconds, static_cast<long long>(rested.elapsed()));
    QCoreApplication::quit();
  });
  QTimer keys;
  clock.start();
  QObject::connect(&keys, &QTimer::timeout, [&] {
    if (clock.elapsed() > 1000 * seconds) {
      keys.stop();
      rested.start();
      return;
    }
    Pose pose = value->source.camera_from_station_seed;
    pose.translation_m.x() += 0.01 * std::sin(0.005 * static_cast<double>(clock.elapsed()));
    renderer.setPose(pose);
  });
  keys.setTimerType(Qt::PreciseTimer);
  keys.start(16);
  return QCoreApplication::exec();
}
