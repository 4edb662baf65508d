// SPDX-License-Identifier: Apache-2.0
// Runs: every intermediate as arrays.
#include <nlohmann/json.hpp>

#include "app/python/module.h"
#include "sessions/evaluation/run_result.h"
#include "sessions/io/json/config_file.h"
#include "sessions/run/runner.h"
#include "sessions/trace/run_text.h"

namespace boresight::python {
namespace {

using sessions::IterationTrace;

py::array_t<bool> bitsOf(const sessions::BitMap& map) {
  py::array_t<bool> array({map.height, map.width});
  bool* value = array.mutable_data();
  const BitImage bits = map.view();
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) *value++ = bits.get(x, y);
  return array;
}

template <class Range, class Member>
py::array_t<double> vectors(const Range& range, int size, Member&& member) {
  py::array_t<double> array({static_cast<py::ssize_t>(std::size(range)), py::ssize_t{size}});
  double* value = array.mutable_data();
  for (const auto& item : range)
    for (int i = 0; i < size; ++i) *value++ = member(item)[i];
  return array;
}

py::dict templatesOf(const IterationTrace& iteration) {
  py::dict dict;
  const auto& items = iteration.templates;
  dict["side_px"] = iteration.template_side_px;
  dict["x"] = column<std::int32_t>(items, [](const Template& item) { return item.center_x; });
  dict["y"] = column<std::int32_t>(items, [](const Template& item) { return item.center_y; });
  dict["depth_m"] = column<float>(items, [](const Template& item) { return item.depth_m; });
  dict["point_in_station_m"] =
      vectors(items, 3, [](const Template& item) { return item.point_in_station_m; });
  return dict;
}

py::dict matchesOf(const IterationTrace& iteration) {
  py::dict dict;
  const auto& items = iteration.matches;
  dict["searched"] = column<bool>(items, [](const Match& item) { return item.searched; });
  dict["at_border"] = column<bool>(items, [](const Match& item) { return item.at_border; });
  dict["x"] = column<double>(items, [](const Match& item) { return item.x; });
  dict["y"] = column<double>(items, [](const Match& item) { return item.y; });
  dict["template"] = column<std::int32_t>(iteration.template_of, [](auto index) { return index; });
  dict["pixel"] =
      vectors(iteration.correspondences, 2, [](const Correspondence& item) { return item.pixel; });
  dict["inlier"] = column<bool>(iteration.pnp.inlier, [](auto inlier) { return inlier != 0; });
  dict["residual_px"] = column<double>(iteration.pnp.residual_px, [](double r) { return r; });
  return dict;
}

py::dict iterationOf(const IterationTrace& iteration) {
  py::dict dict;
  dict["kind"] = iteration.kind == IterationKind::kMatch ? "match" : "refine";
  dict["attempt"] = iteration.attempt;
  dict["level"] = iteration.level;
  dict["threshold_px"] = iteration.threshold_px;
  dict["camera_from_station_before"] = matrixOf(iteration.camera_from_station_before);
  dict["camera_from_station"] = matrixOf(iteration.camera_from_station);
  dict["correction_translation_m"] = iteration.correction_translation_m;
  dict["correction_rotation_rad"] = iteration.correction_rotation_rad;
  dict["rms_px"] = iteration.rms_px();
  dict["render"] = renderDict(iteration.render);
  dict["templates"] = templatesOf(iteration);
  dict["matches"] = matchesOf(iteration);
  return dict;
}

/// Those of the profile, or of the case's session where none is named; of the default profile
/// without a session.
LocalizerOptions optionsBefore(const Case& one, const std::optional<std::string>& profile) {
  if (!profile && one.options) return *one.options;
  const std::string name = profile.value_or("default");
  const auto known = sessions::profileOptions(name);
  if (!known) throw py::value_error("there is no profile " + name);
  return *known;
}

LocalizerOptions optionsOf(const Case& one, const std::optional<std::string>& profile,
                           const py::dict& changes) {
  LocalizerOptions options = optionsBefore(one, profile);
  sessions::Config config;
  config.file = "options";
  for (const auto& [name, value] : changes) {
    sessions::OptionValue option;
    if (py::isinstance<py::bool_>(value))
      option = value.cast<bool>();
    else if (py::isinstance<py::int_>(value))
      option = value.cast<std::int64_t>();
    else if (py::isinstance<py::float_>(value))
      option = value.cast<double>();
    else
      option = value.cast<std::string>();
    config.options.emplace_back(name.cast<std::string>(), option);
  }
  sessions::applyConfig(options, config);
  return sessions::withFeatureSize(options, one.loaded->source.feature_size_m);
}

Run localizeCase(const Case& one, const std::optional<std::string>& profile,
                 const py::dict& changes) {
  const LocalizerOptions options = optionsOf(one, profile, changes);
  const py::gil_scoped_release release;
  return {one.loaded, sessions::runCase(*one.loaded, sessions::RunPlan(options))};
}

py::array_t<bool> edgesOf(const Run& run, std::size_t level) {
  if (!run.trace.edges || level >= run.trace.edges->level.size())
    throw py::index_error("no such level");
  return bitsOf(run.trace.edges->level[level]);
}

py::list iterationsOf(const Run& run) {
  py::list list;
  for (const auto& iteration : run.trace.iterations) list.append(iterationOf(*iteration));
  return list;
}

}  // namespace

py::dict renderDict(const sessions::RenderTrace& render) {
  py::dict dict;
  const auto& pixels = render.pixels;
  dict["edges"] = bitsOf(render.edges);
  dict["x"] = column<std::int16_t>(pixels, [](const EdgePixel& pixel) { return pixel.x; });
  dict["y"] = column<std::int16_t>(pixels, [](const EdgePixel& pixel) { return pixel.y; });
  dict["depth_m"] = column<float>(pixels, [](const EdgePixel& pixel) { return pixel.depth_m; });
  dict["face"] = column<std::int32_t>(pixels, [](const EdgePixel& pixel) { return pixel.face; });
  dict["normal_x"] = column<float>(pixels, [](const EdgePixel& p) { return p.normal_x / 127.0F; });
  dict["normal_y"] = column<float>(pixels, [](const EdgePixel& p) { return p.normal_y / 127.0F; });
  dict["offset_px"] = column<float>(pixels, [](const EdgePixel& p) { return p.offset / 100.0F; });
  dict["kind"] = column<std::uint8_t>(pixels, [](const EdgePixel& pixel) { return pixel.kind; });
  return dict;
}

void addRun(py::module_& module) {
  py::class_<Run>(module, "Run", "A run with every intermediate.")
      .def_property_readonly("converged", [](const Run& run) { return run.trace.converged(); })
      .def_property_readonly(
          "status", [](const Run& run) { return localizationStatusText(run.trace.status); })
      .def_property_readonly(
          "explanation", [](const Run& run) { return sessions::explanation(run.trace); },
          "Why it did not converge; empty otherwise.")
      .def_property_readonly("digest", [](const Run& run) { return run.trace.digest; })
      .def_property_readonly(
          "camera_from_station",
          [](const Run& run) { return matrixOf(run.trace.camera_from_station); },
          "The seed unless it converged.")
      .def_property_readonly(
          "covariance", [](const Run& run) { return run.trace.covariance; },
          "(6, 6) over (rotation rad, translation m), left perturbation, camera frame.")
      .def_property_readonly("probability", [](const Run& run) { return run.trace.probability; })
      .def_property_readonly(
          "seconds", [](const Run& run) { return pythonOf(sessions::toJson(run.trace.seconds)); })
      .def_property_readonly("iterations", &iterationsOf, "A list of dicts of arrays.")
      .def("edges", &edgesOf, py::arg("level") = 0,
           "Canny edges of a level: (height, width) bool.");
  module.def("localize", &localizeCase, py::arg("case"), py::arg("profile") = std::nullopt,
             py::arg("options") = py::dict(),
             "Runs the localization with the options of the case's session, or of a profile; "
             "`options` by name, e.g. {\"loop.max_iterations\": 5}, change them.");
}

}  // namespace boresight::python
