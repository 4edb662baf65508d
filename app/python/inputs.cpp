// SPDX-License-Identifier: Apache-2.0
// Cases and sessions.
#include <nlohmann/json.hpp>

#include "app/python/module.h"
#include "sessions/io/cameras/camera_file.h"
#include "sessions/io/json/json_writer.h"
#include "sessions/session/session_document.h"
#include "sessions/session/session_file.h"
#include "sessions/session/session_maker.h"
#include "sessions/trace/scene_render.h"

namespace boresight::python {
namespace {

using Path = std::filesystem::path;

Case readCase(const Path& image, const Path& mesh, const std::string& mesh_unit, const Path& seed,
              const Path& camera, const std::vector<Path>& frames, const std::optional<Path>& truth,
              const std::optional<Path>& ignore) {
  sessions::CaseFiles files;
  files.image = image;
  files.camera = camera;
  files.transforms = frames;
  files.parts.resize(1);
  files.parts[0].mesh = mesh;
  files.parts[0].mesh_unit = mesh_unit;
  files.seed = seed;
  files.truth = truth;
  files.ignore = ignore;
  return {sessions::loadCase(sessions::makeCase(files).made)};
}

py::array_t<std::uint8_t> imageOf(const Case& one) {
  const sessions::GrayImage& image = one.loaded->image;
  py::array_t<std::uint8_t> array({image.height, image.width});
  std::copy(image.pixels.begin(), image.pixels.end(), array.mutable_data());
  return array;
}

std::optional<Eigen::Matrix4d> truthOf(const Case& one) {
  const auto& truth = one.loaded->source.camera_from_station_truth;
  if (!truth) return std::nullopt;
  return matrixOf(*truth);
}

py::array_t<float> verticesOf(const Case& one) {
  const auto& vertices = one.loaded->scene.vertices_in_station_m;
  py::array_t<float> array({static_cast<py::ssize_t>(vertices.size()), py::ssize_t{3}});
  float* value = array.mutable_data();
  for (const Eigen::Vector3f& vertex : vertices)
    for (int axis = 0; axis < 3; ++axis) *value++ = vertex[axis];
  return array;
}

py::array_t<std::int32_t> facesOf(const Case& one) {
  const auto& faces = one.loaded->scene.faces;
  py::array_t<std::int32_t> array({static_cast<py::ssize_t>(faces.size()), py::ssize_t{3}});
  std::int32_t* value = array.mutable_data();
  for (const Face& face : faces)
    for (const std::int32_t vertex : face.vertex) *value++ = vertex;
  return array;
}

py::dict renderEdges(const Case& one, const std::optional<Eigen::Matrix4d>& pose) {
  const sessions::LoadedCase& loaded = *one.loaded;
  const Pose camera_from_station = pose ? poseOf(*pose) : loaded.source.camera_from_station_seed;
  sessions::RenderTrace render;
  const Status status = [&] {
    const py::gil_scoped_release release;
    return sessions::renderScene(loaded.source.camera, loaded.scene.view(), camera_from_station,
                                 render);
  }();
  if (status != Status::kOk) throw py::value_error(statusText(status));
  return renderDict(render);
}

/// A session file that is read, and written again by write().
sessions::Session readSession(const Path& file) {
  const auto document = sessions::SessionDocument::open(file, sessions::Access::kReadOnly);
  document.requireNothingUnsaved();
  return document.session();
}

Case caseOf(const sessions::Session& session, const std::string& id) {
  const sessions::SessionCase* found = session.findCase(id);
  if (found == nullptr) throw py::key_error("no case " + id);
  return {sessions::loadCase(*found), sessions::sessionOptions(session, "session")};
}

std::vector<std::string> caseIds(const sessions::Session& session) {
  std::vector<std::string> ids;
  for (const auto& session_case : session.cases) ids.push_back(session_case->id);
  return ids;
}

}  // namespace

void addInputs(py::module_& module) {
  py::class_<Case>(module, "Case", "An image with its camera, mesh and seed.")
      .def_property_readonly("id", [](const Case& one) { return one.loaded->source.id; })
      .def_property_readonly("image", &imageOf, "(height, width) uint8: as the algorithm sees it.")
      .def_property_readonly(
          "camera",
          [](const Case& one) { return pythonOf(sessions::toJson(one.loaded->source.camera)); },
          "Members of a camera.json.")
      .def_property_readonly(
          "camera_from_station_seed",
          [](const Case& one) { return matrixOf(one.loaded->source.camera_from_station_seed); })
      .def_property_readonly("camera_from_station_truth", &truthOf, "Or None.")
      .def_property_readonly("vertices_in_station_m", &verticesOf, "(n, 3) float32.")
      .def_property_readonly("faces", &facesOf, "(n, 3) int32.");
  module.def("read_case", &readCase, py::arg("image"), py::arg("mesh"), py::arg("mesh_unit") = "",
             py::arg("seed") = Path(), py::arg("camera") = Path(),
             py::arg("frames") = std::vector<Path>(), py::arg("truth") = std::nullopt,
             py::arg("ignore") = std::nullopt,
             "Reads a case from files, as `whs localize` takes them.");
  module.def("render_edges", &renderEdges, py::arg("case"),
             py::arg("camera_from_station") = std::nullopt,
             "Salient edge pixels of the mesh from a pose (default: the seed), as arrays.");
  py::class_<sessions::Session>(module, "Session", "Cases with their runs and decisions.")
      .def_property_readonly("case_ids", &caseIds)
      .def("case", &caseOf, py::arg("id"), "Reads the files of a case.");
  module.def("read_session", &readSession, py::arg("file"));
  module.def(
      "new_session",
      [](const Path& file, const std::vector<Case>& cases) {
        sessions::Session session;
        for (const Case& one : cases) {
          sessions::SessionCase added = one.loaded->source;
          added.id = sessions::freeCaseId(session, added.id);  // two images may have one name
          session = withCase(session, added);
        }
        (void)sessions::SessionDocument::create(file, session);
        return session;
      },
      py::arg("file"), py::arg("cases"), "Writes a session with these cases.");
}

}  // namespace boresight::python
