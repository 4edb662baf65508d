// SPDX-License-Identifier: Apache-2.0
#include "sessions/record/onboard_record.h"

#include <algorithm>
#include <bit>
#include <map>
#include <type_traits>

#include "core/record/record_hashes.h"
#include "sessions/run/problem.h"
#include "sessions/text/plain_text.h"

namespace boresight::sessions {
namespace {

RecordedInputs inputsOf(const LocalizationProblem& given, const LocalizerOptions& options) {
  const LocalizationProblem used = withoutUnusedInputs(given, options);
  return {recordInputs(used), given.image.width,
          given.image.height, given.camera_from_station_seed,
          given.uncertainty,  used.end_effector_in_camera_m};
}

RecordedOptions optionsOf(const LocalizerOptions& options, std::int32_t first_iteration) {
  RecordedOptions recorded{first_iteration, {}};
  LocalizerOptions::visitFields(options, [&recorded](const OptionInfo& info, const auto& field) {
    using Field = std::remove_cvref_t<decltype(field)>;
    RecordedOption& option = recorded.options.emplace_back();
    option.name = info.name;
    option.kind = optionKindOf<Field>();
    if constexpr (std::is_floating_point_v<Field>)
      option.bits = std::bit_cast<std::uint64_t>(static_cast<double>(field));
    else
      option.bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(field));
  });
  return recorded;
}

std::optional<RecordedEdges> edgesOf(const EdgeMapTrace& edges) {
  if (edges.level.front().words.empty()) return std::nullopt;
  EdgeMap map;
  for (std::size_t i = 0; i < map.level.size(); ++i) map.level[i] = edges.level[i].view();
  return RecordedEdges{edgeMapHash(map), edges.low_threshold, edges.high_threshold,
                       edges.edge_count};
}

std::optional<RecordHash> renderHashOf(const IterationTrace& run) {
  if (run.reached == Stage::kRender && run.status == LocalizationStatus::kFault)
    return RecordHash{};
  if (run.render.edges.words.empty()) return std::nullopt;
  return renderHash(run.render.view());
}

RecordedTemplate templateOf(const Template& item, const Match* match) {
  RecordedTemplate recorded;
  recorded.x = item.center_x;
  recorded.y = item.center_y;
  if (match == nullptr || !match->searched) return recorded;
  recorded.searched = true;
  recorded.at_border = match->at_border;
  recorded.found_x = static_cast<float>(match->x);
  recorded.found_y = static_cast<float>(match->y);
  recorded.score = static_cast<float>(whsScore(match->peak.counts, match->norms));
  if (match->peak.has_second)
    recorded.second_score = static_cast<float>(whsScore(match->peak.second_counts, match->norms));
  return recorded;
}

std::optional<std::vector<RecordedTemplate>> templatesOf(const IterationTrace& run) {
  const bool selected = run.kind == IterationKind::kMatch && run.reached >= Stage::kTemplates;
  if (!selected || (run.template_count > 0 && run.templates.empty())) return std::nullopt;
  std::vector<RecordedTemplate> recorded;
  for (std::size_t i = 0; i < run.templates.size(); ++i)
    recorded.push_back(
        templateOf(run.templates[i], i < run.matches.size() ? &run.matches[i] : nullptr));
  if (run.reached < Stage::kPose) return recorded;
  for (std::size_t c = 0; c < run.template_of.size() && c < run.pnp.inlier.size(); ++c)
    recorded[static_cast<std::size_t>(run.template_of[c])].inlier = run.pnp.inlier[c] != 0;
  return recorded;
}

/// A trace has the support of the pose that was judged last.
void takeSupport(const EdgeSupport& support, LocalizationStatus status, OnboardRecord& record) {
  bool taken = false;
  for (auto item = record.iterations.rbegin(); item != record.iterations.rend(); ++item) {
    const bool converged =
        item == record.iterations.rbegin() && status == LocalizationStatus::kConverged;
    const LocalizationStatus own = item->trace.status;
    const bool refused = own == LocalizationStatus::kNotSupported ||
                         own == LocalizationStatus::kBlurred ||
                         own == LocalizationStatus::kCameraMismatch;
    if (!converged && !refused) continue;
    if (taken)
      record.missing.push_back("the edge support of iteration " +
                               std::to_string(item->trace.index + 1));
    else
      item->support = support;
    taken = true;
  }
}

void noteWhatTheRunLacks(OnboardRecord& record) {
  if (!record.inputs) record.missing.push_back("the hashes of the inputs (only in the digest)");
  if (!record.edges) record.missing.push_back("the edges of the image");
  for (const RecordedIteration& recorded : record.iterations) {
    const std::string of = " of iteration " + std::to_string(recorded.trace.index + 1);
    if (!recorded.render_sha256) record.missing.push_back("the render" + of);
    if (recorded.trace.template_count > 0 && !recorded.templates)
      record.missing.push_back("the templates" + of);
  }
  if (!record.end) record.missing.push_back("how the run ended: it was halted");
}

std::string valueOf(const RecordedOption& option) { return formatText("%g", option.value()); }

/// False when the option is of another kind or its value out of range.
template <class Field>
bool assign(const OptionInfo& info, const RecordedOption& recorded, Field& field) {
  if (recorded.kind != optionKindOf<Field>()) return false;
  const double value = recorded.value();
  if (!(value >= info.minimum && value <= info.maximum)) return false;
  if constexpr (std::is_floating_point_v<Field>) {
    field = std::bit_cast<double>(recorded.bits);
  } else {
    if constexpr (std::is_enum_v<Field>)
      if (recorded.bits >= info.choices.size()) return false;
    field = static_cast<Field>(static_cast<std::int64_t>(recorded.bits));
  }
  return true;
}

LocalizerOptions optionsOf(const RecordedOptions& recorded, std::vector<std::string>& remarks) {
  std::map<std::string, const RecordedOption*> left;
  for (const RecordedOption& option : recorded.options) left[option.name] = &option;
  LocalizerOptions options = defaultProfile();
  LocalizerOptions::visitFields(options, [&](const OptionInfo& info, auto& field) {
    const auto found = left.find(info.name);
    if (found == left.end()) {
      remarks.push_back("The record lacks the option " + std::string(info.name) +
                        "; its default is used.");
      return;
    }
    if (!assign(info, *found->second, field))
      remarks.push_back("The option " + found->first + " was " + valueOf(*found->second) +
                        " on board, which this program does not accept; its default is used.");
    left.erase(found);
  });
  for (const auto& [name, option] : left)
    remarks.push_back("The option " + name + " (" + valueOf(*option) +
                      " on board) is unknown to this program and left out.");
  return options;
}

}  // namespace

OnboardRecord recordOf(const LocalizationTrace& run, const LocalizationProblem* given) {
  OnboardRecord record;
  const std::size_t complete = run.complete();
  if (given != nullptr) record.inputs = inputsOf(*given, run.options);
  record.options.push_back(optionsOf(run.options, 0));
  for (const OptionChange& change : run.changes)
    if (static_cast<std::size_t>(change.iteration) < complete)
      record.options.push_back(optionsOf(change.options, change.iteration));
  if (run.edges) record.edges = edgesOf(*run.edges);
  for (std::size_t i = 0; i < complete; ++i) {
    const IterationTrace& iteration = *run.iterations[i];
    record.iterations.push_back(
        {iteration, renderHashOf(iteration), templatesOf(iteration), std::nullopt});
  }
  takeSupport(run.support, run.status, record);
  if (run.status != LocalizationStatus::kRunning)
    record.end = RecordedEnd{.status = run.status,
                             .fault = run.fault,
                             .iterations = static_cast<std::int32_t>(complete),
                             .attempts = run.attempts,
                             .camera_from_station = run.camera_from_station,
                             .covariance = run.covariance,
                             .digest = run.digest};
  noteWhatTheRunLacks(record);
  return record;
}

RecordedPlan planOf(const OnboardRecord& record) {
  RecordedPlan result;
  result.plan.options = defaultProfile();
  for (const RecordedOptions& recorded : record.options) {
    std::vector<std::string> remarks;
    const LocalizerOptions options = optionsOf(recorded, remarks);
    if (recorded.first_iteration == 0 && !result.has_options) {
      result.plan.options = options;
      result.has_options = true;
      result.remarks = remarks;  // those of changes are the same
    } else {
      result.plan.changes.push_back({recorded.first_iteration, options});
    }
  }
  if (!result.has_options)
    result.remarks.push_back("The record has no options; the defaults are used.");
  const std::string problem = planProblem(result.plan);
  if (!problem.empty()) {
    result.remarks.push_back("Options changed during the run are left out: " + problem + ".");
    result.plan.changes.clear();
  }
  return result;
}

}  // namespace boresight::sessions
