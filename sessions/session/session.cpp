// SPDX-License-Identifier: Apache-2.0
#include "sessions/session/session.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <span>

#include <nlohmann/json.hpp>

#include "core/base/digest.h"
#include "sessions/io/camera_file.h"
#include "sessions/io/errors.h"

namespace boresight::sessions {
namespace {

/// Feeds a canonical serialization: every value with its name, so that neighbours cannot be
/// confused.
class InputsDigest {
 public:
  void text(const char* name, const std::string& value) {
    writer_.tag(name);
    writer_.u64(value.size());
    writer_.bytes({reinterpret_cast<const std::uint8_t*>(value.data()), value.size()});
  }
  void number(const char* name, double value) {
    writer_.tag(name);
    writer_.f64(value);
  }
  template <class Vector>
  void vector(const char* name, const Vector& values) {
    writer_.tag(name);
    for (Eigen::Index i = 0; i < values.size(); ++i) writer_.f64(values[i]);
  }
  void pose(const char* name, const Pose& pose) {
    vector(name, pose.rotation.coeffs());
    vector(name, pose.translation_m);
  }
  std::string digest() const { return hexText(writer_.digest()).data(); }

 private:
  DigestWriter writer_;
};

void add(InputsDigest& digest, const MeshInput& part) {
  digest.text("part", part.sha256);
  digest.text("mesh_unit", part.source.mesh_unit);
  digest.pose("station_from_mesh", part.source.station_from_mesh);
  digest.number("normal_threshold_rad", part.source.part.normal_threshold_rad);
  digest.number("depth_threshold_m", part.source.part.depth_threshold_m);
  digest.number("match", part.source.part.match ? 1.0 : 0.0);
  if (part.source.albedo) digest.number("albedo", *part.source.albedo);
}

void add(InputsDigest& digest, const MaskStroke& stroke) {
  digest.number("stroke", static_cast<double>(stroke.kind));
  digest.number("erase", stroke.erase ? 1.0 : 0.0);
  digest.number("radius_px", stroke.radius_px);
  digest.number("level", stroke.level);
  digest.number("points", static_cast<double>(stroke.points.size()));
  for (const Eigen::Vector2d& point : stroke.points) digest.vector("point", point);
}

template <class Value>
bool sameOf(const std::string& id, const std::map<std::string, Value>& a,
            const std::map<std::string, Value>& b) {
  const auto in_a = a.find(id);
  const auto in_b = b.find(id);
  if (in_a == a.end() || in_b == b.end()) return (in_a == a.end()) == (in_b == b.end());
  return in_a->second == in_b->second;
}

bool sameDecision(const std::string& id, const Session& a, const Session& b) {
  const Decision* in_a = a.decisionOn(id);
  const Decision* in_b = b.decisionOn(id);
  return in_a && in_b ? *in_a == *in_b : in_a == in_b;
}

}  // namespace

const SessionCase* Session::findCase(const std::string& id) const {
  const SharedValue<SessionCase>* found = cases.find(id);
  return found == nullptr ? nullptr : &**found;
}

const Decision* Session::decisionOn(const std::string& case_id) const {
  return decisions.find(case_id);
}

const RunRecord* Session::lastRunOf(const std::string& case_id) const { return runs.find(case_id); }

void setTruth(SessionCase& one, const Pose& camera_from_station,
              const std::optional<Matrix6d>& covariance) {
  one.camera_from_station_truth = camera_from_station;
  one.truth_frame.reset();
  one.truth_covariance = covariance;
}

const SessionCase& knownCase(const Session& session, const std::string& case_id) {
  const SessionCase* found = session.findCase(case_id);
  if (found == nullptr) throw InputError("session", "cases", "there is no case '" + case_id + "'");
  return *found;
}

Session withChanged(const Session& session, const std::string& case_id,
                    const std::function<void(SessionCase&)>& change) {
  const SessionCase* found = session.findCase(case_id);
  if (found == nullptr) return session;
  SessionCase changed = *found;
  change(changed);
  return withCase(session, std::move(changed));
}

Session withCase(const Session& session, SessionCase changed) {
  Session next = session;
  const auto found = std::find_if(next.cases.begin(), next.cases.end(),
                                  [&](const auto& one) { return one->id == changed.id; });
  if (found != next.cases.end())
    *found = std::move(changed);
  else
    next.cases.push_back(std::move(changed));
  return next;
}

Session withoutCase(const Session& session, const std::string& case_id) {
  Session next = session;
  next.cases.eraseIf([&](const auto& one) { return one->id == case_id; });
  next.annotations.erase(case_id);
  next.passes.erase(case_id);
  next.decisions.eraseIf([&](const Decision& one) { return one.case_id == case_id; });
  next.runs.eraseIf([&](const RunRecord& run) { return run.case_id == case_id; });
  if (next.view.case_id == case_id) next.view = {};
  return next;
}

Session withAnnotation(const Session& session, const std::string& case_id, Annotation annotation) {
  Session next = session;
  if (annotation == Annotation())
    next.annotations.erase(case_id);
  else
    next.annotations.insert_or_assign(case_id, std::move(annotation));
  return next;
}

Session withPasses(const Session& session, const std::string& case_id, AnnotationPasses passes) {
  Session next = session;
  if (passes.empty())
    next.passes.erase(case_id);
  else
    next.passes.insert_or_assign(case_id, std::move(passes));
  return next;
}

Session withOptions(const Session& session, const std::string& profile,
                    const LocalizerOptions& options) {
  Session next = session;
  next.profile = profile;
  next.options = changedOptions(options, profileOptions(profile).value());
  std::sort(next.options.begin(), next.options.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  return next;
}

LocalizerOptions sessionOptions(const Session& session, const std::filesystem::path& file) {
  std::optional<LocalizerOptions> options = profileOptions(session.profile);
  if (!options)
    throw InputError(
        file, "profile",
        "there is no profile \"" + session.profile + "\"; there are: " + profileNames());
  Config config;
  config.file = file;
  config.profile = session.profile;
  config.options = session.options;
  applyConfig(*options, config);
  return *options;
}

LocalizerOptions caseOptions(const Session& session, const SessionCase& one,
                             const std::filesystem::path& file) {
  LocalizerOptions options = sessionOptions(session, file);
  if (options.templates.feature_size_m == 0.0 && one.feature_size_m)
    options.templates.feature_size_m = *one.feature_size_m;
  return options;
}

std::string inputsDigest(const SessionCase& one) {
  InputsDigest digest;
  digest.text("pixels", one.image.pixels_sha256);
  digest.text("camera", toJson(one.camera).dump());
  for (const MeshInput& part : one.parts) add(digest, part);
  digest.pose("seed", one.camera_from_station_seed);
  digest.vector("translation_m", one.uncertainty.translation_m);
  digest.vector("rotation_deg", one.uncertainty.rotation_deg);
  digest.number("pivot", static_cast<double>(one.uncertainty.pivot));
  digest.text("ignore", one.ignore ? one.ignore->sha256 : "");
  for (const MaskStroke& stroke : one.ignore_strokes) add(digest, stroke);
  return digest.digest();
}

Staleness stalenessOf(const RunRecord& run, const Session& session,
                      const std::filesystem::path& file) {
  const SessionCase* one = session.findCase(run.case_id);
  if (one == nullptr) return {true, false};
  const bool others_changed =
      run.together && run.together->inputs_sha256 != viewsDigest(session, casesOf(*run.together));
  return {others_changed || run.inputs_sha256 != inputsDigest(*one),
          run.options_sha256 != optionsDigest(caseOptions(session, *one, file))};
}

bool isUtcText(const std::string& text) {
  constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:ddZ";
  return text.size() == kForm.size() &&
         std::equal(text.begin(), text.end(), kForm.begin(), [](char c, char form) {
           return form == 'd' ? std::isdigit(static_cast<unsigned char>(c)) != 0 : c == form;
         });
}

bool isSha256Text(const std::string& text) {
  return text.size() == 64 && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

std::vector<std::string> changedCases(const Session& before, const Session& after) {
  std::vector<std::string> changed;
  for (const auto& one : after.cases) {
    const SessionCase* former = before.findCase(one->id);
    const bool same =
        former && *former == *one && sameOf(one->id, before.annotations, after.annotations) &&
        sameOf(one->id, before.passes, after.passes) && sameDecision(one->id, before, after);
    if (!same) changed.push_back(one->id);
  }
  return changed;
}

void StaleRuns::takeOptions(const Session& session) {
  if (profile_ == session.profile && options_ == session.options) return;
  profile_ = session.profile;
  options_ = session.options;
  options_digests_.clear();
}

bool StaleRuns::isStale(const RunRecord& run, const SharedValue<SessionCase>& one,
                        const Session& session, const std::filesystem::path& file) {
  // Of a run together the other cases count, too.
  if (run.together) return stalenessOf(run, session, file).stale();
  takeOptions(session);
  auto known = inputs_.find(one->id);
  if (known == inputs_.end() || !known->second.one.sharesWith(one))
    known = inputs_.insert_or_assign(one->id, Inputs{one, inputsDigest(*one)}).first;
  if (run.inputs_sha256 != known->second.digest) return true;
  std::string& options = options_digests_[one->feature_size_m.value_or(0.0)];
  if (options.empty()) options = optionsDigest(caseOptions(session, *one, file));
  return run.options_sha256 != options;
}

}  // namespace boresight::sessions
