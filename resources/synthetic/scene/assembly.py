# SPDX-License-Identifier: Apache-2.0
"""Puts a planned shot into Blender: solids, surfaces, sun, sky. One unit is a metre of the
station frame."""

import math
import random

import bpy
import numpy as np
from mathutils import Matrix, Vector

from . import equipment, materials, stations, surroundings

STATION_INDEX = 1  # of the pass that tells the station from the rest
MILLIMETRE = 1e-3


def empty():
    """Blender as it starts without its cube, lamp and camera."""
    bpy.ops.wm.read_factory_settings(use_empty=True)


def add_object(name, solid, material, index=0):
    """A mesh object, smooth across edges of less than 25 degrees."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata((solid.vertices * MILLIMETRE).tolist(), [], solid.triangles.tolist())
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    mesh.use_auto_smooth = True
    mesh.auto_smooth_angle = math.radians(25.0)
    mesh.materials.append(material)
    made = bpy.data.objects.new(name, mesh)
    made.pass_index = index
    bpy.context.collection.objects.link(made)
    return made


def build(plan, frames):
    """The scene of a plan (plan.py); `frames` are its cameras with `place` and `sees`."""
    generator = np.random.default_rng(plan["scene_seed"])
    up = np.array(plan["up"])
    surfaces = {}

    def surface(name):
        if name not in surfaces:
            surfaces[name] = materials.make(name, plan["dust"], up,
                                            float(generator.uniform(0.0, 40.0)))
        return surfaces[name]

    solids, filled = stations.build(plan["station"], True, random.Random(plan["scene_seed"]),
                                    plan["target_sleeve"])
    for name, solid in solids.items():
        add_object("station_" + name, solid, surface(name), STATION_INDEX)
    around = _around_lying if plan["lying"] else _around_mounted
    for name, (solid, material) in around(plan, solids, generator).items():
        if len(solid.triangles):
            add_object(name, solid, surface(material))
    _add_outside(plan, frames, generator, surface)
    _add_equipment(plan.get("state", []), frames, surface)
    _add_light(plan)
    return filled


def _around_mounted(plan, _, generator):
    """The vehicle's deck, and the ground far below: name -> (solid, material)."""
    up, depth = np.array(plan["up"]), plan["ground_depth_mm"]
    made = {"deck_" + name: (solid, name)
            for name, solid in surroundings.deck(plan["station"], generator).items()}
    made["ground"] = surroundings.ground(up, depth, generator), "ground"
    made["rocks"] = surroundings.rocks(up, depth, plan["rocks"], generator), "rock"
    return made


def _around_lying(plan, solids, generator):
    """The ground on which an object lies, 0.6 mm deep in it: name -> (solid, material)."""
    up = np.array(plan["up"])
    points = np.vstack([s.vertices for s in solids.values()])
    depth = float(-(points @ up).min()) - 0.6
    clear = float(np.linalg.norm(points, axis=1).max()) + 6.0
    made = {"litter_" + name: (solid, name)
            for name, solid in surroundings.litter(up, depth, clear, generator).items()}
    made["ground"] = surroundings.near_ground(up, depth, generator), "ground"
    made["rocks"] = surroundings.pebbles(up, depth, clear, plan["rocks"], generator), "rock"
    return made


def _add_outside(plan, frames, generator, surface):
    """What is not in the picture but throws shadows, and what hides the station on purpose."""

    def seen(points):
        return any(frame.sees(points * MILLIMETRE) for frame in frames)

    casters = surroundings.shadow_casters(plan["towards_sun"], seen, plan["shadow_casters"],
                                          generator)
    if len(casters.triangles):
        add_object("casters", casters, surface("bracket"))
    if "hard_occluded" in plan["tags"]:
        place = frames[0].place / MILLIMETRE
        add_object("occluder", surroundings.occluder(place, plan["occluder_reach_mm"], generator), surface("paint"))


def _add_equipment(names, frames, surface):
    if "lid" in names:
        add_object("lid", equipment.lid(), surface("bracket"), STATION_INDEX)
    if "gripper" in names:
        station_from_camera = np.linalg.inv(frames[0].camera_from_station)
        held = equipment.gripper().placed(station_from_camera[:3, :3],
                                          station_from_camera[:3, 3] / MILLIMETRE)
        add_object("gripper", held, surface("paint"))


def _add_light(plan):
    lamp = bpy.data.lights.new("sun", "SUN")
    lamp.energy = plan["sun_irradiance"]
    lamp.angle = math.radians(0.35)  # the sun's diameter as Mars sees it
    made = bpy.data.objects.new("sun", lamp)
    made.rotation_mode = "QUATERNION"
    made.rotation_quaternion = Vector(plan["towards_sun"]).to_track_quat("Z", "Y")
    bpy.context.collection.objects.link(made)
    made.lightgroup = "sun"
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    background.inputs["Strength"].default_value = plan["sky_radiance"]
    bpy.context.scene.world = world
    world.lightgroup = "sky"


def camera_matrix(camera_from_station):
    """Blender's camera looks along -z with y upwards."""
    rows = [list(row) for row in camera_from_station]
    turned = Matrix([rows[0], [-v for v in rows[1]], [-v for v in rows[2]], rows[3]])
    return turned.inverted()
