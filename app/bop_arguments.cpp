// SPDX-License-Identifier: Apache-2.0
#include "app/bop_arguments.h"

#include <filesystem>

#include "app/commands.h"

namespace boresight::app {

void DatasetArguments::addTo(CLI::App& command) {
  const char* group = "Of a BOP folder";
  command.add_option("--split", split, "Its split, e.g. val (else test, or the only one)")
      ->type_name("NAME")
      ->group(group);
  command.add_option("--scene", scenes, "Only these scenes")->type_name("N")->group(group);
  command.add_option("--obj", objects, "Only these objects")->type_name("N")->group(group);
  command.add_option("--sensor", sensor, "Which of several: scene_camera_NAME.json")
      ->type_name("NAME")
      ->group(group);
  command
      .add_flag("--every-instance", every_instance,
                "Also instances that the challenge does not ask for, or that are hardly visible")
      ->group(group);
  addUncertainty(command, uncertainty,
                 "Seeds are drawn about the truth within this along and about x, y, z of the "
                 "camera: three lengths in m, three angles in deg (else 0.03 m and 10 deg)")
      ->group(group);
  command
      .add_option("--pivot", pivot,
                  "What the seed's rotation is uncertain about (else the station)")
      ->check(CLI::IsMember({"camera", "station"}))
      ->group(group);
}

bool DatasetArguments::chooses() const {
  return !split.empty() || !sensor.empty() || !scenes.empty() || !objects.empty() ||
         !uncertainty.empty() || !pivot.empty() || every_instance;
}

sessions::BopSelection DatasetArguments::selection() const {
  sessions::BopSelection made;
  made.split = split;
  made.sensor = sensor;
  made.scenes = scenes;
  made.objects = objects;
  made.every_instance = every_instance;
  setUncertainty(uncertainty, made.uncertainty);
  if (pivot == "camera") made.uncertainty.pivot = sessions::UncertaintyPivot::kCamera;
  return made;
}

sessions::Dataset DatasetArguments::open() const {
  if (chooses() && !std::filesystem::is_directory(path))
    throw CLI::ValidationError(
        "--split, --scene, --obj, --sensor, --every-instance, "
        "--uncertainty, --pivot",
        "choose of a BOP folder, which " + path + " is not");
  return sessions::openDataset(path, selection());
}

}  // namespace boresight::app
