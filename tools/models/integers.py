"""Layers in 16-bit integers: powers of two for steps, and weights so coarse that no sum can leave 32 bits (src/stages/matmul16)."""
import numpy as np

CHUNK = 128
HIGHEST = 32767
RELU6_EXPONENT = 12
MARGIN = 2.0  # a value may be so many times the largest that was measured


def exponent_for(largest):
    """The finest step 2^-e of which 32767 reach `largest`."""
    mantissa, power = np.frexp(largest / HIGHEST)  # largest <= HIGHEST * 2^power
    return -int(power) if mantissa != 0.5 else 1 - int(power)


class Tensor:
    def __init__(self, exponent, low=-HIGHEST, high=HIGHEST):
        self.exponent, self.low, self.high = exponent, low, high


def tensors_of(network, entry, measured):
    """Step and range of every tensor. measured: tensor -> largest magnitude."""
    scale = 1 << entry.exponent
    out = {network.input: Tensor(entry.exponent, entry.low * scale, entry.high * scale)}
    for layer in network.layers:
        if layer.relu6:
            out[layer.y] = Tensor(RELU6_EXPONENT, 0, 6 << RELU6_EXPONENT)
        elif layer.kind in ("resize2x16", "maxpool2x16", "depth_to_space16", "sum_pixels16"):
            out[layer.y] = out[layer.a]
        else:
            out[layer.y] = Tensor(min(exponent_for(MARGIN * measured[layer.y]), 15))
    return out


def extremes(w, x):
    """Least and most sum over the last axis of weights with values of a tensor's range."""
    positive, negative = np.where(w > 0, w, 0).sum(-1), np.where(w < 0, w, 0).sum(-1)
    return positive * x.low + negative * x.high, positive * x.high + negative * x.low


def fits(least, most):
    return (least >= -(1 << 31)) & (most < 1 << 31)


def quantise(w, bias, x, y, fold):
    """w: outputs x terms. Returns int16 weights, int32 bias with the half that rounds, and shifts: the finest that fit."""
    outputs, terms = w.shape
    w, bias = w.astype(np.float64), bias.astype(np.float64)
    finest = np.full(outputs, 31 + fold + y.exponent - x.exponent)
    largest = np.abs(w).max(1)
    finest = np.where(largest > 0, np.minimum(finest, [exponent_for(v) if v > 0 else 99 for v in largest]), finest)
    weights, biases, shifts = np.zeros((outputs, terms), np.int64), np.zeros(outputs, np.int64), np.zeros(outputs, np.int64)
    todo = np.arange(outputs)
    while len(todo):
        power = finest[todo]
        shift = x.exponent + power - fold - y.exponent
        if (shift < 0).any():
            raise ValueError("a result's step is finer than its sum's")
        q = np.rint(np.ldexp(w[todo], power[:, None])).astype(np.int64)
        b = np.rint(np.ldexp(bias[todo], x.exponent + power - fold)).astype(np.int64) + ((1 << shift) >> 1)
        good = (np.abs(q) <= HIGHEST).all(1) & fits(b, b)
        least_total, most_total = b.copy(), b.copy()
        half = (1 << fold) >> 1
        for begin in range(0, terms, CHUNK):
            least, most = extremes(q[:, begin:begin + CHUNK], x)
            good &= fits(least + half, most + half)
            least_total += (least + half) >> fold
            most_total += (most + half) >> fold
        good &= fits(least_total, most_total)
        done = todo[good]
        weights[done], biases[done], shifts[done] = q[good], b[good], shift[good]
        todo = todo[~good]
        finest[todo] -= 1
    return weights.astype(np.int16), biases.astype(np.int32), shifts.astype(np.uint8)


def make(network, entry, measured):
    """Puts integers beside every layer's floats: layer.q, layer.q_bias, layer.q_shift, fold, left_a, left_b, shift. Returns the tensors."""
    tensors = tensors_of(network, entry, measured)
    for layer in network.layers:
        x, y = tensors[layer.a], tensors[layer.y]
        layer.fold = layer.left_a = layer.left_b = layer.shift = 0
        if layer.kind == "sum_pixels16":
            height, width, _ = network.shapes[layer.a]
            layer.shift = int(height * width - 1).bit_length()
            network.sum_scale = getattr(network, "sum_scale", {}) | {layer.y: (1 << layer.shift) / (height * width)}
        elif layer.kind == "add16":
            b = tensors[layer.b]
            fine = max(x.exponent, b.exponent, y.exponent)
            layer.left_a, layer.left_b, layer.shift = fine - x.exponent, fine - b.exponent, fine - y.exponent
            if max(layer.left_a, layer.left_b) > 14 or layer.shift > 15:
                raise ValueError("steps of an addition are too far apart")
        elif layer.w is not None:
            w = layer.w.astype(np.float64) * getattr(network, "sum_scale", {}).get(layer.a, 1)
            if layer.kind == "conv_first16":
                w = w.reshape(w.shape[0], -1) / 255
            elif layer.kind == "depthwise16":
                w = w.reshape(-1, w.shape[-1]).T
            terms = w.shape[1]
            if layer.kind == "matmul16":
                layer.fold = (-(-terms // CHUNK) - 1).bit_length()
            layer.q, layer.q_bias, layer.q_shift = quantise(w, layer.bias, x, y, layer.fold)
            if layer.kind == "depthwise16":
                layer.q = np.ascontiguousarray(layer.q.T)
    return tensors
