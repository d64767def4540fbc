"""Writes a network as src/nets reads it; the format is described in src/nets/net_file.h."""
import struct

import numpy as np

MAGIC = b"DUONET1\n"
KINDS = ["conv_first16", "matmul16", "depthwise16", "add16", "resize2x16", "maxpool2x16", "sum_pixels16", "depth_to_space16"]


def hash_of(data):
    """FNV-1a over 64-bit words."""
    value, mask = 0xCBF29CE484222325, (1 << 64) - 1
    for word in np.frombuffer(data, "<u8").tolist():
        value = ((value ^ word) * 0x100000001B3) & mask
    return value


def text(name, size):
    return name.encode().ljust(size, b"\0")


def pad(data, to):
    return data + bytes(-len(data) % to)


def write(path, name, network, tensors):
    numbers = {network.input: 0} | {layer.y: i + 1 for i, layer in enumerate(network.layers)}
    body = text(name, 24) + struct.pack("<IIII", len(numbers), len(network.layers), len(network.outputs), 0)
    weights = b""
    for tensor in numbers:
        t = tensors[tensor]
        body += struct.pack("<HHHhhh", *network.shapes[tensor], t.exponent, t.low, t.high)
    for layer in network.layers:
        b = 0xFFFF if layer.b is None else numbers[layer.b]
        body += struct.pack("<HHHBBBBBBBBBBI", numbers[layer.a], b, numbers[layer.y], KINDS.index(layer.kind), layer.window, layer.stride,
                            layer.top, layer.left, layer.left_a, layer.left_b, layer.shift, layer.fold, 0, len(weights))
        if layer.w is not None:
            for values, form in ((layer.q, "<i2"), (layer.q_bias, "<i4"), (layer.q_shift, "u1")):
                weights += pad(values.astype(form).tobytes(), 8)
    for output, tensor in network.outputs.items():
        body += text(output, 14) + struct.pack("<H", numbers[tensor])
    body = pad(body, 8) + pad(weights, 8)
    data = MAGIC + struct.pack("<Q", hash_of(body)) + body
    with open(path, "wb") as file:
        file.write(data)
    return len(data)
