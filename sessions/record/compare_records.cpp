// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/compare_records.h"

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

#include "core/accept/edge_support.h"
#include "core/localizer/workspace.h"
#include "sessions/text/plain_text.h"
#include "sessions/text/text_table.h"
#include "sessions/text/units.h"

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

std::string endedText(const RecordedEnd& end, const RecordedEnd& other) {
  return "the runs ended as " +
         versus(localizationStatusText(end.status), localizationStatusText(other.status));
}

using enum RunPart;

/// Compares two records part by part, and keeps the first difference.
class Walk {
 public:
  Walk(const OnboardRecord& record, const OnboardRecord& other) : record_(record), other_(other) {}

  std::optional<FirstDifference> all() {
    pixels();
    inputs();
    edges();
    const std::size_t both = std::min(record_.iterations.size(), other_.iterations.size());
    for (std::size_t i = 0; i < both; ++i) iteration(record_.iterations[i], other_.iterations[i]);
    end();
    return first_;
  }

  /// All inputs and options but the pixels.
  std::optional<FirstDifference> inputs() {
    if (record_.inputs && other_.inputs) {
      const RecordedInputs& a = *record_.inputs;
      const RecordedInputs& b = *other_.inputs;
      const auto uncertainty = [](const RecordedInputs& recorded) {
        const auto& [translation_m, rotation_rad, pivot_in_camera_m] = recorded.uncertainty;
        Eigen::Matrix<double, 9, 1> values;
        values << translation_m, rotation_rad, pivot_in_camera_m;
        return values;
      };
      compare(kMask, "the ignore masks", a.sha256.ignore, b.sha256.ignore);
      compare(kScene, "the meshes", a.sha256.scene, b.sha256.scene);
      compare(kCamera, "the cameras", a.sha256.camera, b.sha256.camera);
      compare(kSeed, "the seeds", a.camera_from_station_seed, b.camera_from_station_seed);
      compare(kSeed, "the uncertainties of the seeds", uncertainty(a), uncertainty(b));
      compare(kSeed, "the end effectors", a.end_effector_in_camera_m, b.end_effector_in_camera_m);
    }
    const auto& a = record_.options;
    const auto& b = other_.options;
    if (!a.empty() && !b.empty()) options(a.front(), b.front());
    for (std::size_t i = 1; i < std::min(a.size(), b.size()); ++i) {
      iteration_ = a[i].first_iteration;
      compare(kOptions, "options that change during the run", a[i], b[i]);
    }
    iteration_ = -1;
    return first_;
  }

 private:
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

  void pixels() {
    if (!record_.inputs || !other_.inputs) return;
    const auto image = [](const RecordedInputs& recorded) {
      return std::tuple(recorded.width, recorded.height, recorded.sha256.pixels);
    };
    compare(kPixels, "the pixels", image(*record_.inputs), image(*other_.inputs));
  }

  void options(const RecordedOptions& recorded, const RecordedOptions& other) {
    std::map<std::string, std::array<const RecordedOption*, 2>> by_name;
    for (const RecordedOption& option : recorded.options) by_name[option.name][0] = &option;
    for (const RecordedOption& option : other.options) by_name[option.name][1] = &option;
    for (const auto& [name, values] : by_name) {
      const auto& [a, b] = values;
      if (a == nullptr || b == nullptr)
        differ(kOptions, "only one run has the option " + name);
      else if (!(*a == *b))
        differ(kOptions, "the option " + name + " is " + versus(a->value(), b->value()));
    }
  }

  void edges() {
    if (!record_.edges || !other_.edges) return;
    const RecordedEdges& a = *record_.edges;
    const RecordedEdges& b = *other_.edges;
    compare(kEdges, "the lower edge thresholds", a.low_threshold, b.low_threshold);
    compare(kEdges, "the upper edge thresholds", a.high_threshold, b.high_threshold);
    compare(kEdges, "the image's edge pixels", a.edge_count, b.edge_count);
    compare(kEdges, "the positions of the image's edges", a.sha256, b.sha256);
  }

  void templates(const RecordedIteration& recorded, const RecordedIteration& other) {
    compare(kTemplates, "the numbers of templates", recorded.trace.template_count,
            other.trace.template_count);
    if (!recorded.templates || !other.templates) return;
    using Item = RecordedTemplate;
    const auto each = [&](RunPart part, auto&& value, auto&& text) {
      const std::size_t count = std::min(recorded.templates->size(), other.templates->size());
      for (std::size_t i = 0; i < count; ++i) {
        const Item& a = (*recorded.templates)[i];
        const Item& b = (*other.templates)[i];
        if (value(a) == value(b)) continue;
        differ(part, "template " + std::to_string(i + 1) + text(a, b), static_cast<int>(i));
      }
    };
    each(
        kTemplates, [](const Item& item) { return std::pair(item.x, item.y); },
        [](const Item&, const Item&) { return " was cut at different positions"; });
    each(
        kMatches,
        [](const Item& item) {
          return std::tuple(item.searched, item.at_border, item.found_x, item.found_y, item.score,
                            item.second_score);
        },
        [](const Item& a, const Item& b) {
          return " has different matches, with scores " + versus(a.score, b.score);
        });
    each(
        kInliers, [](const Item& item) { return item.inlier; },
        [](const Item&, const Item&) { return " is an inlier in one run only"; });
  }

  void iteration(const RecordedIteration& recorded, const RecordedIteration& other) {
    const IterationTrace& a = recorded.trace;
    const IterationTrace& b = other.trace;
    iteration_ = a.index;
    compare(kPose, "the poses before", a.camera_from_station_before, b.camera_from_station_before);
    compare(kRender, "the kinds", a.kind, b.kind);
    compare(kRender, "the levels", a.level, b.level);
    compare(kRender, "the rendered edge pixels", a.edge_pixel_count, b.edge_pixel_count);
    if (recorded.render_sha256 && other.render_sha256)
      compare(kRender, "the renders", *recorded.render_sha256, *other.render_sha256);
    templates(recorded, other);
    compare(kMatches, "the searched templates", a.searched_count, b.searched_count);
    compare(kMatches, "the matches", a.correspondence_count, b.correspondence_count);
    compare(kInliers, "the inliers", a.pnp.inlier_count, b.pnp.inlier_count);
    compare(kInliers, "the edge points used", a.refinement.used_count, b.refinement.used_count);
    compare(kPose, "the poses after", a.camera_from_station, b.camera_from_station);
    compare(kPose, "the states after", std::pair(a.status, a.reached),
            std::pair(b.status, b.reached));
    if (!recorded.support || !other.support) return;
    const auto counts = [](const EdgeSupport& support) {
      const auto& [rendered, covered, displaced, displaced_covered, seen, explained,
                   displaced_explained] = support;
      return std::array{rendered, covered,   displaced,          displaced_covered,
                        seen,     explained, displaced_explained};
    };
    compare(kSupport, "the edge supports", counts(*recorded.support), counts(*other.support));
  }

  void end() {
    iteration_ = -1;
    if (!record_.end || !other_.end) return;
    const RecordedEnd& a = *record_.end;
    const RecordedEnd& b = *other_.end;
    if (record_.whole() && other_.whole())
      compare(kEnd, "the numbers of iterations", record_.iterations.size(),
              other_.iterations.size());
    if (a.status != b.status || a.fault != b.fault) differ(kEnd, endedText(a, b));
    compare(kEnd, "the final poses", a.camera_from_station, b.camera_from_station);
    compare(kEnd, "the final covariances", a.covariance, b.covariance);
    if (a.digest != b.digest)
      differ(kDigest,
             "the digests differ but the records agree: a value outside the records differs");
  }

  const OnboardRecord& record_;
  const OnboardRecord& other_;
  std::optional<FirstDifference> first_;
  int iteration_ = -1;  ///< index of the iteration that is compared; -1: none
};

void compareTemplates(const RecordedIteration& a, const RecordedIteration& b,
                      const ComparisonLimits& limits, IterationComparison& comparison) {
  if (!a.templates || !b.templates) return;
  std::map<std::pair<int, int>, const RecordedTemplate*> theirs;
  for (const RecordedTemplate& item : *b.templates) theirs[{item.x, item.y}] = &item;
  for (const RecordedTemplate& item : *a.templates) {
    const auto found = theirs.find({item.x, item.y});
    if (found == theirs.end() || !item.searched || !found->second->searched) continue;
    const RecordedTemplate& counterpart = *found->second;
    ++comparison.templates;
    const double apart = std::hypot(static_cast<double>(item.found_x) - counterpart.found_x,
                                    static_cast<double>(item.found_y) - counterpart.found_y);
    if (apart <= limits.found_px) ++comparison.found_alike;
    if (item.inlier || counterpart.inlier) ++comparison.inliers_either;
    if (item.inlier && counterpart.inlier) ++comparison.inliers_both;
  }
}

/// perturbationBetween, exactly zero for poses with the same bits.
Vector6d exactPerturbation(const Pose& from, const Pose& to) {
  if (from == to) return Vector6d::Zero();
  return perturbationBetween(from, to);
}

/// exactPerturbation to the equivalent of the other pose.
Vector6d apartBy(const Pose& pose, const Pose& other, const ComparisonLimits& limits) {
  return exactPerturbation(pose, limits.equivalent ? limits.equivalent(other, pose) : other);
}

/// `comparison` is of an iteration, or of two runs.
template <class Comparison>
void setDistance(const Vector6d& xi, Comparison& comparison) {
  comparison.rotation_mrad = kMilliradians * xi.head<3>().norm();
  comparison.translation_mm = kMillimetres * xi.tail<3>().norm();
}

/// Root of xi' C^-1 xi / 6; nothing without a covariance that can be inverted.
std::optional<double> mahalanobisSigmas(const Vector6d& xi, const Matrix6d& covariance) {
  if (!covariance.allFinite() || covariance.isZero()) return {};
  const Eigen::LDLT<Matrix6d> factors(covariance);
  if (factors.info() != Eigen::Success || !factors.isPositive()) return {};
  const double squared = xi.dot(factors.solve(xi));
  return squared >= 0.0 && std::isfinite(squared) ? std::optional(std::sqrt(squared / 6.0))
                                                  : std::nullopt;
}

void compareIterations(const OnboardRecord& record, const OnboardRecord& other,
                       const ComparisonLimits& limits, RecordComparison& comparison) {
  const std::size_t both = std::min(record.iterations.size(), other.iterations.size());
  for (std::size_t i = 0; i < both; ++i) {
    IterationComparison& compared = comparison.iterations.emplace_back();
    const IterationTrace& trace = record.iterations[i].trace;
    compared.index = trace.index;
    compareTemplates(record.iterations[i], other.iterations[i], limits, compared);
    setDistance(
        apartBy(trace.camera_from_station, other.iterations[i].trace.camera_from_station, limits),
        compared);
  }
}

void compareEnds(const OnboardRecord& record, const OnboardRecord& other,
                 const ComparisonLimits& limits, RecordComparison& comparison) {
  comparison.inputs_compared =
      record.inputs && other.inputs && !record.options.empty() && !other.options.empty();
  comparison.ends_compared = record.end && other.end;
  if (!comparison.ends_compared) return;
  const Vector6d xi =
      apartBy(record.end->camera_from_station, other.end->camera_from_station, limits);
  comparison.by_symmetry = static_cast<bool>(limits.equivalent);
  setDistance(xi, comparison);
  if (record.end->status == LocalizationStatus::kConverged &&
      other.end->status == LocalizationStatus::kConverged)
    comparison.pose_sigmas = mahalanobisSigmas(xi, record.end->covariance);
}

/// Whether the first iterations of both runs started at one pose: from the seed. Candidates of a
/// search are refined on the pixels, and so differ with them.
bool startAlike(const OnboardRecord& record, const OnboardRecord& other) {
  return exactPerturbation(record.iterations.front().trace.camera_from_station_before,
                           other.iterations.front().trace.camera_from_station_before)
             .norm() == 0.0;
}

/// The templates of the first iterations are those of one render where both start alike.
void holdToLimits(const OnboardRecord& record, const OnboardRecord& other,
                  const ComparisonLimits& limits, RecordComparison& comparison) {
  if (record.end && other.end && record.end->status != other.end->status)
    comparison.beyond.push_back(endedText(*record.end, *other.end));
  if (comparison.pose_sigmas && *comparison.pose_sigmas > limits.pose_sigmas)
    comparison.beyond.push_back("the final poses are " + threeDigits(*comparison.pose_sigmas) +
                                " sigmas apart");
  if (comparison.iterations.empty() || !startAlike(record, other)) return;
  const IterationComparison& first = comparison.iterations.front();
  if (first.templates >= kLeastCounted && first.found_alike < limits.found_share * first.templates)
    comparison.beyond.push_back("only " + percentText(shareOf(first.found_alike, first.templates)) +
                                " of the first iteration's templates have equal positions");
  if (first.inliers_either >= kLeastCounted &&
      first.inliers_both < limits.inlier_share * first.inliers_either)
    comparison.beyond.push_back("only " +
                                percentText(shareOf(first.inliers_both, first.inliers_either)) +
                                " of the first iteration's inliers are inliers of both");
}

/// Other pixels excuse other results, but not other options or another mesh.
void holdToSameInputs(const OnboardRecord& record, const OnboardRecord& other,
                      RecordComparison& comparison) {
  const auto first = Walk(record, other).inputs();
  if (!first) return;
  if (record.inputs && other.inputs &&
      (record.inputs->width != other.inputs->width ||
       record.inputs->height != other.inputs->height))
    comparison.beyond.push_back("the images are of different sizes");
  comparison.beyond.push_back("inputs other than the pixels differ: " + first->text);
}

/// A digest is over everything that a run was given and all that it came upon.
bool haveSameDigest(const OnboardRecord& record, const OnboardRecord& other) {
  return record.end && other.end && !record.end->digest.empty() &&
         record.end->digest == other.end->digest;
}

RunVerdict verdictOf(const RecordComparison& comparison, bool same_digest) {
  if (!comparison.inputs_compared && !comparison.ends_compared && comparison.iterations.empty())
    return RunVerdict::kUndecided;
  if (!comparison.first)
    return comparison.missing.empty() || same_digest ? RunVerdict::kEqual
                                                     : RunVerdict::kWithinLimits;
  const bool other_pixels = comparison.first->part == kPixels;
  return other_pixels && comparison.beyond.empty() ? RunVerdict::kWithinLimits
                                                   : RunVerdict::kDifferent;
}

}  // namespace

RecordComparison compareRecords(const OnboardRecord& record, const OnboardRecord& other,
                                const ComparisonLimits& limits) {
  RecordComparison comparison;
  for (const std::string& text : record.missing) comparison.missing.push_back("first: " + text);
  for (const std::string& text : other.missing) comparison.missing.push_back("second: " + text);
  comparison.first = Walk(record, other).all();
  compareIterations(record, other, limits, comparison);
  compareEnds(record, other, limits, comparison);
  holdToLimits(record, other, limits, comparison);
  if (comparison.first && comparison.first->part == kPixels)
    holdToSameInputs(record, other, comparison);
  comparison.verdict = verdictOf(comparison, haveSameDigest(record, other));
  return comparison;
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
  else if (comparison.verdict == RunVerdict::kUndecided)
    text << "not comparable: no part of a run is in both records\n";
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
  for (const IterationComparison& iteration : comparison.iterations)
    table.add({std::to_string(iteration.index + 1), std::to_string(iteration.templates),
               std::to_string(iteration.found_alike), std::to_string(iteration.inliers_either),
               std::to_string(iteration.inliers_both), fixedText(iteration.translation_mm, 3),
               fixedText(iteration.rotation_mrad, 3)});
  if (!comparison.iterations.empty()) text << table.text();
  if (!comparison.ends_compared) return text.str();
  text << "final poses: " << comparison.translation_mm << " mm and " << comparison.rotation_mrad
       << " mrad apart";
  if (comparison.pose_sigmas) text << ", " << *comparison.pose_sigmas << " sigmas";
  if (comparison.by_symmetry) text << ", by the declared symmetries";
  text << "\n";
  return text.str();
}

}  // namespace boresight::sessions
