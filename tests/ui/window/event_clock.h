// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include <QtWidgets>

namespace boresight::ui {

/// How long the event loop was kept by one event, and by what.
struct EventGap {
  double ms = 0.0;
  QString where;
};

/// An application that times every event that its loop delivers. While an event is handled the
/// window answers nobody: the longest one is the longest time that the window was frozen.
class EventClock : public QApplication {
 public:
  using QApplication::QApplication;

  /// From now on.
  void begin() { gaps_.clear(); }
  /// The longest first.
  std::vector<EventGap> longest(std::size_t count) const {
    std::vector<EventGap> sorted = gaps_;
    std::sort(sorted.begin(), sorted.end(),
              [](const EventGap& a, const EventGap& b) { return a.ms > b.ms; });
    sorted.resize(std::min(count, sorted.size()));
    return sorted;
  }

  bool notify(QObject* receiver, QEvent* event) override {
    if (depth_ > 1) return QApplication::notify(receiver, event);
    const QString where = describe(*receiver, *event);
    if (depth_ == 0) inner_ = {};
    ++depth_;
    QElapsedTimer clock;
    clock.start();
    const bool taken = QApplication::notify(receiver, event);
    --depth_;
    note({static_cast<double>(clock.nsecsElapsed()) * 1e-6, where});
    return taken;
  }

 private:
  static QString describe(const QObject& receiver, const QEvent& event) {
    const char* type = QMetaEnum::fromType<QEvent::Type>().valueToKey(event.type());
    return QStringLiteral("%1 '%2' %3")
        .arg(QString::fromLatin1(receiver.metaObject()->className()), receiver.objectName(),
             type ? QString::fromLatin1(type) : QString::number(event.type()));
  }

  /// What was sent while another event was handled belongs to that one.
  void note(EventGap gap) {
    if (depth_ > 0) {
      if (gap.ms > inner_.ms) inner_ = gap;
      return;
    }
    if (inner_.ms > 0.5 * gap.ms)
      gap.where +=
          QStringLiteral(", of it %1 ms in %2").arg(inner_.ms, 0, 'f', 1).arg(inner_.where);
    if (gap.ms > 1.0) gaps_.push_back(gap);
  }

  int depth_ = 0;
  EventGap inner_;
  std::vector<EventGap> gaps_;
};

}  // namespace boresight::ui
