// SPDX-License-Identifier: Apache-2.0
#include "app/python/module.h"

#include <nlohmann/json.hpp>

#include "sessions/io/files/errors.h"
#include "sessions/io/json/config_file.h"
#include "sessions/version.h"

namespace boresight::python {

Eigen::Matrix4d matrixOf(const Pose& pose) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = pose.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = pose.translation_m;
  return matrix;
}

Pose poseOf(const Eigen::Matrix4d& matrix) {
  Pose pose;
  double deviation = 0.0;
  const bool affine = matrix.row(3) == Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0);
  if (!affine || poseFromMatrix(matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>(), pose,
                                deviation) != Status::kOk)
    throw py::value_error("not a rigid transform: a rotation, a translation (m) and 0 0 0 1");
  return pose;
}

py::object pythonOf(const nlohmann::ordered_json& json) {
  return py::module_::import("json").attr("loads")(json.dump());
}

}  // namespace boresight::python

PYBIND11_MODULE(boresight, module) {
  namespace python = boresight::python;
  module.doc() =
      "Localizes a camera relative to a known object from one image, a coarse mesh and a seed.\n\n"
      "Poses are 4x4 arrays named a_from_b, in metres; the camera frame is x right, y down, z "
      "forward; pixel centres are integers. Results equal those of the program whs, to the bit.";
  module.attr("__version__") = boresight::sessions::kVersion;
  pybind11::register_exception<boresight::sessions::InputError>(module, "InputError",
                                                                PyExc_ValueError);
  pybind11::register_exception<boresight::sessions::OptionError>(module, "OptionError",
                                                                 PyExc_ValueError);
  python::addInputs(module);
  python::addRun(module);
  python::addResults(module);
}
