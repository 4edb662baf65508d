// SPDX-License-Identifier: Apache-2.0
// Localization of a sequence, for `whs follow` and the window.
#pragma once

#include <chrono>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>
#include <string>

#include "sessions/evaluation/results_file.h"
#include "sessions/evaluation/sequence.h"
#include "sessions/run/problem.h"
#include "sessions/session/session.h"

namespace boresight::sessions {

/// A sequence whose first frame starts from a case's seed.
struct SequenceOrder {
  std::filesystem::path images;                  ///< folder, list or video
  SessionCase session_case;                      ///< all inputs but the image
  DeclaredUncertainty motion = assumedMotion();  ///< between two frames, at most
  std::string profile = "default";
  LocalizerOptions options;       ///< with the case's feature size
  RunSettings settings;           ///< a summary of each run is kept, whatever its level
  std::filesystem::path results;  ///< SQLite; an existing file of the same sequence is continued
  std::string command;            ///< that started the sequence, for the results
};

/// Reads mesh and mask. Strokes of the mask are drawn for `image`, the image of the case: pixels
/// ignored by its gray values are ignored in all frames. InputError, also of a camera whose
/// distortion folds back and of a seed from which the station is not visible; `places` names both.
SequenceInputs sequenceInputs(const SequenceOrder& order, const InputPlaces& places,
                              const GrayImage* image = nullptr);

/// Localizes the frames of a sequence one by one and stores each result at once. Frames that the
/// results file holds are taken from it. The next frame is read while one is localized.
class CaseSequence {
 public:
  /// OutputError when the results cannot be written or are of another sequence.
  CaseSequence(const SequenceOrder& order, SequenceInputs inputs,
               std::unique_ptr<FrameSource> source);
  CaseSequence(const CaseSequence&) = delete;
  CaseSequence& operator=(const CaseSequence&) = delete;

  /// The result of the next frame; empty after the last one and after a stop. OutputError, also
  /// when frames that are done were changed, or others added or removed between them.
  std::optional<RunResult> next(const std::stop_token& stop = {});

  /// Number of frames as the source states it; 0 where it states none.
  std::int64_t total() const { return total_; }
  /// Number of frames that the results file held before.
  std::size_t earlier() const { return earlier_.size(); }
  /// Number of frames that this object localized.
  std::int64_t localized() const { return localized_; }
  /// Of the frames that this object localized, with reading and storing; 0 before the first.
  double framesPerSecond() const;
  /// Of the source, for the operator; complete when next() has returned nothing.
  const std::vector<std::string>& notes() const { return notes_; }
  /// The frames so far.
  const Sequence& sequence() const { return sequence_; }

 private:
  void readAhead();
  /// OutputError when the frame, or the place that it takes, is not as in the results file.
  void requireSamePlace(const Frame& frame) const;

  std::unique_ptr<FrameSource> source_;
  std::int64_t total_;
  std::filesystem::path results_;
  ResultsWriter writer_;
  std::vector<std::string> notes_;
  std::map<std::string, RunResult> earlier_;  ///< by the frame's name
  std::set<std::int64_t> places_;             ///< of the earlier ones in the sequence, from 0
  Sequence sequence_;
  std::chrono::steady_clock::time_point began_;
  std::chrono::duration<double> passed_{0.0};
  std::int64_t localized_ = 0;
  std::future<std::optional<Frame>> ahead_;  ///< last: it uses the source
};

/// One frame as a row of a table.
struct SequenceRow {
  std::int64_t number = 0;  ///< from 1
  std::string name;
  bool accepted = false;
  std::optional<double> probability;  ///< that the pose is correct
  std::optional<double> moved_mm;     ///< since the last accepted frame, of the station's centre
  std::optional<double> turned_deg;   ///< since the last accepted frame
  double seconds = 0.0;               ///< of the run
  std::string reason;                 ///< why the frame is lost; empty otherwise
  Pose camera_from_station;           ///< of an accepted frame
};
/// `centre_in_station_m` is that of the matched parts.
SequenceRow sequenceRow(const RunResult& result, const Eigen::Vector3d& centre_in_station_m);

}  // namespace boresight::sessions
