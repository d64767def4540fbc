"""The integer layers as src/stages defines them, with numpy: a check of the tool's own."""
import numpy as np

import floats
from integers import CHUNK


def run(network, tensors, x):
    """Values of every tensor for an int16 input."""
    values = {network.input: x.astype(np.int64)}
    for layer in network.layers:
        a, y = values[layer.a], tensors[layer.y]
        height, width, channels = network.shapes[layer.y]
        if layer.kind == "matmul16":
            a = a.reshape(height * width, -1)
            total = np.zeros((height * width, channels), np.int64)
            for begin in range(0, a.shape[1], CHUNK):
                # Exact in doubles: below 2^53.
                part = (a[:, begin:begin + CHUNK].astype(float) @ layer.q[:, begin:begin + CHUNK].T.astype(float)).astype(np.int64)
                total += (part + ((1 << layer.fold) >> 1)) >> layer.fold
            out = (total + layer.q_bias) >> layer.q_shift
        elif layer.kind == "depthwise16":
            q = layer.q.astype(np.int64).reshape(layer.window, layer.window, channels)
            out = (floats.windows(layer, a, height, width, lambda part, i, j: part.astype(np.int64) * q[i, j]) + layer.q_bias) >> layer.q_shift
        elif layer.kind == "conv_first16":
            q = layer.q.astype(float).reshape(channels, 3, 3, 3)
            total = floats.windows(layer, a, height, width, lambda part, i, j: part.astype(float) @ q[:, i, j].T)
            out = (total.astype(np.int64) + layer.q_bias) >> layer.q_shift
        elif layer.kind == "add16":
            out = a << layer.left_a
            out[..., :values[layer.b].shape[2]] += values[layer.b] << layer.left_b
            out = (out + ((1 << layer.shift) >> 1)) >> layer.shift
        elif layer.kind == "resize2x16":
            out = (np.rint(16 * floats.twice(floats.twice(a.astype(float), 0), 1)).astype(np.int64) + 8) >> 4
        elif layer.kind == "maxpool2x16":
            out = a.reshape(height, 2, width, 2, channels).max((1, 3))
        elif layer.kind == "sum_pixels16":
            out = (a.sum((0, 1)) + ((1 << layer.shift) >> 1)) >> layer.shift
        else:
            out = a.reshape(height // 2, width // 2, 2, 2, channels).transpose(0, 2, 1, 3, 4)
        values[layer.y] = np.clip(out.reshape(height, width, channels), y.low, y.high)
    return values
