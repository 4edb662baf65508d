// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <vector>

#include "app/commands.h"
#include "sessions/io/files/atomic_file.h"
#include "sessions/io/images/camera_of_file.h"
#include "sessions/io/images/image_file.h"
#include "sessions/run/problem.h"
#include "sessions/session/input_sheet.h"
#include "sessions/trace/scene_render.h"

namespace boresight::app {
namespace {

struct RenderArguments {
  FrameArguments frames;
  std::string mesh, mesh_unit, camera, pose, out;

  void addTo(CLI::App& command) {
    addFile(command, "--mesh", mesh, kMeshHelp)->required();
    addMeshUnit(command, mesh_unit, kMeshUnitHelp);
    frames.addTo(command);
    addFile(command, "--camera", camera, kCameraHelp)->required();
    addFile(command, "--pose", pose, "pose.json")->required();
    addFile(command, "--out", out, "PNG: white edges on black")->required();
  }
};

int render(const RenderArguments& arguments) {
  const sessions::CameraFile camera_file =
      sessions::readCameraFile(std::filesystem::path(arguments.camera));
  const Camera& camera = camera_file.camera;
  const sessions::PoseFile pose =
      sessions::readPose(std::filesystem::path(arguments.pose), arguments.frames.of(camera_file));
  sessions::PartSource part;
  part.mesh = arguments.mesh;
  part.mesh_unit = arguments.mesh_unit;
  const sessions::SceneMesh scene = sessions::readScene({&part, 1});
  sessions::requireWritable(arguments.out);
  for (const std::string& text : sessions::fileNotes(scene)) note(text);
  sessions::requireSensibleSeed(camera, scene, pose.camera_from_station, arguments.pose,
                                "camera_from_station");
  sessions::RenderTrace render_trace;
  const Status status =
      sessions::renderScene(camera, scene.view(), pose.camera_from_station, render_trace);
  if (status != Status::kOk)
    throw sessions::InputError(arguments.mesh,
                               std::string("cannot be rendered: ") + statusText(status));
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(camera.width) *
                                   static_cast<std::size_t>(camera.height));
  for (const EdgePixel& pixel : render_trace.pixels)
    pixels[static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(camera.width) +
           static_cast<std::size_t>(pixel.x)] = 255;
  sessions::writePng(arguments.out, pixels, camera.width, camera.height, 1);
  std::cout << render_trace.pixels.size() << " edge pixels\n";
  return kDone;
}

}  // namespace

void addRender(CLI::App& app, int& exit_code) {
  addCommand(app, exit_code, "render", "Draws the salient edges of a mesh seen from a pose",
             render);
}

}  // namespace boresight::app
