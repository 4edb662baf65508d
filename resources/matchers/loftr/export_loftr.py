#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Exports the whole LoFTR with its authors' weights to ONNX, for loftr.js.

    pip install torch kornia onnx
    python3 export_loftr.py --weights outdoor_ds.ckpt --out loftr.onnx [--size 1024]

Inputs: image0, image1, float32 [1, 1, size, size] in 0..1. Outputs: keypoints0 and keypoints1,
float32 [M, 2], px; confidence, float32 [M].
"""

import argparse

import torch
from kornia.feature import LoFTR


class Matcher(torch.nn.Module):
    """LoFTR of two images, with the three outputs that loftr.js reads."""

    def __init__(self, weights):
        super().__init__()
        self.loftr = LoFTR(pretrained=None)
        state = torch.load(weights, map_location="cpu")
        state = state.get("state_dict", state)
        # The authors' checkpoints of training have the network as a member.
        self.loftr.load_state_dict({k.removeprefix("matcher."): v for k, v in state.items()})

    def forward(self, image0, image1):
        found = self.loftr({"image0": image0, "image1": image1})
        return found["keypoints0"], found["keypoints1"], found["confidence"]


def shifted_noise(size):
    """Two images with matches: a trace without any would leave the fine stage out."""
    torch.manual_seed(1)
    noise = torch.nn.functional.interpolate(torch.rand(1, 1, size // 8 + 2, size // 8 + 2),
                                            scale_factor=8, mode="bilinear")
    return noise[..., :size, :size].contiguous(), noise[..., 8:size + 8, 8:size + 8].contiguous()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--weights", required=True, help="checkpoint of the LoFTR authors")
    parser.add_argument("--out", required=True, help="ONNX file")
    parser.add_argument("--size", type=int, default=1024, help="side of the inputs, px")
    options = parser.parse_args()
    images = shifted_noise(options.size)
    matcher = Matcher(options.weights).eval()
    with torch.no_grad():
        matches = len(matcher(*images)[2])
        if matches == 0:
            raise SystemExit("these weights match nothing in two shifted images: are they LoFTR's?")
        torch.onnx.export(matcher, images, options.out, opset_version=16,
                          input_names=["image0", "image1"],
                          output_names=["keypoints0", "keypoints1", "confidence"],
                          dynamic_axes={name: {0: "matches"} for name in
                                        ("keypoints0", "keypoints1", "confidence")})
    print(f"{options.out}: {matches} matches in the images of the trace")


if __name__ == "__main__":
    main()
