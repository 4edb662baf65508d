// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/compare_records.h"
#include "sessions/text/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>

#include <Eigen/Cholesky>

#include "core/localizer/workspace.h"

namespace boresight::sessions {
namespace {

using Difference = std::optional<FirstDifference>;

/// A share of fewer than these says little.
constexpr int kLeastCounted = 10;

Difference differs(RunPart part, const std::string& text) {
  return FirstDifference{part, -1, -1, text};
}

/// In one iteration, and in one of its templates where `item` is not -1.
Difference differs(RunPart part, const RecordedIteration& iteration, const std::string& text,
                   int item = -1) {
  const std::string place = "in iteration " + std::to_string(iteration.index + 1);
  return FirstDifference{part, iteration.index, item, text + " " + place};
}

template <class Value>
std::string versus(const Value& one, const Value& other) {
  std::ostringstream text;
  text.precision(9);
  text << one << " and " << other;
  return text.str();
}

bool isSame(const SeedUncertainty& a, const SeedUncertainty& b) {
  return a.translation_m == b.translation_m && a.rotation_rad == b.rotation_rad &&
         a.pivot_in_camera_m == b.pivot_in_camera_m;
}

bool isSame(const EdgeSupport& a, const EdgeSupport& b) {
  const auto counts = [](const EdgeSupport& support) {
    return std::array{support.rendered,           support.covered, support.displaced,
                      support.displaced_covered,  support.seen,    support.explained,
                      support.displaced_explained};
  };
  return counts(a) == counts(b);
}

Difference pixelsDifference(const OnboardRecord& one, const OnboardRecord& other) {
  if (!one.inputs || !other.inputs) return {};
  const RecordedInputs& a = *one.inputs;
  const RecordedInputs& b = *other.inputs;
  if (a.width != b.width || a.height != b.height || a.sha256.pixels != b.sha256.pixels)
    return differs(RunPart::kPixels, "the runs saw different pixels");
  return {};
}

/// Of everything but the pixels.
Difference inputsDifference(const OnboardRecord& one, const OnboardRecord& other) {
  if (!one.inputs || !other.inputs) return {};
  const RecordedInputs& a = *one.inputs;
  const RecordedInputs& b = *other.inputs;
  if (a.sha256.ignore != b.sha256.ignore)
    return differs(RunPart::kMask, "the runs ignored different pixels");
  if (a.sha256.scene != b.sha256.scene)
    return differs(RunPart::kScene, "the runs had different meshes");
  if (a.sha256.camera != b.sha256.camera)
    return differs(RunPart::kCamera, "the runs had different cameras");
  if (!(a.camera_from_station_seed == b.camera_from_station_seed &&
        isSame(a.uncertainty, b.uncertainty)))
    return differs(RunPart::kSeed, "the runs started from different seeds");
  return {};
}

/// The first option that differs by name or value.
Difference optionsDifference(const OnboardRecord& one, const OnboardRecord& other) {
  if (one.options.empty() || other.options.empty()) return {};
  const RecordedOptions& a = one.options.front();
  const RecordedOptions& b = other.options.front();
  std::map<std::string, RecordedOption> theirs;
  for (const RecordedOption& option : b.options) theirs.emplace(option.name, option);
  for (const RecordedOption& option : a.options) {
    const auto found = theirs.find(option.name);
    if (found == theirs.end())
      return differs(RunPart::kOptions, "only one run has the option " + option.name);
    if (!(found->second == option))
      return differs(RunPart::kOptions, "the option " + option.name + " is " +
                                            versus(option.value(), found->second.value()));
    theirs.erase(found);
  }
  if (!theirs.empty())
    return differs(RunPart::kOptions, "only one run has the option " + theirs.begin()->first);
  const std::size_t both = std::min(one.options.size(), other.options.size());
  for (std::size_t i = 1; i < both; ++i)
    if (!(one.options[i] == other.options[i]))
      return FirstDifference{RunPart::kOptions, one.options[i].first_iteration, -1,
                             "options were changed differently on the way"};
  return {};
}

Difference edgesDifference(const OnboardRecord& one, const OnboardRecord& other) {
  if (!one.edges || !other.edges) return {};
  const RecordedEdges& a = *one.edges;
  const RecordedEdges& b = *other.edges;
  if (a.low_threshold != b.low_threshold || a.high_threshold != b.high_threshold)
    return differs(RunPart::kEdges, "the upper thresholds of the image's edges are " +
                                        versus(a.high_threshold, b.high_threshold));
  if (a.edge_count != b.edge_count)
    return differs(RunPart::kEdges,
                   "the image's edge pixels are " + versus(a.edge_count, b.edge_count));
  if (a.sha256 != b.sha256)
    return differs(RunPart::kEdges, "the image's edges lie at different pixels");
  return {};
}

Difference renderDifference(const RecordedIteration& a, const RecordedIteration& b) {
  if (!(a.camera_from_station_before == b.camera_from_station_before))
    return differs(RunPart::kPose, a, "the poses before it differ");
  if (a.level != b.level || a.kind != b.kind)
    return differs(RunPart::kRender, a, "the kinds or levels differ");
  if (a.edge_pixels != b.edge_pixels)
    return differs(RunPart::kRender, a,
                   "the rendered edge pixels are " + versus(a.edge_pixels, b.edge_pixels));
  if (a.render_sha256 && b.render_sha256 && *a.render_sha256 != *b.render_sha256)
    return differs(RunPart::kRender, a, "the renders differ");
  return {};
}

/// The first of both runs' templates that `same` does not hold for, or -1.
template <class Same>
int firstTemplate(const RecordedIteration& a, const RecordedIteration& b, Same&& same) {
  const std::size_t count = std::min(a.templates->size(), b.templates->size());
  for (std::size_t i = 0; i < count; ++i)
    if (!same((*a.templates)[i], (*b.templates)[i])) return static_cast<int>(i);
  return -1;
}

Difference templatesDifference(const RecordedIteration& a, const RecordedIteration& b) {
  using Item = RecordedTemplate;
  if (a.templates_count != b.templates_count)
    return differs(RunPart::kTemplates, a,
                   "the templates are " + versus(a.templates_count, b.templates_count));
  if (!a.templates || !b.templates) return {};
  const auto name = [](int item) { return "template " + std::to_string(item + 1); };
  const int moved =
      firstTemplate(a, b, [](const Item& s, const Item& t) { return s.x == t.x && s.y == t.y; });
  if (moved >= 0)
    return differs(RunPart::kTemplates, a, name(moved) + " was taken at different places", moved);
  const int found = firstTemplate(a, b, [](const Item& s, const Item& t) {
    return s.searched == t.searched && s.at_border == t.at_border && s.found_x == t.found_x &&
           s.found_y == t.found_y && s.score == t.score && s.second_score == t.second_score;
  });
  if (found >= 0) {
    const auto place = static_cast<std::size_t>(found);
    return differs(RunPart::kMatches, a,
                   name(found) + " was found differently, with scores " +
                       versus((*a.templates)[place].score, (*b.templates)[place].score) + ",",
                   found);
  }
  const int inlier =
      firstTemplate(a, b, [](const Item& s, const Item& t) { return s.inlier == t.inlier; });
  if (inlier >= 0)
    return differs(RunPart::kInliers, a, name(inlier) + " is an inlier in one run only,", inlier);
  return {};
}

Difference solutionDifference(const RecordedIteration& a, const RecordedIteration& b) {
  if (a.searched != b.searched || a.correspondences != b.correspondences)
    return differs(RunPart::kMatches, a,
                   "the matches are " + versus(a.correspondences, b.correspondences));
  if (a.inliers != b.inliers || a.refinement_used != b.refinement_used)
    return differs(RunPart::kInliers, a,
                   "the inliers are " + versus(a.inliers, b.inliers) + ", the edge places used " +
                       versus(a.refinement_used, b.refinement_used) + ",");
  if (!(a.camera_from_station == b.camera_from_station) || a.status != b.status ||
      a.reached != b.reached)
    return differs(RunPart::kPose, a, "the poses or their states differ after it,");
  if (a.support && b.support && !isSame(*a.support, *b.support))
    return differs(RunPart::kSupport, a, "the edge support differs");
  return {};
}

Difference iterationDifference(const RecordedIteration& a, const RecordedIteration& b) {
  if (Difference found = renderDifference(a, b)) return found;
  if (Difference found = templatesDifference(a, b)) return found;
  return solutionDifference(a, b);
}

Difference endDifference(const OnboardRecord& one, const OnboardRecord& other) {
  const bool both = one.end && other.end;
  if (both && one.iterations.size() != other.iterations.size() && one.whole() && other.whole())
    return differs(
        RunPart::kEnd,
        "the runs have " + versus(one.iterations.size(), other.iterations.size()) + " iterations");
  if (!both) return {};
  const RecordedEnd& a = *one.end;
  const RecordedEnd& b = *other.end;
  if (a.status != b.status || a.fault != b.fault)
    return differs(RunPart::kEnd,
                   std::string("the runs ended as ") +
                       versus(localizationStatusText(a.status), localizationStatusText(b.status)));
  if (!(a.camera_from_station == b.camera_from_station) || a.covariance != b.covariance)
    return differs(RunPart::kEnd, "the final poses or covariances differ");
  if (a.digest != b.digest)
    return differs(RunPart::kDigest,
                   "the digests differ although the records do not: something that records leave "
                   "out differs");
  return {};
}

Difference firstDifference(const OnboardRecord& one, const OnboardRecord& other) {
  if (Difference found = pixelsDifference(one, other)) return found;
  if (Difference found = inputsDifference(one, other)) return found;
  if (Difference found = optionsDifference(one, other)) return found;
  if (Difference found = edgesDifference(one, other)) return found;
  const std::size_t both = std::min(one.iterations.size(), other.iterations.size());
  for (std::size_t i = 0; i < both; ++i)
    if (Difference found = iterationDifference(one.iterations[i], other.iterations[i]))
      return found;
  return endDifference(one, other);
}

void compareTemplates(const RecordedIteration& a, const RecordedIteration& b,
                      const ComparisonLimits& limits, IterationComparison& made) {
  if (!a.templates || !b.templates) return;
  std::map<std::pair<int, int>, const RecordedTemplate*> theirs;
  for (const RecordedTemplate& item : *b.templates) theirs[{item.x, item.y}] = &item;
  for (const RecordedTemplate& item : *a.templates) {
    const auto found = theirs.find({item.x, item.y});
    if (found == theirs.end() || !item.searched || !found->second->searched) continue;
    const RecordedTemplate& twin = *found->second;
    ++made.templates;
    const double apart = std::hypot(static_cast<double>(item.found_x) - twin.found_x,
                                    static_cast<double>(item.found_y) - twin.found_y);
    if (apart <= limits.found_px) ++made.found_alike;
    if (item.inlier || twin.inlier) ++made.inliers_either;
    if (item.inlier && twin.inlier) ++made.inliers_both;
  }
}

struct PosesApart {
  double translation_mm = 0.0;
  double rotation_mrad = 0.0;
  Vector6d xi = Vector6d::Zero();  ///< rotation rad, translation m; left, camera frame
};

PosesApart apart(const Pose& one, const Pose& other) {
  PosesApart made;
  if (one == other) return made;  // to the bit: the product of the two is not
  const Pose between = other * one.inverse();
  made.xi << rotationLog(between.rotation), between.translation_m;
  made.rotation_mrad = kMilliradians * made.xi.head<3>().norm();
  made.translation_mm = kMillimetres * made.xi.tail<3>().norm();
  return made;
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

void compareIterations(const OnboardRecord& one, const OnboardRecord& other,
                       const ComparisonLimits& limits, RecordComparison& made) {
  const std::size_t both = std::min(one.iterations.size(), other.iterations.size());
  for (std::size_t i = 0; i < both; ++i) {
    IterationComparison comparison;
    comparison.index = one.iterations[i].index;
    compareTemplates(one.iterations[i], other.iterations[i], limits, comparison);
    const PosesApart poses =
        apart(one.iterations[i].camera_from_station, other.iterations[i].camera_from_station);
    comparison.translation_mm = poses.translation_mm;
    comparison.rotation_mrad = poses.rotation_mrad;
    made.iterations.push_back(comparison);
  }
}

void compareEnds(const OnboardRecord& one, const OnboardRecord& other, RecordComparison& made) {
  if (!one.end || !other.end) return;
  const PosesApart poses = apart(one.end->camera_from_station, other.end->camera_from_station);
  made.translation_mm = poses.translation_mm;
  made.rotation_mrad = poses.rotation_mrad;
  if (one.end->status == LocalizationStatus::kConverged &&
      other.end->status == LocalizationStatus::kConverged)
    made.pose_sigmas = sigmasOf(poses.xi, one.end->covariance);
}

std::string percent(int part, int whole) {
  return std::to_string(static_cast<int>(std::lround(100.0 * part / std::max(whole, 1)))) + " %";
}

/// The first iteration is the one whose templates the same seed gives both runs.
void holdToLimits(const OnboardRecord& one, const OnboardRecord& other,
                  const ComparisonLimits& limits, RecordComparison& made) {
  if (one.end && other.end && one.end->status != other.end->status)
    made.beyond.push_back(
        std::string("the runs ended as ") +
        versus(localizationStatusText(one.end->status), localizationStatusText(other.end->status)));
  if (made.pose_sigmas && *made.pose_sigmas > limits.pose_sigmas)
    made.beyond.push_back("the final poses are " + std::to_string(*made.pose_sigmas) +
                          " sigmas apart");
  if (made.iterations.empty()) return;
  const IterationComparison& first = made.iterations.front();
  if (first.templates >= kLeastCounted && first.found_alike < limits.found_share * first.templates)
    made.beyond.push_back("only " + percent(first.found_alike, first.templates) +
                          " of the first iteration's templates were found alike");
  if (first.inliers_either >= kLeastCounted &&
      first.inliers_both < limits.inlier_share * first.inliers_either)
    made.beyond.push_back("only " + percent(first.inliers_both, first.inliers_either) +
                          " of the first iteration's inliers are inliers of both");
}

/// Other pixels excuse other results, but not other options or another mesh.
void holdToSameInputs(const OnboardRecord& one, const OnboardRecord& other,
                      RecordComparison& made) {
  Difference found = inputsDifference(one, other);
  if (!found) found = optionsDifference(one, other);
  if (!found) return;
  if (one.inputs && other.inputs &&
      (one.inputs->width != other.inputs->width || one.inputs->height != other.inputs->height))
    made.beyond.push_back("the images are of different sizes");
  made.beyond.push_back(std::string("not the pixels alone differ: ") + found->text);
}

/// A digest is over everything that a run was given and all that it came upon.
bool haveSameDigest(const OnboardRecord& one, const OnboardRecord& other) {
  return one.end && other.end && !one.end->digest.empty() && one.end->digest == other.end->digest;
}

RunVerdict verdictOf(const RecordComparison& made, bool same_digest) {
  if (!made.first)
    return made.missing.empty() || same_digest ? RunVerdict::kEqual : RunVerdict::kWithinLimits;
  const bool other_pixels = made.first->part == RunPart::kPixels;
  return other_pixels && made.beyond.empty() ? RunVerdict::kWithinLimits : RunVerdict::kDifferent;
}

}  // namespace

RecordComparison compareRecords(const OnboardRecord& one, const OnboardRecord& other,
                                const ComparisonLimits& limits) {
  RecordComparison made;
  for (const std::string& text : one.missing) made.missing.push_back("first: " + text);
  for (const std::string& text : other.missing) made.missing.push_back("second: " + text);
  made.first = firstDifference(one, other);
  compareIterations(one, other, limits, made);
  compareEnds(one, other, made);
  holdToLimits(one, other, limits, made);
  if (made.first && made.first->part == RunPart::kPixels) holdToSameInputs(one, other, made);
  made.verdict = verdictOf(made, haveSameDigest(one, other));
  return made;
}

}  // namespace boresight::sessions
