# SPDX-License-Identifier: Apache-2.0
"""Runs inside Blender:

    blender -b --factory-startup -t N --python-exit-code 1 --python render_shot.py -- meshes DIR
    blender -b --factory-startup -t N --python-exit-code 1 --python render_shot.py -- shot PLAN.json DIR

The first writes the coarse meshes, the second renders the pictures of a plan that are not there
yet. A case counts as there when its record `cases/ID.json` is, which is written last.
"""

import json
import os
import random
import shutil
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.dont_write_bytecode = True

import bpy
import numpy as np

from imaging import cameras, meshes, pixels
from plan import BOP_OBJECTS
from scene import assembly, equipment, materials, stations

SAMPLES = 3
GLASS_SAMPLES, GLASS_BOUNCES, GLASS_CLAMP = 64, 16, 0.7
PASSES = {"Combined_sun": "sun", "Combined_sky": "sky", "Normal": "normal", "Depth": "depth",
          "Denoising Albedo": "albedo", "IndexOB": "index"}
BOP_DEPTH_MM = 0.05  # one step of a BOP depth picture


def set_up_cycles(seed):
    """Path tracing on the processor: few samples, few bounces, and what else the filter needs."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.seed = "CPU", seed % (2 ** 31)
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = False
    set_up_cycles_samples()
    cycles.diffuse_bounces = 1
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.filter_width = 1.5
    scene.world.cycles.sampling_method = "NONE"  # an even sky is best met by the bounces
    layer = bpy.context.view_layer
    layer.use_pass_normal = layer.use_pass_z = layer.use_pass_object_index = True
    layer.cycles.denoising_store_passes = True
    for group in ("sun", "sky"):
        layer.lightgroups.add(name=group)


def set_up_cycles_samples():
    cycles = bpy.context.scene.cycles
    cycles.samples, cycles.max_bounces, cycles.glossy_bounces = SAMPLES, 2, 1
    cycles.sample_clamp_indirect = 4.0


def set_up_output(folder):
    """Every pass as a file of floats."""
    scene = bpy.context.scene
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    layers = tree.nodes.new("CompositorNodeRLayers")
    output = tree.nodes.new("CompositorNodeOutputFile")
    output.base_path = str(folder)
    output.format.file_format, output.format.color_depth = "OPEN_EXR", "32"
    output.format.exr_codec = "NONE"
    output.file_slots.clear()
    for name, file in PASSES.items():
        output.file_slots.new(file)
        tree.links.new(layers.outputs[name], output.inputs[file])


def render(frame, folder):
    """The passes of a frame as float arrays, top row first."""
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = frame.side_px
    scene.render.resolution_percentage = 100
    lens = bpy.data.cameras.new("camera")
    lens.sensor_fit, lens.sensor_width = "HORIZONTAL", 36.0
    lens.lens = frame.focal_px / frame.side_px * 36.0
    lens.clip_start, lens.clip_end = 0.01, 1000.0
    camera = bpy.data.objects.new("camera", lens)
    camera.matrix_world = assembly.camera_matrix(frame.camera_from_station.tolist())
    bpy.context.collection.objects.link(camera)
    scene.camera = camera
    bpy.ops.render.render()
    return {name: load(folder / f"{name}{scene.frame_current:04d}.exr", name)
            for name in PASSES.values()}


def render_station_alone(frame, folder):
    """Index of the object hit by each pixel, [row, column], if nothing stood before the station."""
    others = [o for o in bpy.context.scene.objects
              if o.type == "MESH" and o.pass_index != assembly.STATION_INDEX]
    cycles = bpy.context.scene.cycles
    for other in others:
        other.hide_render = True
    cycles.samples = 1
    passes = render(frame, folder)
    cycles.samples = SAMPLES
    for other in others:
        other.hide_render = False
    return passes["index"]


def refine_glass(frame, folder, radiance, index):
    """Renders the transparent object with many samples and bounces, unfiltered (the filter's guides
    know its surface only, not what is seen through it), in place of its part of the picture."""
    rows, columns = np.flatnonzero((index > 0.5).any(1)), np.flatnonzero((index > 0.5).any(0))
    if not len(rows):
        return
    side, margin = frame.side_px, 4
    top, bottom = max(0, rows[0] - margin), min(side, rows[-1] + 1 + margin)
    left, right = max(0, columns[0] - margin), min(side, columns[-1] + 1 + margin)
    scene = bpy.context.scene
    area, cycles = scene.render, scene.cycles
    area.use_border, area.use_crop_to_border = True, False
    area.border_min_x, area.border_max_x = left / side, right / side
    area.border_min_y, area.border_max_y = 1.0 - bottom / side, 1.0 - top / side
    cycles.samples, cycles.max_bounces = GLASS_SAMPLES, GLASS_BOUNCES
    cycles.transmission_bounces = cycles.transparent_max_bounces = GLASS_BOUNCES
    cycles.glossy_bounces, cycles.sample_clamp_indirect = 4, GLASS_CLAMP
    passes = render(frame, folder)
    area.use_border = False
    set_up_cycles_samples()
    near = index > 0.5
    for _ in range(margin - 1):
        near = grown(near)
    near[:top], near[bottom:], near[:, :left], near[:, right:] = False, False, False, False
    radiance[near] = (passes["sun"] + passes["sky"])[near]


def grown(mask):
    """The mask and its neighbours."""
    padded = np.pad(mask, 1)
    return (padded[1:-1, 1:-1] | padded[:-2, 1:-1] | padded[2:, 1:-1] | padded[1:-1, :-2]
            | padded[1:-1, 2:])


def load(path, name):
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    values = np.empty(width * height * image.channels, dtype=np.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(height, width, -1)[::-1]
    bpy.data.images.remove(image)
    path.unlink()
    return np.ascontiguousarray(values[:, :, :3] if name == "normal" else values[:, :, 0])


def develop(passes, plan):
    """Radiance without the grain of few samples: the sky's light is filtered harder than the
    sun's, whose shadows are sharp."""
    depth = np.minimum(passes["depth"], 1e4)
    guides = [(passes["normal"][:, :, i], 0.18) for i in range(3)]
    guides += [(np.log(depth), 0.012), (passes["albedo"], 0.06)]
    # What reflects is divided out, so that the texture of a surface stays.
    albedo = passes["albedo"] + 0.02
    sky, sun = passes["sky"] / albedo, passes["sun"] / albedo
    # In its own shadows the sun's light is what surfaces pass on, and seldom met by a ray. What
    # faces the sun may have edges of shadows as high as its full light; what faces away has none.
    full = plan["sun_irradiance"] / np.pi
    facing = passes["normal"] @ np.array(plan["towards_sun"], dtype=np.float32)
    noise = np.where(facing > 0.03, 0.3 * full * facing, 0.5 * full).astype(np.float32)
    sky, sun = pixels.smooth([(sky, 4, 1.5, np.float32(0.0)), (sun, 4, 0.2, noise)], guides)
    clear = np.exp(-plan["haze_per_m"] * np.minimum(depth, 2000.0))
    return (sun + sky) * albedo * clear + plan["sky_radiance"] * (1.0 - clear)


def gain_for(radiance, index, plan):
    """The exposure a camera would choose: the station's bright parts near two thirds, or, for what
    lies on the ground, the ground near two fifths, so that an opaque copy gets the same."""
    if plan["lying"]:
        seen = radiance[index <= 0.5]
        return plan["exposure"] * 0.40 / max(1e-6, float(np.percentile(seen, 60)))
    return plan["exposure"] * 0.66 / max(1e-6, float(np.percentile(radiance[index > 0.5], 88)))


def nearest(image, x, y):
    side = image.shape[0]
    return image[np.clip(np.rint(y).astype(int), 0, side - 1),
                 np.clip(np.rint(x).astype(int), 0, side - 1)]


def box_of(mask):
    """[x, y, width, height] of what is true, as BOP has it; [-1, -1, -1, -1] of nothing."""
    rows, columns = np.flatnonzero(mask.any(1)), np.flatnonzero(mask.any(0))
    if not len(rows):
        return [-1, -1, -1, -1]
    return [int(columns[0]), int(rows[0]), int(columns[-1] - columns[0] + 1),
            int(rows[-1] - rows[0] + 1)]


def write_bop_pictures(frame, folder, radiance, passes, alone, gain, plan, generator):
    """The undistorted picture, its depth and its masks: BOP knows pinhole cameras only."""
    pinhole = {k: v for k, v in frame.camera.items() if k != "dist"}
    at = frame.render_coordinates(*cameras.rays(pinhole))
    if frame.camera.get("dist"):
        image = pixels.expose(pixels.sample(radiance, *at), gain, plan["sensor"], generator)
        pixels.write_png(folder / "gray.png", image)
    steps = np.clip(nearest(passes["depth"], *at) * (1e3 / BOP_DEPTH_MM) + 0.5, 0, 65536)
    depth = np.where(steps < 65536, steps, 0).astype(np.uint16)
    pixels.write_png(folder / "depth.png", depth)
    visible = (nearest(passes["index"], *at) == assembly.STATION_INDEX)
    whole = (nearest(alone, *at) == assembly.STATION_INDEX) | visible
    pixels.write_png(folder / "mask_visib.png", visible.astype(np.uint8) * 255)
    pixels.write_png(folder / "mask.png", whole.astype(np.uint8) * 255)
    counts = int(whole.sum()), int(visible.sum())
    return {"bbox_obj": box_of(whole), "bbox_visib": box_of(visible), "px_count_all": counts[0],
            "px_count_valid": int((whole & (depth > 0)).sum()), "px_count_visib": counts[1],
            "visib_fract": counts[1] / max(1, counts[0])}


def make_case(plan, frame_plan, frame, temporary, root):
    """Renders a case, and moves its files into place when all are there."""
    started = time.monotonic()
    passes = render(frame, temporary)
    alone = render_station_alone(frame, temporary)
    rendered = time.monotonic()
    radiance = develop(passes, plan)
    if "transparent" in plan["tags"]:
        refine_glass(frame, temporary, radiance, passes["index"])
    gain = gain_for(radiance, passes["index"], plan)
    generator = np.random.default_rng([plan["scene_seed"], frame_plan["number"]])
    at = frame.render_coordinates(*cameras.rays(frame.camera))
    image = pixels.expose(pixels.sample(radiance, *at), gain, plan["sensor"], generator)
    pixels.write_png(temporary / "image.png", image)
    info = write_bop_pictures(frame, temporary, radiance, passes, alone, gain, plan, generator)
    record = {"plan": {k: v for k, v in plan.items() if k != "frames"}, "frame": frame_plan,
              "bop": info, "seconds": {"render": round(rendered - started, 1),
                                       "develop": round(time.monotonic() - rendered, 1)}}
    commit(record, temporary, root)


def commit(record, temporary, root):
    """Pictures first, the record last: what has a record is whole."""
    frame, station = record["frame"], record["plan"]["station"]
    name = f"{frame['number']:06d}"
    bop = root / "bop" / "test" / f"{BOP_OBJECTS[station]:06d}"
    places = {"image": root / station / "images" / f"{name}.png",
              "gray": bop / "gray" / f"{name}.png", "depth": bop / "depth" / f"{name}.png",
              "mask": bop / "mask" / f"{name}_000000.png",
              "mask_visib": bop / "mask_visib" / f"{name}_000000.png"}
    for kind, place in places.items():
        place.parent.mkdir(parents=True, exist_ok=True)
        if (temporary / f"{kind}.png").exists():
            os.replace(temporary / f"{kind}.png", place)
    if not frame["camera_parameters"].get("dist"):  # one picture, two names
        if places["gray"].exists():
            places["gray"].unlink()
        try:
            os.link(places["image"], places["gray"])
        except OSError:
            shutil.copyfile(places["image"], places["gray"])
    (root / "cases").mkdir(exist_ok=True)
    draft = temporary / "record.json"
    draft.write_text(json.dumps(record))
    os.replace(draft, root / "cases" / f"{frame['id']}.json")


def make_shot(plan_path, root):
    plan = json.loads(Path(plan_path).read_text())
    todo = [f for f in plan["frames"] if not (root / "cases" / f"{f['id']}.json").exists()]
    frames = {f["id"]: cameras.Frame(f, f["camera_parameters"]) for f in plan["frames"]}
    temporary = Path(plan_path).with_suffix("")
    temporary.mkdir(parents=True, exist_ok=True)
    assembly.empty()
    plan["filled_sleeves"] = assembly.build(plan, list(frames.values()))
    set_up_cycles(plan["scene_seed"])
    set_up_output(temporary)
    for frame_plan in todo:
        make_case(plan, frame_plan, frames[frame_plan["id"]], temporary, root)
    shutil.rmtree(temporary)


def make_meshes(root):
    for station in BOP_OBJECTS:
        solids, _ = stations.build(station, False, random.Random(0))
        if station in ("bc", "os"):
            meshes.write_alone(station, equipment.files(station, stations.Builder(False)), root)
        meshes.write(station, solids, {name: materials.albedo(name) for name in solids}, root)


if __name__ == "__main__":
    arguments = sys.argv[sys.argv.index("--") + 1:]
    if arguments[0] == "meshes":
        make_meshes(Path(arguments[1]))
    else:
        make_shot(arguments[1], Path(arguments[2]))
