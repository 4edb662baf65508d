# SPDX-License-Identifier: Apache-2.0
"""Makes brightest.onnx (Debian: python3-onnx): a model with the inputs and outputs of a whole LoFTR.
Its one match is the brightest pixel of each input, a quarter of a pixel to the right; its other
match has no confidence."""

import sys

import onnx
from onnx import TensorProto, helper


def brightest(image, to):
    """Nodes from an image to its key points, float32 [2, 2]."""
    def name(part):
        return f"{to}_{part}"
    return [
        helper.make_node("Reshape", [image, "flat"], [name("pixels")]),
        helper.make_node("ArgMax", [name("pixels")], [name("index")], axis=0, keepdims=1),
        helper.make_node("Shape", [image], [name("shape")]),
        helper.make_node("Gather", [name("shape"), "three"], [name("width")], axis=0),
        helper.make_node("Div", [name("index"), name("width")], [name("y")]),
        helper.make_node("Mod", [name("index"), name("width")], [name("x")]),
        helper.make_node("Concat", [name("x"), name("y")], [name("place")], axis=0),
        helper.make_node("Cast", [name("place")], [name("real")], to=TensorProto.FLOAT),
        helper.make_node("Add", [name("real"), "quarter"], [name("point")]),
        helper.make_node("Reshape", [name("point"), "row"], [name("points")]),
        helper.make_node("Concat", [name("points"), name("points")], [to], axis=0),
    ]


def constant(name, kind, dims, values):
    return helper.make_tensor(name, kind, dims, values)


graph = helper.make_graph(
    brightest("image0", "keypoints0") + brightest("image1", "keypoints1") +
    [helper.make_node("Identity", ["confidences"], ["confidence"]),
     helper.make_node("Identity", ["zeros"], ["batch"])],
    "brightest",
    [helper.make_tensor_value_info(n, TensorProto.FLOAT, [1, 1, "h", "w"])
     for n in ("image0", "image1")],
    [helper.make_tensor_value_info("keypoints0", TensorProto.FLOAT, [2, 2]),
     helper.make_tensor_value_info("keypoints1", TensorProto.FLOAT, [2, 2]),
     helper.make_tensor_value_info("confidence", TensorProto.FLOAT, [2]),
     helper.make_tensor_value_info("batch", TensorProto.INT64, [2])],
    [constant("flat", TensorProto.INT64, [1], [-1]), constant("row", TensorProto.INT64, [2], [1, 2]),
     constant("three", TensorProto.INT64, [1], [3]),
     constant("quarter", TensorProto.FLOAT, [2], [0.25, 0.0]),
     constant("confidences", TensorProto.FLOAT, [2], [0.0, 0.75]),
     constant("zeros", TensorProto.INT64, [2], [0, 0])])
model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 13)], producer_name="")
model.ir_version = 8
onnx.checker.check_model(model)
onnx.save(model, sys.argv[1])
