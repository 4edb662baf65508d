// SPDX-License-Identifier: Apache-2.0
#include "ui/run/sequence_runner.h"

#include <utility>

#include "sessions/io/images/video_frames.h"
#include "sessions/run/problem.h"

namespace boresight::ui {
namespace {

SequenceProgress progressOf(const sessions::CaseSequence& sequence) {
  const sessions::Sequence& frames = sequence.sequence();
  return {frames.frames(),
          sequence.total(),
          static_cast<std::int64_t>(frames.lost().size()),
          sequence.framesPerSecond(),
          QString::fromStdString(sessions::sequenceText(frames)),
          sequence.notes()};
}

}  // namespace

void SequenceRunner::start(const sessions::SequenceOrder& order,
                           std::shared_ptr<const sessions::LoadedCase> loaded) {
  if (running_) return;
  order_ = order;
  loaded_ = std::move(loaded);
  rows_.clear();
  progress_ = {};
  running_ = true;
  stopped_ = false;
  const auto work = [this, order, loaded = loaded_](const std::stop_token& stop,
                                                    const TaskRunner::Report& report) {
    auto source = sessions::openFrames(order.images, order.session_case.image.eight_bit);
    const std::string name = "case " + order.session_case.id;
    const sessions::InputPlaces places{{}, {name, "camera"}, {}, {name, "seed"}};
    sessions::SequenceInputs inputs = sessions::sequenceInputs(order, places, &loaded->image);
    const Eigen::Vector3d centre_m = matchedBounds(inputs.scene.view()).centre();
    sessions::CaseSequence sequence(order, std::move(inputs), std::move(source));
    while (const auto result = sequence.next(stop))
      report([this, row = sessions::sequenceRow(*result, centre_m),
              progress = progressOf(sequence)] { take(row, progress); });
    report([this, progress = progressOf(sequence)] {
      progress_ = progress;
      end();
    });
  };
  runner_.replace(sequence_, work, [this](const QString& message) {
    Q_EMIT failed(message);
    end();
  });
  Q_EMIT changed();
}

void SequenceRunner::stop() {
  if (!running_) return;
  stopped_ = true;
  runner_.stop(sequence_);
}

void SequenceRunner::take(const sessions::SequenceRow& row, SequenceProgress progress) {
  rows_.push_back(row);
  progress_ = std::move(progress);
  Q_EMIT changed();
}

void SequenceRunner::end() {
  running_ = false;
  Q_EMIT changed();
}

}  // namespace boresight::ui
