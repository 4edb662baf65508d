// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/compare_records.h"
#include "sessions/text/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <map>
#include <sstream>
#include <tuple>
#include <type_traits>
#include <utility>

#include <Eigen/Cholesky>

#include "core/localizer/workspace.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"

namespace boresight::sessions {
namespace {

/// A share of fewer than these says little.
constexpr int kLeastCounted = 10;

template <class Value>
std::string versus(const Value& value, const Value& other) {
  std::ostringstream text;
  text.precision(9);
  text << value << " and " << other;
  return text.str();
}

/// Keeps the first difference of all that it is asked to compare.
class Walk {
 public:
  const std::optional<FirstDifference>& first() const { return first_; }

  /// What follows belongs to this iteration (an index); -1: to none.
  void enter(int iteration) { iteration_ = iteration; }

  void differ(RunPart part, std::string text, int template_index = -1) {
    if (first_) return;
    if (iteration_ >= 0) text += ", in iteration " + std::to_string(iteration_ + 1);
    first_ = FirstDifference{part, iteration_, template_index, std::move(text)};
  }

  template <class Value>
  void compare(RunPart part, const std::string& what, const Value& value, const Value& other) {
    if (value == other) return;
    std::string values;
    if constexpr (std::is_arithmetic_v<Value>) values = ": " + versus(value, other);
    differ(part, what + " differ" + values);
  }

 private:
  std::optional<FirstDifference> first_;
  int iteration_ = -1;
};

void walkPixels(const OnboardRecord& record, const OnboardRecord& other, Walk& walk) {
  if (!record.inputs || !other.inputs) return;
  const auto pixels = [](const RecordedInputs& inputs) {
    return std::tuple(inputs.width, inputs.height, inputs.sha256.pixels);
  };
  walk.compare(RunPart::kPixels, "the pixels", pixels(*record.inputs), pixels(*other.inputs));
}

void walkOptions(const RecordedOptions& recorded_options, const RecordedOptions& other,
                 Walk& walk) {
  std::map<std::string, std::array<const RecordedOption*, 2>> by_name;
  for (const RecordedOption& option : recorded_options.options) by_name[option.name][0] = &option;
  for (const RecordedOption& option : other.options) by_name[option.name][1] = &option;
  for (const auto& [name, values] : by_name) {
    const auto& [a, b] = values;
    if (a == nullptr || b == nullptr)
      walk.differ(RunPart::kOptions, "only one run has the option " + name);
    else if (!(*a == *b))
      walk.differ(RunPart::kOptions,
                  "the option " + name + " is " + versus(a->value(), b->value()));
  }
}

/// All inputs and options but the pixels.
void walkInputs(const OnboardRecord& record, const OnboardRecord& other, Walk& walk) {
  if (record.inputs && other.inputs) {
    const RecordedInputs& a = *record.inputs;
    const RecordedInputs& b = *other.inputs;
    const auto uncertainty = [](const RecordedInputs& inputs) {
      Eigen::Matrix<double, 9, 1> all;
      all << inputs.uncertainty.translation_m, inputs.uncertainty.rotation_rad,
          inputs.uncertainty.pivot_in_camera_m;
      return all;
    };
    walk.compare(RunPart::kMask, "the ignore masks", a.sha256.ignore, b.sha256.ignore);
    walk.compare(RunPart::kScene, "the meshes", a.sha256.scene, b.sha256.scene);
    walk.compare(RunPart::kCamera, "the cameras", a.sha256.camera, b.sha256.camera);
    walk.compare(RunPart::kSeed, "the seeds", a.camera_from_station_seed,
                 b.camera_from_station_seed);
    walk.compare(RunPart::kSeed, "the uncertainties of the seeds", uncertainty(a), uncertainty(b));
    walk.compare(RunPart::kSeed, "the end effectors", a.end_effector_in_camera_m,
                 b.end_effector_in_camera_m);
  }
  if (record.options.empty() || other.options.empty()) return;
  walkOptions(record.options.front(), other.options.front(), walk);
  const std::size_t both = std::min(record.options.size(), other.options.size());
  for (std::size_t i = 1; i < both; ++i) {
    walk.enter(record.options[i].first_iteration);
    walk.compare(RunPart::kOptions, "options that change during the run", record.options[i],
                 other.options[i]);
  }
  walk.enter(-1);
}

void walkEdges(const OnboardRecord& record, const OnboardRecord& other, Walk& walk) {
  if (!record.edges || !other.edges) return;
  const RecordedEdges& a = *record.edges;
  const RecordedEdges& b = *other.edges;
  walk.compare(RunPart::kEdges, "the lower edge thresholds", a.low_threshold, b.low_threshold);
  walk.compare(RunPart::kEdges, "the upper edge thresholds", a.high_threshold, b.high_threshold);
  walk.compare(RunPart::kEdges, "the image's edge pixels", a.edge_count, b.edge_count);
  walk.compare(RunPart::kEdges, "the positions of the image's edges", a.sha256, b.sha256);
}

void walkTemplates(const RecordedIteration& recorded, const RecordedIteration& other, Walk& walk) {
  walk.compare(RunPart::kTemplates, "the numbers of templates", recorded.trace.template_count,
               other.trace.template_count);
  if (!recorded.templates || !other.templates) return;
  const auto each = [&](RunPart part, auto&& value, auto&& text) {
    const std::size_t count = std::min(recorded.templates->size(), other.templates->size());
    for (std::size_t i = 0; i < count; ++i) {
      const RecordedTemplate& a = (*recorded.templates)[i];
      const RecordedTemplate& b = (*other.templates)[i];
      if (value(a) == value(b)) continue;
      walk.differ(part, "template " + std::to_string(i + 1) + text(a, b), static_cast<int>(i));
    }
  };
  using Item = RecordedTemplate;
  each(
      RunPart::kTemplates, [](const Item& item) { return std::pair(item.x, item.y); },
      [](const Item&, const Item&) { return " was cut at different positions"; });
  each(
      RunPart::kMatches,
      [](const Item& item) {
        return std::tuple(item.searched, item.at_border, item.found_x, item.found_y, item.score,
                          item.second_score);
      },
      [](const Item& a, const Item& b) {
        return " has different matches, with scores " + versus(a.score, b.score);
      });
  each(
      RunPart::kInliers, [](const Item& item) { return item.inlier; },
      [](const Item&, const Item&) { return " is an inlier in one run only"; });
}

void walkIteration(const RecordedIteration& recorded, const RecordedIteration& other, Walk& walk) {
  const IterationTrace& a = recorded.trace;
  const IterationTrace& b = other.trace;
  walk.enter(a.index);
  walk.compare(RunPart::kPose, "the poses before", a.camera_from_station_before,
               b.camera_from_station_before);
  walk.compare(RunPart::kRender, "the kinds", a.kind, b.kind);
  walk.compare(RunPart::kRender, "the levels", a.level, b.level);
  walk.compare(RunPart::kRender, "the rendered edge pixels", a.edge_pixel_count,
               b.edge_pixel_count);
  if (recorded.render_sha256 && other.render_sha256)
    walk.compare(RunPart::kRender, "the renders", *recorded.render_sha256, *other.render_sha256);
  walkTemplates(recorded, other, walk);
  walk.compare(RunPart::kMatches, "the searched templates", a.searched_count, b.searched_count);
  walk.compare(RunPart::kMatches, "the matches", a.correspondence_count, b.correspondence_count);
  walk.compare(RunPart::kInliers, "the inliers", a.pnp.inlier_count, b.pnp.inlier_count);
  walk.compare(RunPart::kInliers, "the edge points used", a.refinement.used_count,
               b.refinement.used_count);
  walk.compare(RunPart::kPose, "the poses after", a.camera_from_station, b.camera_from_station);
  walk.compare(RunPart::kPose, "the states after", std::pair(a.status, a.reached),
               std::pair(b.status, b.reached));
  if (!recorded.support || !other.support) return;
  const auto counts = [](const EdgeSupport& support) {
    const auto& [rendered, covered, displaced, displaced_covered, seen, explained,
                 displaced_explained] = support;
    return std::array{rendered, covered,   displaced,          displaced_covered,
                      seen,     explained, displaced_explained};
  };
  walk.compare(RunPart::kSupport, "the edge supports", counts(*recorded.support),
               counts(*other.support));
}

void walkEnd(const OnboardRecord& record, const OnboardRecord& other, Walk& walk) {
  walk.enter(-1);
  if (!record.end || !other.end) return;
  const RecordedEnd& a = *record.end;
  const RecordedEnd& b = *other.end;
  if (record.whole() && other.whole())
    walk.compare(RunPart::kEnd, "the numbers of iterations", record.iterations.size(),
                 other.iterations.size());
  if (a.status != b.status || a.fault != b.fault)
    walk.differ(RunPart::kEnd, "the runs ended as " + versus(localizationStatusText(a.status),
                                                             localizationStatusText(b.status)));
  walk.compare(RunPart::kEnd, "the final poses", a.camera_from_station, b.camera_from_station);
  walk.compare(RunPart::kEnd, "the final covariances", a.covariance, b.covariance);
  if (a.digest != b.digest)
    walk.differ(RunPart::kDigest,
                "the digests differ but the records agree: a value outside the records differs");
}

std::optional<FirstDifference> firstDifference(const OnboardRecord& record,
                                               const OnboardRecord& other) {
  Walk walk;
  walkPixels(record, other, walk);
  walkInputs(record, other, walk);
  walkEdges(record, other, walk);
  const std::size_t both = std::min(record.iterations.size(), other.iterations.size());
  for (std::size_t i = 0; i < both; ++i)
    walkIteration(record.iterations[i], other.iterations[i], walk);
  walkEnd(record, other, walk);
  return walk.first();
}

void compareTemplates(const RecordedIteration& a, const RecordedIteration& b,
                      const ComparisonLimits& limits, IterationComparison& iteration_comparison) {
  if (!a.templates || !b.templates) return;
  std::map<std::pair<int, int>, const RecordedTemplate*> theirs;
  for (const RecordedTemplate& item : *b.templates) theirs[{item.x, item.y}] = &item;
  for (const RecordedTemplate& item : *a.templates) {
    const auto found = theirs.find({item.x, item.y});
    if (found == theirs.end() || !item.searched || !found->second->searched) continue;
    const RecordedTemplate& counterpart = *found->second;
    ++iteration_comparison.templates;
    const double apart = std::hypot(static_cast<double>(item.found_x) - counterpart.found_x,
                                    static_cast<double>(item.found_y) - counterpart.found_y);
    if (apart <= limits.found_px) ++iteration_comparison.found_alike;
    if (item.inlier || counterpart.inlier) ++iteration_comparison.inliers_either;
    if (item.inlier && counterpart.inlier) ++iteration_comparison.inliers_both;
  }
}

struct PosesApart {
  double translation_mm = 0.0;
  double rotation_mrad = 0.0;
  Vector6d xi = Vector6d::Zero();  ///< rotation rad, translation m; left, camera frame
};

PosesApart apart(const Pose& pose, const Pose& other) {
  PosesApart poses_apart;
  if (pose == other) return poses_apart;  // to the bit: the product of the two is not
  const Pose between = other * pose.inverse();
  poses_apart.xi << rotationLog(between.rotation), between.translation_m;
  poses_apart.rotation_mrad = kMilliradians * poses_apart.xi.head<3>().norm();
  poses_apart.translation_mm = kMillimetres * poses_apart.xi.tail<3>().norm();
  return poses_apart;
}

/// Root of xi' C^-1 xi / 6; nothing without a covariance that can be inverted.
std::optional<double> sigmasOf(const Vector6d& xi, const Matrix6d& covariance) {
  if (!covariance.allFinite() || covariance.isZero()) return {};
  const Eigen::LDLT<Matrix6d> factors(covariance);
  if (factors.info() != Eigen::Success || !factors.isPositive()) return {};
  const double squared = xi.dot(factors.solve(xi));
  return squared >= 0.0 && std::isfinite(squared) ? std::optional(std::sqrt(squared / 6.0))
                                                  : std::nullopt;
}

void compareIterations(const OnboardRecord& record, const OnboardRecord& other,
                       const ComparisonLimits& limits, RecordComparison& record_comparison) {
  const std::size_t both = std::min(record.iterations.size(), other.iterations.size());
  for (std::size_t i = 0; i < both; ++i) {
    IterationComparison comparison;
    const IterationTrace& trace = record.iterations[i].trace;
    comparison.index = trace.index;
    compareTemplates(record.iterations[i], other.iterations[i], limits, comparison);
    const PosesApart poses =
        apart(trace.camera_from_station, other.iterations[i].trace.camera_from_station);
    comparison.translation_mm = poses.translation_mm;
    comparison.rotation_mrad = poses.rotation_mrad;
    record_comparison.iterations.push_back(comparison);
  }
}

void compareEnds(const OnboardRecord& record, const OnboardRecord& other,
                 RecordComparison& record_comparison) {
  if (!record.end || !other.end) return;
  const PosesApart poses = apart(record.end->camera_from_station, other.end->camera_from_station);
  record_comparison.translation_mm = poses.translation_mm;
  record_comparison.rotation_mrad = poses.rotation_mrad;
  if (record.end->status == LocalizationStatus::kConverged &&
      other.end->status == LocalizationStatus::kConverged)
    record_comparison.pose_sigmas = sigmasOf(poses.xi, record.end->covariance);
}

std::string shareText(int part, int whole) {
  return percentText(static_cast<double>(part) / std::max(whole, 1));
}

/// Whether the first iterations of both runs started at one pose: from the seed. Candidates of a
/// search are refined on the pixels, and so differ with them.
bool startAlike(const OnboardRecord& record, const OnboardRecord& other) {
  return apart(record.iterations.front().trace.camera_from_station_before,
               other.iterations.front().trace.camera_from_station_before)
             .xi.norm() == 0.0;
}

/// The templates of the first iterations are those of one render where both start alike.
void holdToLimits(const OnboardRecord& record, const OnboardRecord& other,
                  const ComparisonLimits& limits, RecordComparison& record_comparison) {
  if (record.end && other.end && record.end->status != other.end->status)
    record_comparison.beyond.push_back(std::string("the runs ended as ") +
                                       versus(localizationStatusText(record.end->status),
                                              localizationStatusText(other.end->status)));
  if (record_comparison.pose_sigmas && *record_comparison.pose_sigmas > limits.pose_sigmas)
    record_comparison.beyond.push_back(
        "the final poses are " + std::to_string(*record_comparison.pose_sigmas) + " sigmas apart");
  if (record_comparison.iterations.empty() || !startAlike(record, other)) return;
  const IterationComparison& first = record_comparison.iterations.front();
  if (first.templates >= kLeastCounted && first.found_alike < limits.found_share * first.templates)
    record_comparison.beyond.push_back("only " + shareText(first.found_alike, first.templates) +
                                       " of the first iteration's templates have equal positions");
  if (first.inliers_either >= kLeastCounted &&
      first.inliers_both < limits.inlier_share * first.inliers_either)
    record_comparison.beyond.push_back("only " +
                                       shareText(first.inliers_both, first.inliers_either) +
                                       " of the first iteration's inliers are inliers of both");
}

/// Other pixels excuse other results, but not other options or another mesh.
void holdToSameInputs(const OnboardRecord& record, const OnboardRecord& other,
                      RecordComparison& record_comparison) {
  Walk walk;
  walkInputs(record, other, walk);
  if (!walk.first()) return;
  if (record.inputs && other.inputs &&
      (record.inputs->width != other.inputs->width ||
       record.inputs->height != other.inputs->height))
    record_comparison.beyond.push_back("the images are of different sizes");
  record_comparison.beyond.push_back("inputs other than the pixels differ: " + walk.first()->text);
}

/// A digest is over everything that a run was given and all that it came upon.
bool haveSameDigest(const OnboardRecord& record, const OnboardRecord& other) {
  return record.end && other.end && !record.end->digest.empty() &&
         record.end->digest == other.end->digest;
}

RunVerdict verdictOf(const RecordComparison& record_comparison, bool same_digest) {
  if (!record_comparison.first)
    return record_comparison.missing.empty() || same_digest ? RunVerdict::kEqual
                                                            : RunVerdict::kWithinLimits;
  const bool other_pixels = record_comparison.first->part == RunPart::kPixels;
  return other_pixels && record_comparison.beyond.empty() ? RunVerdict::kWithinLimits
                                                          : RunVerdict::kDifferent;
}

}  // namespace

RecordComparison compareRecords(const OnboardRecord& record, const OnboardRecord& other,
                                const ComparisonLimits& limits) {
  RecordComparison record_comparison;
  for (const std::string& text : record.missing)
    record_comparison.missing.push_back("first: " + text);
  for (const std::string& text : other.missing)
    record_comparison.missing.push_back("second: " + text);
  record_comparison.first = firstDifference(record, other);
  compareIterations(record, other, limits, record_comparison);
  compareEnds(record, other, record_comparison);
  holdToLimits(record, other, limits, record_comparison);
  if (record_comparison.first && record_comparison.first->part == RunPart::kPixels)
    holdToSameInputs(record, other, record_comparison);
  record_comparison.verdict = verdictOf(record_comparison, haveSameDigest(record, other));
  return record_comparison;
}

const char* runPartText(RunPart part) {
  constexpr const char* kTexts[] = {"pixels",  "mask",     "scene",   "camera",    "seed",
                                    "options", "edge map", "render",  "templates", "matches",
                                    "inliers", "pose",     "support", "end",       "digest"};
  return kTexts[static_cast<std::size_t>(part)];
}

std::string comparisonText(const RecordComparison& comparison) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(3);
  if (comparison.verdict == RunVerdict::kEqual)
    text << "equal to the bit\n";
  else if (comparison.verdict == RunVerdict::kDifferent)
    text << "different\n";
  else
    text << (comparison.first ? "different, but within the limits\n"
                              : "equal to the bit as far as the records reach\n");
  if (comparison.first)
    text << plainLine("first difference: " + std::string(runPartText(comparison.first->part)) +
                      ": " + comparison.first->text);
  for (const std::string& sentence : comparison.beyond)
    text << plainLine("beyond limits: " + sentence);
  for (const std::string& sentence : comparison.missing) text << plainLine("missing: " + sentence);
  if (comparison.verdict == RunVerdict::kEqual) return text.str();
  TextTable table(
      {"iteration", "templates", "found alike", "inliers either", "both", "apart mm", "mrad"});
  for (const IterationComparison& iteration_comparison : comparison.iterations)
    table.add({std::to_string(iteration_comparison.index + 1),
               std::to_string(iteration_comparison.templates),
               std::to_string(iteration_comparison.found_alike),
               std::to_string(iteration_comparison.inliers_either),
               std::to_string(iteration_comparison.inliers_both),
               fixedText(iteration_comparison.translation_mm, 3),
               fixedText(iteration_comparison.rotation_mrad, 3)});
  text << table.text();
  text << "final poses: " << comparison.translation_mm << " mm and " << comparison.rotation_mrad
       << " mrad apart";
  if (comparison.pose_sigmas) text << ", " << *comparison.pose_sigmas << " sigmas";
  text << "\n";
  return text.str();
}

}  // namespace boresight::sessions
