// SPDX-License-Identifier: Apache-2.0
#include "ui/panels/score_mapper.h"

#include <utility>

namespace boresight::ui {
namespace {

constexpr std::size_t kMostKnown = 32;

QString taskKey() { return QStringLiteral("score map"); }

ScoreMapper::MapPtr computed(const ScoreMapper::Request& request, const std::stop_token& stop) {
  auto map = sessions::scoreMap(*request.edges, *request.iteration, request.template_index, stop);
  return map ? std::make_shared<const sessions::ScoreMap>(std::move(*map)) : nullptr;
}

}  // namespace

ScoreMapper::ScoreMapper(QObject* parent) : QObject(parent) {}

ScoreMapper::MapPtr ScoreMapper::request(const Request& request) {
  cancel();
  for (const Known& one : known_)
    if (one.request == request) return one.map;
  if (!request.edges || !request.iteration) return nullptr;
  runner_.start(
      taskKey(), [request](const std::stop_token& stop) { return computed(request, stop); },
      [this, request](const MapPtr& map) { take(request, map); });
  return nullptr;
}

void ScoreMapper::cancel() { runner_.cancel(taskKey()); }

void ScoreMapper::take(const Request& request, const MapPtr& map) {
  if (map) known_.push_front({request, map});
  if (known_.size() > kMostKnown) known_.pop_back();
  Q_EMIT ready(map);
}

}  // namespace boresight::ui
