// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>

#include <QObject>

#include "sessions/run/score_map.h"
#include "sessions/run/trace.h"
#include "ui/run/task_runner.h"

namespace boresight::ui {

/// Computes score maps off the UI's thread, one at a time: the newest request wins, an older one is
/// cancelled and never answered. Keeps the latest maps.
class ScoreMapper : public QObject {
  Q_OBJECT

 public:
  using MapPtr = std::shared_ptr<const sessions::ScoreMap>;

  struct Request {
    std::shared_ptr<const sessions::EdgeMapTrace> edges;
    std::shared_ptr<const sessions::IterationTrace> iteration;
    int template_index = -1;

    bool operator==(const Request&) const = default;
  };

  explicit ScoreMapper(QObject* parent = nullptr);

  /// The map if it is known; else nullptr, and `ready` comes later.
  MapPtr request(const Request& request);
  /// Nothing that was asked for is answered any more.
  void cancel();

 Q_SIGNALS:
  /// nullptr when there is no map of that template.
  void ready(const boresight::ui::ScoreMapper::MapPtr& map);

 private:
  struct Known {
    Request request;
    MapPtr map;
  };

  void take(const Request& request, const MapPtr& map);

  std::deque<Known> known_;
  TaskRunner runner_;
};

}  // namespace boresight::ui
