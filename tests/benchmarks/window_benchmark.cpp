// SPDX-License-Identifier: Apache-2.0
// What the desktop program takes to open a session: time from the start of the process until the
// image of the first case is painted, then until nothing is left to read; private memory there.
// Each measurement is a process of its own.
//
//     QT_QPA_PLATFORM=offscreen window_benchmark SESSION
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <QtWidgets>
#include <benchmark/benchmark.h>

#include "ui/style/theme.h"
#include "ui/views/image_panel.h"
#include "ui/views/image_view.h"
#include "ui/window/application.h"
#include "ui/window/main_window.h"

namespace {

using namespace boresight;  // NOLINT

constexpr const char* kChild = "--child";
enum class Until { kPicture, kRest };

/// Private memory of this process, MB.
double privateMemory_MB() {
  std::ifstream stream("/proc/self/smaps_rollup");
  double all_kB = 0.0;
  for (std::string word; stream >> word;) {
    double size_kB = 0.0;
    if ((word == "Private_Clean:" || word == "Private_Dirty:") && stream >> size_kB)
      all_kB += size_kB;
  }
  return all_kB / 1024.0;
}

/// Ends the event loop once an image is painted.
class PaintWatch final : public QObject {
 public:
  explicit PaintWatch(ui::ImageView& view) : view_(view) { view.installEventFilter(this); }

  bool eventFilter(QObject* object, QEvent* event) override {
    if (event->type() == QEvent::Paint && !view_.imageSize().isEmpty())
      QTimer::singleShot(0, qApp, &QCoreApplication::quit);
    return QObject::eventFilter(object, event);
  }

 private:
  ui::ImageView& view_;
};

/// As app/boresight.cpp starts; without stored settings.
int runChild(const std::filesystem::path& session, Until until, int argc, char** argv) {
  ui::prepareApplication(true);
  QApplication application(argc, argv);
  ui::nameApplication(application);
  ui::applyTheme(application, ui::ThemeName::kLight);
  ui::MainWindow window;
  window.setQuiet(true);
  PaintWatch watch(window.image().view());
  window.show();
  window.takeFiles({session});
  if (window.lastMessage().isEmpty()) QApplication::exec();
  if (until == Until::kRest) ui::waitUntilResting(window);
  std::printf("%.1f\n", privateMemory_MB());
  std::fflush(stdout);
  std::_Exit(window.lastMessage().isEmpty() ? 0 : 1);
}

/// Private memory of the child at its end, MB; negative when it failed.
double measureChild(const std::string& session, Until until) {
  int ends[2] = {};
  if (pipe(ends) != 0) return -1.0;
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDOUT_FILENO);
    execl("/proc/self/exe", "window_benchmark", kChild, until == Until::kRest ? "rest" : "picture",
          session.c_str(), nullptr);
    std::_Exit(1);
  }
  close(ends[1]);
  char text[32] = {};
  const ssize_t size = read(ends[0], text, sizeof text - 1);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return size > 0 && status == 0 ? std::atof(text) : -1.0;
}

void measure(benchmark::State& state, const std::string& session, Until until) {
  double most_MB = 0.0;
  for (auto _ : state) {
    const auto began = std::chrono::steady_clock::now();
    const double private_MB = measureChild(session, until);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - began;
    if (private_MB < 0.0) return state.SkipWithError("the session could not be opened");
    state.SetIterationTime(passed.count());
    most_MB = std::max(most_MB, private_MB);
  }
  state.counters["private_MB"] = most_MB;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 4 && std::strcmp(argv[1], kChild) == 0)
    return runChild(argv[3], std::strcmp(argv[2], "rest") == 0 ? Until::kRest : Until::kPicture,
                    argc, argv);
  benchmark::Initialize(&argc, argv);
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s [--benchmark_...] SESSION\n", argv[0]);
    return 2;
  }
  const std::string session = argv[1];
  for (const auto& [name, until] :
       {std::pair("first picture", Until::kPicture), std::pair("all read", Until::kRest)})
    benchmark::RegisterBenchmark(
        name, [&session, until = until](benchmark::State& state) { measure(state, session, until); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
}
