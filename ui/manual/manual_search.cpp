// SPDX-License-Identifier: Apache-2.0
#include "ui/manual/manual_search.h"

#include <algorithm>

#include <QStringList>

namespace boresight::ui {
namespace {

constexpr int kAround = 60;  // characters to either side of what was found

/// The line round a place, on one line and not too long.
QString lineRound(const QString& text, int place) {
  const int begin =
      std::max(static_cast<int>(text.lastIndexOf(QLatin1Char('\n'), place)) + 1, place - kAround);
  int end = static_cast<int>(text.indexOf(QLatin1Char('\n'), place));
  if (end < 0) end = static_cast<int>(text.size());
  return text.mid(begin, std::min(end, place + kAround) - begin).simplified();
}

bool holds(const QString& text, const QStringList& words) {
  return std::all_of(words.begin(), words.end(), [&text](const QString& word) {
    return text.contains(word, Qt::CaseInsensitive);
  });
}

}  // namespace

std::vector<ManualHit> searchManual(const QString& folder, const QString& query) {
  const QStringList words = query.simplified().split(QLatin1Char(' '));
  std::vector<ManualHit> hits;
  if (words.front().isEmpty()) return hits;
  for (const ManualPage& page : manualPages(folder)) {
    const QString text = manualText(folder + QLatin1Char('/') + page.file);
    if (!holds(text, words)) continue;
    ManualHit hit{page, 0, {}};
    for (const QString& word : words)
      hit.count += static_cast<int>(text.count(word, Qt::CaseInsensitive));
    hit.around =
        lineRound(text, static_cast<int>(text.indexOf(words.front(), 0, Qt::CaseInsensitive)));
    hits.push_back(std::move(hit));
  }
  std::stable_sort(hits.begin(), hits.end(), [&words](const ManualHit& a, const ManualHit& b) {
    const bool a_title = holds(a.page.title, words);
    const bool b_title = holds(b.page.title, words);
    return a_title != b_title ? a_title : a.count > b.count;
  });
  return hits;
}

}  // namespace boresight::ui
