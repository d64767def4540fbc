"""The layers in floating point, with numpy: what the ranges are measured with and what the integers are held against."""
import numpy as np


def run(network, x):
    """Values of every tensor for an input of height x width x 3."""
    values = {network.input: x.astype(np.float32)}
    for layer in network.layers:
        a = values[layer.a]
        height, width, channels = network.shapes[layer.y]
        if layer.kind == "matmul16":
            y = a.reshape(height * width, -1) @ layer.w.T + layer.bias
        elif layer.kind == "depthwise16":
            y = windows(layer, a, height, width, lambda part, i, j: part * layer.w[i, j]) + layer.bias
        elif layer.kind == "conv_first16":
            y = windows(layer, a, height, width, lambda part, i, j: part @ layer.w[:, i, j].T) + layer.bias
        elif layer.kind == "add16":
            y = a.copy()
            y[..., :values[layer.b].shape[2]] += values[layer.b]
        elif layer.kind == "resize2x16":
            y = twice(twice(a, 0), 1)
        elif layer.kind == "maxpool2x16":
            y = a.reshape(height, 2, width, 2, channels).max((1, 3))
        elif layer.kind == "sum_pixels16":
            y = a.mean((0, 1))
        else:
            y = a.reshape(height // 2, width // 2, 2, 2, channels).transpose(0, 2, 1, 3, 4)
        y = y.reshape(height, width, channels)
        values[layer.y] = np.clip(y, 0, 6) if layer.relu6 else y
    return values


def windows(layer, a, height, width, product):
    after = [(n - 1) * layer.stride + layer.window for n in (height, width)]
    padded = np.zeros((max(after[0], a.shape[0] + layer.top), max(after[1], a.shape[1] + layer.left), a.shape[2]), np.float32)
    padded[layer.top:layer.top + a.shape[0], layer.left:layer.left + a.shape[1]] = a
    total = 0
    for i in range(layer.window):
        for j in range(layer.window):
            part = padded[i:i + (height - 1) * layer.stride + 1:layer.stride, j:j + (width - 1) * layer.stride + 1:layer.stride]
            total = total + product(part, i, j)
    return total


def twice(a, axis):
    n = a.shape[axis]
    index = np.arange(n)
    before, after = np.take(a, np.maximum(index - 1, 0), axis), np.take(a, np.minimum(index + 1, n - 1), axis)
    out = np.stack([0.75 * a + 0.25 * before, 0.75 * a + 0.25 * after], axis + 1)
    shape = list(a.shape)
    shape[axis] *= 2
    return out.reshape(shape)
