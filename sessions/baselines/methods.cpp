// SPDX-License-Identifier: Apache-2.0
#include "sessions/baselines/methods.h"

#include <algorithm>
#include <stdexcept>

#include "sessions/baselines/matching_methods.h"

namespace boresight::sessions {
namespace {

template <ExternalFrames frames>
std::unique_ptr<MatchingMethod> makeExternalWith(const MethodSetup& setup) {
  return makeExternal(setup.matcher, setup.options.external, frames);
}

using Make = std::unique_ptr<MatchingMethod> (*)(const MethodSetup&);

/// The methods other than WHS.
struct NamedMethod {
  const char* name;
  Make make;
  bool external = false;
};
constexpr NamedMethod kMethods[] = {
    {"ncc", [](const MethodSetup& setup) { return makeNcc(setup.options.ncc); }},
    {"ssd", [](const MethodSetup& setup) { return makeSsd(setup.options.ssd); }},
    {"orb", [](const MethodSetup& setup) { return makeOrb(setup.options.orb); }},
    {"external", makeExternalWith<ExternalFrames::kWhole>, true},
    {"loftr-r", makeExternalWith<ExternalFrames::kWhole>, true},
    {"loftr-s", makeExternalWith<ExternalFrames::kSubframes>, true},
};

const NamedMethod* findMethod(const std::string& name) {
  for (const NamedMethod& method : kMethods)
    if (name == method.name) return &method;
  return nullptr;
}

}  // namespace

bool isMethod(const std::string& name) { return name == kWhs || findMethod(name) != nullptr; }

bool needsMatcher(const std::string& name) {
  const NamedMethod* method = findMethod(name);
  return method != nullptr && method->external;
}

std::string methodNames() {
  std::string names = kWhs;
  for (const NamedMethod& method : kMethods) names += std::string(", ") + method.name;
  return names;
}

LocalizationTrace Methods::localize(const std::string& method, const LocalizationProblem& problem,
                                    const LocalizerOptions& options, const RunSettings& settings,
                                    const std::stop_token& stop) {
  if (method == kWhs) return sessions::localize(problem, options, settings, stop);
  const NamedMethod* named = findMethod(method);
  if (named == nullptr) throw std::invalid_argument("there is no method \"" + method + "\"");
  std::unique_ptr<MatchingMethod> taken;
  {
    const std::lock_guard lock(mutex_);
    auto& idle = idle_[method];
    if (!idle.empty()) {
      taken = std::move(idle.back());
      idle.pop_back();
    }
  }
  if (!taken) taken = named->make(setup_);
  LocalizerOptions roomy = options;
  roomy.templates.count = std::max(options.templates.count, taken->capacity());
  RunSettings with_method = settings;
  with_method.method = taken.get();
  // One that fails is not used again.
  LocalizationTrace trace = sessions::localize(problem, roomy, with_method, stop);
  const std::lock_guard lock(mutex_);
  idle_[method].push_back(std::move(taken));
  return trace;
}

}  // namespace boresight::sessions
