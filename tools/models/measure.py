#!/usr/bin/python3
"""Measures the ranges of the models' tensors in floating point and writes ranges.json: tools/models/measure.py FOLDER PACKAGES.

FOLDER holds the rendered clips dev_easy_wave and dev_hard_beige, PACKAGES the packages' .tgz. Needs ffmpeg and python3-numpy.
"""
import importlib.machinery
import importlib.util
import json
import os
import sys

import numpy as np

sys.dont_write_bytecode = True
import catalogue
import clips
import floats

HERE = os.path.dirname(os.path.abspath(__file__))
CLIPS = ("dev_easy_wave", "dev_hard_beige")
FRAMES = 20  # of each clip


def load_make():
    loader = importlib.machinery.SourceFileLoader("make", os.path.join(HERE, "make"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("make", loader))
    loader.exec_module(module)
    return module


def main():
    folder, packages = sys.argv[1:]
    make = load_make()
    ranges = {}
    for name in catalogue.MODELS:
        entry, network = make.network_of(name, packages)
        pixels = network.shapes[network.input][0]
        linear = [layer.y for layer in network.layers
                  if not layer.relu6 and layer.kind in ("matmul16", "depthwise16", "conv_first16", "add16")]
        largest = dict.fromkeys(linear, 0.0)
        for clip in CLIPS:
            for sample in clips.samples(name.split("_")[0], os.path.join(folder, clip), pixels, FRAMES):
                values = floats.run(network, entry.low / 255 + sample / 255 * (entry.high - entry.low) / 255)
                for tensor in linear:
                    largest[tensor] = max(largest[tensor], float(np.abs(values[tensor]).max()))
        # Three digits: what is beyond them differs between builds of numpy.
        ranges[name] = {str(tensor): float(f"{value:.3g}") for tensor, value in largest.items()}
        print(name, len(linear), "tensors")
    json.dump(ranges, open(os.path.join(HERE, "ranges.json"), "w"), indent=1)


if __name__ == "__main__":
    main()
