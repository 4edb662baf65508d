# SPDX-License-Identifier: Apache-2.0
"""Surfaces: worn metal under dust, paint, cable jackets, soil and rock."""

import bpy

# base reflectance, metallic, roughness, how well dust holds
SURFACES = {
    "plate": (0.42, 0.35, 0.50, 0.9),
    "rim": (0.50, 0.45, 0.45, 0.6),
    "sleeve": (0.36, 0.30, 0.50, 0.7),
    "housing": (0.30, 0.10, 0.60, 1.0),
    "dark": (0.13, 0.10, 0.60, 0.8),
    "steel": (0.40, 0.65, 0.38, 0.4),
    "bracket": (0.24, 0.20, 0.55, 0.7),
    "mark": (0.46, 0.00, 0.65, 0.5),
    "tube": (0.48, 0.55, 0.42, 0.3),
    "label": (0.80, 0.00, 0.70, 0.3),
    "black": (0.02, 0.00, 0.60, 0.1),
    "cable": (0.05, 0.00, 0.55, 0.4),
    "paint": (0.62, 0.00, 0.55, 0.8),
    "foil": (0.40, 0.80, 0.35, 0.3),
    "ceramic": (0.42, 0.00, 0.45, 0.3),
    "rock": (0.20, 0.00, 0.95, 0.6),
    "ground": (0.26, 0.00, 1.00, 0.0),
}
DUST_REFLECTANCE = 0.30
GLASS_INDEX = 1.47  # borosilicate
GLASS_ALBEDO = 0.05  # of its outer face: what it reflects, as a coarse render has no refraction


def albedo(name):
    """Mean reflectance of a clean surface."""
    return GLASS_ALBEDO if name == "glass" else SURFACES[name][0]


class _Nodes:
    """Makes nodes of a material and links them."""

    def __init__(self, material):
        material.use_nodes = True
        self.tree = material.node_tree
        self.shader = self.tree.nodes["Principled BSDF"]

    def make(self, kind, inputs=None, **properties):
        node = self.tree.nodes.new(kind)
        for name, value in properties.items():
            setattr(node, name, value)
        for socket, value in (inputs or {}).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[socket])
            else:
                node.inputs[socket].default_value = value
        return node

    def noise(self, coordinates, scale, detail, seed):
        moved = self.make("ShaderNodeVectorMath", {0: coordinates, 1: (seed, 2.7 * seed, seed)},
                          operation="ADD")
        return self.make("ShaderNodeTexNoise", {"Vector": moved.outputs[0], "Scale": scale,
                                                "Detail": detail}).outputs["Fac"]

    def math(self, operation, a, b=0.0, clamp=False):
        return self.make("ShaderNodeMath", {0: a, 1: b}, operation=operation,
                         use_clamp=clamp).outputs[0]

    def ramp(self, value, low, high):
        node = self.make("ShaderNodeMapRange", {"Value": value, 1: low, 2: high})
        return node.outputs[0]


def make(name, dust, up, seed):
    """A material of the table above; `dust` 0 .. 1 lies on what faces `up` (a direction)."""
    material = bpy.data.materials.new(name)
    nodes = _Nodes(material)
    if name == "glass":
        _glass(nodes)
        return material
    reflectance, metallic, roughness, holds = SURFACES[name]
    place = nodes.make("ShaderNodeNewGeometry")
    position, normal = place.outputs["Position"], place.outputs["True Normal"]
    if name in ("ground", "rock"):
        _soil(nodes, position, reflectance, seed)
        return material
    mottled = nodes.ramp(nodes.noise(position, 55.0, 4.0, seed), 0.25, 0.75)
    worn = nodes.math("MULTIPLY", nodes.math("ADD", nodes.math("MULTIPLY", mottled, 0.26), 0.87),
                      reflectance)
    worn = _scratched(nodes, position, worn, seed)
    facing = nodes.make("ShaderNodeVectorMath", {0: normal, 1: tuple(up)},
                        operation="DOT_PRODUCT").outputs["Value"]
    lies = nodes.ramp(facing, 0.1, 0.95)
    drift = nodes.noise(position, 16.0, 5.0, seed + 3.1)
    cover = nodes.ramp(drift, 0.62 - 0.30 * dust, 0.86 - 0.30 * dust)
    grains = nodes.math("ADD", nodes.math("MULTIPLY", nodes.noise(position, 900.0, 1.0, seed), 0.6),
                        0.7)
    share = nodes.math("MULTIPLY", nodes.math("MULTIPLY", lies, cover), holds * min(1.0, 1.6 * dust),
                       clamp=True)
    dusty = nodes.math("MULTIPLY", grains, DUST_REFLECTANCE)
    grey = nodes.math("ADD", nodes.math("MULTIPLY", worn, nodes.math("SUBTRACT", 1.0, share)),
                      nodes.math("MULTIPLY", dusty, share))
    _set(nodes, grey, nodes.math("MULTIPLY", nodes.math("SUBTRACT", 1.0, share), metallic), roughness)
    return material


def _glass(nodes):
    """Refracts what the camera sees. Light on its way to what lies behind passes straight, less at
    grazing angles: a glass's shadow without its caustics, which so few samples cannot find."""
    glass = nodes.make("ShaderNodeBsdfGlass", {"Roughness": 0.0, "IOR": GLASS_INDEX})
    rim = nodes.make("ShaderNodeLayerWeight", {"Blend": 0.35}).outputs["Facing"]
    passed = nodes.math("SUBTRACT", 0.95, nodes.math("MULTIPLY", nodes.math("POWER", rim, 3.0), 0.6))
    tint = nodes.make("ShaderNodeCombineRGB", {0: passed, 1: passed, 2: passed}).outputs[0]
    straight = nodes.make("ShaderNodeBsdfTransparent", {"Color": tint})
    path = nodes.make("ShaderNodeLightPath")
    sharp = nodes.math("MAXIMUM", path.outputs["Is Camera Ray"], path.outputs["Is Singular Ray"])
    onward = nodes.math("MAXIMUM", path.outputs["Is Shadow Ray"],
                        nodes.math("SUBTRACT", 1.0, sharp))
    mixed = nodes.make("ShaderNodeMixShader", {0: onward, 1: glass.outputs[0],
                                               2: straight.outputs[0]})
    nodes.tree.links.new(mixed.outputs[0],
                         nodes.tree.nodes["Material Output"].inputs["Surface"])


def _scratched(nodes, position, grey, seed):
    """Fine straight marks: noise drawn out along one direction."""
    stretch = nodes.make("ShaderNodeVectorMath", {0: position, 1: (900.0, 9.0, 60.0)},
                         operation="MULTIPLY").outputs[0]
    marks = nodes.ramp(nodes.noise(stretch, 1.0, 2.0, seed + 7.7), 0.70, 0.76)
    return nodes.math("ADD", grey, nodes.math("MULTIPLY", marks, 0.10))


def _soil(nodes, position, reflectance, seed):
    coarse = nodes.noise(position, 14.0, 8.0, seed)
    fine = nodes.noise(position, 220.0, 3.0, seed + 1.7)
    both = nodes.math("ADD", nodes.math("MULTIPLY", coarse, 1.1), nodes.math("MULTIPLY", fine, 0.9))
    _set(nodes, nodes.math("MULTIPLY", both, reflectance), 0.0, 1.0)


def _set(nodes, grey, metallic, roughness):
    colour = nodes.make("ShaderNodeCombineRGB", {0: grey, 1: grey, 2: grey}).outputs[0]
    nodes.tree.links.new(colour, nodes.shader.inputs["Base Color"])
    if isinstance(metallic, bpy.types.NodeSocket):
        nodes.tree.links.new(metallic, nodes.shader.inputs["Metallic"])
    else:
        nodes.shader.inputs["Metallic"].default_value = metallic
    nodes.shader.inputs["Roughness"].default_value = roughness
    nodes.shader.inputs["Specular"].default_value = 0.25
