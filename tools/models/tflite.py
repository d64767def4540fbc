"""Reads what these models use of a .tflite file: tensors, operators, constants. Every access is checked against the file's length."""
import struct

import numpy as np

ADD, CONCATENATION, CONV_2D, DEPTHWISE, DEPTH_TO_SPACE, DEQUANTIZE = 0, 2, 3, 4, 5, 6
FULLY_CONNECTED, LOGISTIC, MAX_POOL, RESHAPE, RESIZE_BILINEAR = 9, 14, 17, 22, 23
PAD, MEAN, DENSIFY = 34, 40, 124
TYPES = {0: np.float32, 1: np.float16, 2: np.int32}


class Table:
    """A flatbuffers table: fields by number, as the schema counts them."""

    def __init__(self, data, at):
        self.data, self.at = data, at

    def read(self, form, at):
        if at < 0 or at + struct.calcsize(form) > len(self.data):
            raise ValueError("the file is cut or broken")
        return struct.unpack_from("<" + form, self.data, at)[0]

    def field(self, number):
        table = self.at - self.read("i", self.at)
        if 4 + 2 * number >= self.read("H", table):
            return 0
        offset = self.read("H", table + 4 + 2 * number)
        return self.at + offset if offset else 0

    def number(self, number, form, default=0):
        at = self.field(number)
        return self.read(form, at) if at else default

    def table(self, number):
        at = self.field(number)
        return Table(self.data, at + self.read("I", at)) if at else None

    def vector(self, number):
        at = self.field(number)
        if not at:
            return 0, 0
        at += self.read("I", at)
        return at + 4, self.read("I", at)

    def bytes(self, number):
        at, count = self.vector(number)
        if at + count > len(self.data):
            raise ValueError("the file is cut or broken")
        return self.data[at:at + count]

    def numbers(self, number, form="i"):
        at, count = self.vector(number)
        return [self.read(form, at + i * struct.calcsize(form)) for i in range(count)]

    def tables(self, number):
        at, count = self.vector(number)
        return [Table(self.data, at + 4 * i + self.read("I", at + 4 * i)) for i in range(count)]


class Operator:
    def __init__(self, table, codes):
        self.code = codes[table.number(0, "I")]
        self.inputs, self.outputs = table.numbers(1), table.numbers(2)
        self.options = table.table(4)

    def option(self, number, form="b"):
        return self.options.number(number, form) if self.options else 0


class Model:
    """shapes[t], names[t] and operators; constants[t] is an array where the file has one, fp16 and sparse ones made dense float32."""

    def __init__(self, data):
        if data[4:8] != b"TFL3":
            raise ValueError("this is no .tflite file")
        root = Table(data, Table(data, 0).read("I", 0))
        codes = [max(c.number(0, "b"), c.number(3, "i")) for c in root.tables(1)]
        graph, buffers = root.tables(2)[0], root.tables(4)
        tensors = graph.tables(0)
        self.shapes = [t.numbers(0) for t in tensors]
        self.names = [t.bytes(3).decode() for t in tensors]
        self.inputs, self.outputs = graph.numbers(1), graph.numbers(2)
        self.constants = {}
        for i, tensor in enumerate(tensors):
            content = buffers[tensor.number(2, "I")].bytes(0)
            if content:
                values = np.frombuffer(content, TYPES[tensor.number(1, "b")])
                sparsity = tensor.table(6)
                self.constants[i] = dense(values, sparsity, self.shapes[i]) if sparsity else values.reshape(self.shapes[i])
        self.operators = []
        for operator in (Operator(t, codes) for t in graph.tables(3)):
            if operator.code in (DEQUANTIZE, DENSIFY) and operator.inputs[0] in self.constants:
                self.constants[operator.outputs[0]] = self.constants[operator.inputs[0]].astype(np.float32)
            else:
                self.operators.append(operator)


def index_array(table, kind_field):
    """One of the schema's three widths of index: Int32Vector, Uint16Vector, Uint8Vector."""
    form = {1: "i", 2: "H", 3: "B"}[table.number(kind_field, "b")]
    return table.table(kind_field + 1).numbers(0, form)


def dense(values, sparsity, shape):
    """Compressed rows (and blocks) of the last dimensions, as TensorFlow Lite's SparsityParameters describe them."""
    order, block_map = sparsity.numbers(0), sparsity.numbers(1)
    levels = sparsity.tables(2)
    sizes = list(shape)
    block = [1] * len(shape)
    for i, dimension in enumerate(block_map):
        block[dimension] = levels[len(shape) + i].number(1, "i")
        sizes[dimension] //= block[dimension]
    out = np.zeros(shape, np.float32)
    at = 0

    def place(level, parent, where):
        nonlocal at
        if level == len(order):
            index = [0] * len(shape)
            for dimension, value in zip(order[:len(shape)], where):
                index[dimension] = value * block[dimension]
            for dimension, value in zip(block_map, where[len(shape):]):
                index[dimension] += value
            out[tuple(index)] = values[at]
            at += 1
            return
        table = levels[level]
        if table.number(0, "b") == 0:  # dense
            size = table.number(1, "i")
            for i in range(size):
                place(level + 1, parent * size + i, where + [i])
        else:
            segments, indices = cached(table)
            for i in range(segments[parent], segments[parent + 1]):
                place(level + 1, i, where + [indices[i]])

    arrays = {}

    def cached(table):
        if table.at not in arrays:
            arrays[table.at] = index_array(table, 2), index_array(table, 4)
        return arrays[table.at]

    place(0, 0, [])
    if at != len(values):
        raise ValueError("a sparse tensor has more values than places")
    return out
