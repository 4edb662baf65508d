// SPDX-License-Identifier: Apache-2.0
// Shared by the parts of the Python module. Poses are 4x4 arrays, a_from_b; arrays are copies.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <nlohmann/json_fwd.hpp>

#include "core/geometry/pose.h"
#include "sessions/session/case_run.h"
#include "sessions/trace/trace.h"

namespace boresight::python {

namespace py = pybind11;

/// A case whose files were read.
struct Case {
  std::shared_ptr<const sessions::LoadedCase> loaded;
  std::optional<LocalizerOptions> options = {};  ///< of the session that it is from
};

/// A finished run together with its case.
struct Run {
  std::shared_ptr<const sessions::LoadedCase> loaded;
  sessions::LocalizationTrace trace;
};

Eigen::Matrix4d matrixOf(const Pose& pose);
/// ValueError unless it is a rigid transform.
Pose poseOf(const Eigen::Matrix4d& matrix);
/// Converts JSON to dict, list, float, str, ...
py::object pythonOf(const nlohmann::ordered_json& json);
/// An array of a member of each element.
template <class Value, class Range, class Member>
py::array_t<Value> column(const Range& range, Member&& member) {
  py::array_t<Value> array(static_cast<py::ssize_t>(std::size(range)));
  Value* value = array.mutable_data();
  for (const auto& item : range) *value++ = static_cast<Value>(member(item));
  return array;
}

/// Salient edge pixels as arrays: "x", "y" (px), "depth_m", normals, "offset_px", "kind", "edges".
py::dict renderDict(const sessions::RenderTrace& render);

void addInputs(py::module_& module);
void addRun(py::module_& module);
void addResults(py::module_& module);

}  // namespace boresight::python
